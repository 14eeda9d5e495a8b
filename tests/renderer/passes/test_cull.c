// Culling against brute force: by the frustum, points of boxes against frusta and points of frusta against
// boxes; by the redraw map, boxes drawn pixel by pixel; and the compaction of what is left.
#include "renderer/passes/cull/cull.h"
#include "renderer/passes/redraw/redraw.h"
#include "tests/renderer/passes/rig.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { BOXES = 400, MESHES = 5, SUBMODELS = 3, MATERIALS = 3 };

static const struct dvec3 middle = {500, -20, 3000}; // of the scene, far from the world's origin

static void make_meshes(struct scene *s, uint64_t *random)
{
    s->submodel_count = MESHES * SUBMODELS;
    for (uint32_t i = 0; i < s->submodel_count; i++) {
        struct scene_submodel *sub = &s->submodels[i];
        *sub = (struct scene_submodel){.first_index = 3 * i,
                                       .index_count = 3 * (1 + (uint32_t)rig_below(random, 5)),
                                       .material = (uint32_t)rig_below(random, MATERIALS)};
        for (int k = 0; k < 3; k++) { // a few of them flat, one a point
            const double half = i == 7 || rig_below(random, 8) == 0 ? 0 : rig_uniform(random, 0.02, 1);
            const double at = rig_uniform(random, -1, 1);
            sub->bounds.min[k] = (float)(at - half);
            sub->bounds.max[k] = (float)(at + half);
        }
    }
    s->mesh_count = MESHES;
    for (uint32_t i = 0; i < MESHES; i++)
        s->meshes[i] = (struct scene_mesh){SUBMODELS * i, SUBMODELS};
}

static struct scene *make_scene(uint64_t seed)
{
    uint64_t random = seed;
    struct scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->vertex_count = 3;
    s->vertices = calloc(s->vertex_count, sizeof *s->vertices);
    s->index_count = 3 * (MESHES * SUBMODELS + 5);
    s->indices = calloc(s->index_count, sizeof *s->indices);
    s->submodels = calloc(MESHES * SUBMODELS, sizeof *s->submodels);
    s->meshes = calloc(MESHES, sizeof *s->meshes);
    s->materials = calloc(MATERIALS, sizeof *s->materials);
    s->nodes = calloc(BOXES, sizeof *s->nodes);
    s->instances = calloc(BOXES, sizeof *s->instances);
    assert_true(s->vertices && s->indices && s->submodels && s->meshes && s->materials && s->nodes &&
                s->instances);
    make_meshes(s, &random);
    s->material_count = MATERIALS;
    for (uint32_t i = 0; i < MATERIALS; i++)
        for (int slot = 0; slot < SCENE_SLOTS; slot++)
            s->materials[i].use[slot].texture = -1;
    s->node_count = s->instance_count = BOXES;
    s->luminance = 1;
    for (uint32_t i = 0; i < BOXES; i++) {
        const double spread = i % 4 ? 15 : 2;
        const struct dvec3 at = {rig_uniform(&random, -spread, spread), rig_uniform(&random, -spread, spread),
                                 rig_uniform(&random, -spread, spread)};
        // some larger than the room, some smaller than a pixel
        const double size = i % 40 == 0 ? 12 : i % 10 == 3 ? 0.01 : exp(rig_uniform(&random, -3, 1));
        const struct dvec3 scale = {size * (i % 3 ? 1 : -1), size * 0.3, size * rig_uniform(&random, 0.2, 3)};
        const struct dquat turn = i % 6 ? rig_turn(&random, 6.28) : (struct dquat){0, 0, 0, 1};
        s->nodes[i] = (struct scene_node){.parent = -1,
                                          .local = dmat4_compose(dvec3_add(middle, at), turn, scale),
                                          .translation = dvec3_add(middle, at),
                                          .rotation = turn,
                                          .scale = scale,
                                          .animated = i % 5 == 0};
        s->instances[i] = (struct scene_instance){.mesh = (uint32_t)rig_below(&random, MESHES), .node = i};
    }
    scene_finish(s);
    return s;
}

struct box {
    struct dmat4 world_from_mesh, mesh_from_world;
    double min[3], max[3];
};

// How far a point is inside each of the five planes of an eye: left, right, bottom, top, the eye's own.
static void inside_by(const struct rig_eye *e, struct dvec3 world, double out[5])
{
    const struct dquat q = e->pose.orientation;
    const struct dvec3 p =
        dquat_rotate((struct dquat){-q.x, -q.y, -q.z, q.w}, dvec3_sub(world, e->pose.position));
    const struct viewing_fov *f = &e->fov;
    out[0] = (p.x - f->tan_left * p.z) / hypot(1, f->tan_left);
    out[1] = (-p.x - f->tan_right * p.z) / hypot(1, f->tan_right);
    out[2] = (p.y - f->tan_down * p.z) / hypot(1, f->tan_down);
    out[3] = (-p.y - f->tan_up * p.z) / hypot(1, f->tan_up);
    out[4] = -p.z;
}

static struct dvec3 at_share(const struct box *b, double x, double y, double z)
{
    return dmat4_point(&b->world_from_mesh, (struct dvec3){b->min[0] + x * (b->max[0] - b->min[0]),
                                                           b->min[1] + y * (b->max[1] - b->min[1]),
                                                           b->min[2] + z * (b->max[2] - b->min[2])});
}

static bool box_point_seen(const struct box *b, const struct rig_eye *e)
{
    enum { GRID = 7 };
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        double in[5], least = HUGE_VAL;
        inside_by(e, at_share(b, i % GRID / 6.0, i / GRID % GRID / 6.0, i / GRID / GRID / 6.0), in);
        for (int k = 0; k < 5; k++)
            least = fmin(least, in[k]);
        if (least > 0)
            return true;
    }
    return false;
}

static bool frustum_point_in_box(const struct box *b, const struct rig_eye *e)
{
    static const double distances[] = {0.05, 0.3, 1, 3, 8, 20};
    for (int i = 0; i < 9 * 9; i++) {
        const struct dvec3 ray =
            dquat_rotate(e->pose.orientation, viewing_pixel_direction(&e->fov, 9, 9, i % 9 + 0.5, i / 9 + 0.5));
        for (size_t d = 0; d < countof(distances); d++) {
            const struct dvec3 p =
                dmat4_point(&b->mesh_from_world, dvec3_add(e->pose.position, dvec3_scale(ray, distances[d])));
            if (p.x > b->min[0] && p.x < b->max[0] && p.y > b->min[1] && p.y < b->max[1] && p.z > b->min[2] &&
                p.z < b->max[2])
                return true;
        }
    }
    return false;
}

// Wholly behind one plane, by more than the margin for rounding.
static bool clearly_out(const struct box *b, const struct rig_eye *e)
{
    double most[5] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int corner = 0; corner < 8; corner++) {
        double in[5];
        inside_by(e, at_share(b, corner & 1, corner >> 1 & 1, corner >> 2), in);
        for (int k = 0; k < 5; k++)
            most[k] = fmax(most[k], in[k]);
    }
    for (int k = 0; k < 5; k++) {
        if (most[k] < -5e-4)
            return true;
    }
    return false;
}

struct bed {
    struct rig rig;
    struct scene *scene;
    struct scene_gpu *uploaded;
    struct cull cull, by_map; // by the frustum alone, and by the redraw map too
    struct gpu_image map_image;
    struct redraw redraw;
    uint32_t width, height;
    struct rig_view view;
    struct shared_item *items;
    struct box *boxes; // one an item
    uint32_t *visible, *in_frustum;
    struct shared_draw *draws;
    uint32_t *counts;
};

static void bed_open(struct bed *b, uint64_t seed, uint32_t width, uint32_t height)
{
    *b = (struct bed){.scene = make_scene(seed), .width = width, .height = height};
    assert_true(rig_open(&b->rig));
    b->uploaded = scene_gpu_create(b->rig.gpu, b->scene);
    assert_non_null(b->uploaded);
    b->map_image = rig_image(&b->rig, VK_FORMAT_R8_UINT, width, height);
    const struct redraw_desc redraw = {.gpu = b->rig.gpu,
                                       .counters = &b->rig.counters,
                                       .width = width,
                                       .height = height,
                                       .redraw_map = b->map_image.view};
    assert_true(redraw_init(&b->redraw, &redraw));
    struct cull_desc desc = {
        .gpu = b->rig.gpu, .scene = b->uploaded, .frame = &b->rig.frame, .counters = &b->rig.counters};
    assert_true(cull_init(&b->cull, &desc));
    desc.pyramid = &b->redraw.pyramid;
    desc.tiles_x = b->redraw.tiles_x;
    desc.tiles_y = b->redraw.tiles_y;
    desc.levels = b->redraw.levels;
    assert_true(cull_init(&b->by_map, &desc));
    const uint32_t count = b->uploaded->item_count;
    b->items = calloc(count, sizeof *b->items);
    b->boxes = calloc(count, sizeof *b->boxes);
    b->visible = calloc(2 * count, sizeof *b->visible);
    b->in_frustum = calloc(2 * count, sizeof *b->in_frustum);
    b->draws = calloc(2 * count, sizeof *b->draws);
    b->counts = calloc(2 * b->uploaded->bucket_count, sizeof *b->counts);
    assert_true(b->items && b->boxes && b->visible && b->in_frustum && b->draws && b->counts);
    rig_read_words(&b->rig, &b->uploaded->items, count * (uint32_t)(sizeof *b->items / 4), b->items);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t instance = b->uploaded->object_instance[b->items[i].object];
        b->boxes[i].world_from_mesh = b->scene->nodes[b->scene->instances[instance].node].local;
        b->boxes[i].mesh_from_world = dmat4_inverse(&b->boxes[i].world_from_mesh);
        for (int k = 0; k < 3; k++) {
            b->boxes[i].min[k] = (double)b->items[i].box_min[k];
            b->boxes[i].max[k] = (double)b->items[i].box_max[k];
        }
    }
}

static void bed_close(struct bed *b)
{
    cull_finish(&b->cull);
    cull_finish(&b->by_map);
    redraw_finish(&b->redraw);
    gpu_image_destroy(b->rig.gpu, &b->map_image);
    scene_gpu_destroy(b->uploaded);
    scene_destroy(b->scene);
    free(b->items);
    free(b->boxes);
    free(b->visible);
    free(b->in_frustum);
    free(b->draws);
    free(b->counts);
    rig_close(&b->rig);
}

static void look(struct bed *b, uint64_t seed)
{
    uint64_t random = seed;
    b->view = rig_view_default(b->width, b->height);
    for (int eye = 0; eye < EYES; eye++) {
        struct rig_eye *e = &b->view.eyes[eye];
        const double reach = seed % 3 ? 4 : 25; // inside the scene or at its edge
        const struct dvec3 step = {rig_uniform(&random, -reach, reach), rig_uniform(&random, -reach, reach),
                                   rig_uniform(&random, -reach, reach)};
        e->pose.position = dvec3_add(middle, step);
        e->pose.orientation = rig_turn(&random, 6.28);
        if (seed % 2) { // off-centre; the last is beside its own axis
            e->fov = (struct viewing_fov){rig_uniform(&random, 0.2, 2), rig_uniform(&random, 0.2, 2),
                                          rig_uniform(&random, 0.2, 2), rig_uniform(&random, 0.2, 2)};
            e->fov.tan_left = seed % 5 == 0 ? -0.1 : e->fov.tan_left;
        }
    }
}

static void read_back(struct bed *b, const struct cull *cull)
{
    const uint32_t count = b->uploaded->item_count;
    rig_read_words(&b->rig, &cull->visible, 2 * count, b->visible);
    rig_read_words(&b->rig, &cull->draws, 2 * count * (uint32_t)(sizeof *b->draws / 4), b->draws);
    rig_read_words(&b->rig, &cull->draw_counts, 2 * b->uploaded->bucket_count, b->counts);
}

static void run(struct bed *b)
{
    memset(b->rig.counters.mapped, 0, sizeof(struct shared_counters));
    VkCommandBuffer cmd = rig_begin(&b->rig);
    scene_gpu_update(b->uploaded, cmd, b->view.eyes[0].pose.position, 0, 0);
    b->view.origin = b->view.last_origin = b->uploaded->origin;
    rig_frame(&b->rig, &b->view);
    scene_gpu_constants(b->uploaded, b->rig.frame.mapped);
    cull_record(&b->cull, cmd, false);
    rig_end(&b->rig, cmd);
    read_back(b, &b->cull);
    memcpy(b->in_frustum, b->visible, 2 * b->uploaded->item_count * sizeof *b->visible);
}

// After `run`, for the same view.
static void run_by_map(struct bed *b, const uint8_t *map, bool moving_everywhere)
{
    memset(b->rig.counters.mapped, 0, sizeof(struct shared_counters));
    rig_upload(&b->rig, &b->map_image, 1, map);
    VkCommandBuffer cmd = rig_begin(&b->rig);
    redraw_record(&b->redraw, cmd, false);
    cull_record(&b->by_map, cmd, moving_everywhere);
    rig_end(&b->rig, cmd);
    read_back(b, &b->by_map);
}

// The draws of a bucket are its visible items, packed, in the order of the items.
static void check_draws(const struct bed *b)
{
    const struct shared_counters *counters = b->rig.counters.mapped;
    const uint32_t count = b->uploaded->item_count;
    uint64_t triangles = 0, submodels = 0;
    for (uint32_t eye = 0; eye < EYES; eye++) {
        for (uint32_t k = 0; k < b->uploaded->bucket_count; k++) {
            const struct scene_bucket *bucket = &b->uploaded->buckets[k];
            uint32_t placed = 0;
            for (uint32_t i = bucket->first_item; i < bucket->first_item + bucket->item_count; i++) {
                assert_int_equal(b->items[i].bucket, k);
                if (!b->visible[eye * count + i])
                    continue;
                const struct shared_draw *d = &b->draws[eye * count + bucket->first_item + placed++];
                assert_int_equal(d->index_count, b->items[i].index_count);
                assert_int_equal(d->first_index, b->items[i].first_index);
                assert_int_equal(d->instance_count, 1);
                assert_int_equal(d->vertex_offset, 0);
                assert_int_equal(d->first_instance, i);
                triangles += d->index_count / 3;
                submodels++;
            }
            assert_int_equal(b->counts[eye * b->uploaded->bucket_count + k], placed);
        }
    }
    assert_int_equal(counters->triangles, triangles);
    assert_int_equal(counters->submodels, submodels);
    assert_int_equal(counters->shaded_px, 0);
}

static void culling_agrees_with_brute_force(void **state)
{
    (void)state;
    uint32_t kept = 0, seen = 0, out = 0, all = 0;
    for (uint64_t world = 0; world < 3; world++) {
        struct bed b;
        bed_open(&b, world, 64, 64);
        const uint32_t count = b.uploaded->item_count;
        assert_true(count == BOXES * SUBMODELS && b.uploaded->group_count > b.uploaded->bucket_count);
        for (uint64_t seed = 0; seed < 8; seed++) {
            look(&b, 10 * world + seed);
            run(&b);
            check_draws(&b);
            for (uint32_t i = 0; i < EYES * count; i++) {
                const struct rig_eye *e = &b.view.eyes[i / count];
                const struct box *box = &b.boxes[i % count];
                assert_true(b.visible[i] <= 1);
                const bool in = box_point_seen(box, e) || frustum_point_in_box(box, e);
                const bool behind = clearly_out(box, e);
                if (in && !b.visible[i])
                    fail_msg("world %u, view %u: a box that is seen is culled", (unsigned)world,
                             (unsigned)seed);
                if (behind && b.visible[i])
                    fail_msg("world %u, view %u: a box behind a plane is kept", (unsigned)world,
                             (unsigned)seed);
                all++;
                kept += b.visible[i];
                seen += in;
                out += behind;
            }
        }
        bed_close(&b);
    }
    print_message("of %u boxes %u have a point in the frustum, %u are kept, %u are behind a plane\n", all, seen,
                  kept, out);
    assert_true(seen > all / 20 && out > all / 4 && kept < 2 * seen);
}

// --- by the redraw map ---

// Every pixel that a box may own, drawn by brute force: where the ray through its centre meets the box beyond
// the near plane, and where points of a grid in the box and on its faces fall.
static void draw_box(const struct bed *b, const struct box *box, const struct rig_eye *e, uint8_t *out)
{
    enum { GRID = 9 };
    memset(out, 0, (size_t)b->width * b->height);
    const struct dvec3 from = dmat4_point(&box->mesh_from_world, e->pose.position);
    const double eye[3] = {from.x, from.y, from.z};
    for (uint32_t i = 0; i < b->width * b->height; i++) {
        // z is -1 in the eye's frame, so that the ray's parameter is the distance in front of it
        const struct dvec3 ray =
            viewing_pixel_direction(&e->fov, b->width, b->height, i % b->width + 0.5, i / b->width + 0.5);
        const struct dvec3 d = dmat4_direction(&box->mesh_from_world,
                                               dquat_rotate(e->pose.orientation, dvec3_scale(ray, -1 / ray.z)));
        const double along[3] = {d.x, d.y, d.z};
        double enter = VIEWING_NEAR_M, leave = HUGE_VAL;
        for (int k = 0; k < 3; k++) {
            const double t[2] = {(box->min[k] - eye[k]) / along[k], (box->max[k] - eye[k]) / along[k]};
            enter = fmax(enter, fmin(t[0], t[1]));
            leave = fmin(leave, fmax(t[0], t[1]));
        }
        out[i] = enter <= leave;
    }
    const struct dquat q = e->pose.orientation;
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        const struct dvec3 world = at_share(box, i % GRID / 8.0, i / GRID % GRID / 8.0, i / GRID / GRID / 8.0);
        const struct dvec3 p =
            dquat_rotate((struct dquat){-q.x, -q.y, -q.z, q.w}, dvec3_sub(world, e->pose.position));
        double x, y;
        if (-p.z >= VIEWING_NEAR_M && viewing_pixel(&e->fov, b->width, b->height, p, &x, &y) && x >= 0 &&
            y >= 0 && x < b->width && y < b->height)
            out[(uint32_t)y * b->width + (uint32_t)x] = 1;
    }
}

enum maps { EMPTY, FULL, DISC, ONE_PIXEL, SPARSE, HALF, MAPS };

static const char *const map_names[MAPS] = {"empty", "full", "disc", "one pixel", "sparse", "half"};

static void paint(const struct bed *b, enum maps maps, uint64_t seed, uint8_t *map)
{
    uint64_t random = seed;
    const double x = rig_uniform(&random, 0, b->width), y = rig_uniform(&random, 0, b->height);
    const uint64_t pixels = b->width * b->height, one = rig_below(&random, pixels);
    for (uint32_t i = 0; i < EYES * pixels; i++) {
        const uint32_t u = i % b->width, v = i % (uint32_t)pixels / b->width;
        const bool values[MAPS] = {[FULL] = true,
                                   [DISC] = hypot(u - x, v - y) < 0.15 * b->height,
                                   [ONE_PIXEL] = i % pixels == one,
                                   [SPARSE] = rig_below(&random, 500) == 0,
                                   [HALF] = u > x};
        map[i] = values[maps];
    }
}

// In a box's middle, or with a corner of one exactly on the near plane.
static void stand_at_a_box(struct bed *b, uint64_t seed)
{
    uint64_t random = seed;
    for (int eye = 0; eye < EYES; eye++) {
        struct pose *pose = &b->view.eyes[eye].pose;
        const struct box *box = &b->boxes[rig_below(&random, b->uploaded->item_count)];
        const struct dvec3 ahead = dquat_rotate(pose->orientation, (struct dvec3){0, 0, -VIEWING_NEAR_M});
        pose->position = seed % 2 ? at_share(box, 0.5, 0.5, 0.5) : dvec3_sub(at_share(box, 0, 1, 0), ahead);
    }
}

struct tally {
    uint64_t in_frustum, owners, kept;
};

static void check_map(const struct bed *b, const uint8_t *map, const uint8_t *owned, struct tally *t)
{
    const size_t count = b->uploaded->item_count, pixels = (size_t)b->width * b->height;
    const struct shared_counters *counters = b->rig.counters.mapped;
    uint32_t submodels = 0, triangles = 0;
    for (size_t i = 0; i < EYES * count; i++) {
        if (!b->in_frustum[i]) {
            assert_int_equal(b->visible[i], 0);
            continue;
        }
        submodels++;
        triangles += b->items[i % count].index_count / 3;
        bool owner = false;
        for (size_t p = 0; p < pixels && !owner; p++)
            owner = owned[i * pixels + p] && map[i / count * pixels + p];
        if (owner && !b->visible[i])
            fail_msg("a box that owns a redrawn pixel is culled");
        t->in_frustum++;
        t->owners += owner;
        t->kept += b->visible[i];
    }
    assert_int_equal(counters->frustum_submodels, submodels);
    assert_int_equal(counters->frustum_triangles, triangles);
}

static void no_owner_of_a_redrawn_pixel_is_culled(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{64, 48}, {16, 16}, {101, 37}, {200, 90}};
    struct tally tallies[MAPS] = {{0}}, large[MAPS] = {{0}};
    for (size_t s = 0; s < countof(sizes); s++) {
        struct bed b;
        bed_open(&b, s, sizes[s][0], sizes[s][1]);
        const size_t count = EYES * b.uploaded->item_count, pixels = (size_t)b.width * b.height;
        uint8_t *owned = malloc(count * pixels), *map = malloc(EYES * pixels);
        assert_true(owned && map);
        for (uint64_t seed = 0; seed < (s < 3 ? 8 : 2); seed++) {
            look(&b, 10 * s + seed);
            if (seed % 4 > 1)
                stand_at_a_box(&b, 10 * s + seed);
            run(&b);
            for (size_t i = 0; i < count; i++) {
                if (b.in_frustum[i])
                    draw_box(&b, &b.boxes[i % (count / EYES)], &b.view.eyes[i / (count / EYES)],
                             owned + i * pixels);
            }
            for (uint64_t k = 0; k < 2 * MAPS; k++) {
                paint(&b, (enum maps)(k % MAPS), 100 * s + 10 * seed + k, map);
                run_by_map(&b, map, false);
                check_draws(&b);
                check_map(&b, map, owned, &tallies[k % MAPS]);
                if (s == 3)
                    check_map(&b, map, owned, &large[k % MAPS]);
            }
        }
        free(owned);
        free(map);
        bed_close(&b);
    }
    for (int k = 0; k < MAPS; k++)
        print_message("%s map: of %llu boxes in the frustum %llu own a redrawn pixel, %llu are kept\n",
                      map_names[k], (unsigned long long)tallies[k].in_frustum,
                      (unsigned long long)tallies[k].owners, (unsigned long long)tallies[k].kept);
    print_message("the largest image: disc %llu of %llu, %llu kept; half %llu, %llu kept\n",
                  (unsigned long long)large[DISC].owners, (unsigned long long)large[DISC].in_frustum,
                  (unsigned long long)large[DISC].kept, (unsigned long long)large[HALF].owners,
                  (unsigned long long)large[HALF].kept);
    assert_int_equal(tallies[EMPTY].kept, 0);
    // tiles of 8 pixels and a margin of 2: in an image of 200 x 90 they cost this much, in a large one less
    assert_true(large[DISC].kept < 3 * large[DISC].owners && 10 * large[HALF].kept < 11 * large[HALF].owners);
    assert_true(100 * tallies[FULL].kept < 102 * tallies[FULL].owners);
    assert_true(tallies[FULL].owners > 10000 && tallies[DISC].owners > 1000 && tallies[ONE_PIXEL].owners > 100);
}

static void moving_objects_may_be_drawn_everywhere(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 5, 64, 48);
    const uint32_t count = b.uploaded->item_count;
    uint8_t *map = calloc(EYES * 64 * 48, 1); // empty
    uint32_t moving = 0;
    for (uint64_t seed = 0; seed < 4; seed++) {
        look(&b, seed);
        run(&b);
        run_by_map(&b, map, true);
        check_draws(&b);
        for (uint32_t i = 0; i < EYES * count; i++) {
            const uint32_t instance = b.uploaded->object_instance[b.items[i % count].object];
            const bool moves = b.scene->nodes[b.scene->instances[instance].node].animated;
            assert_int_equal(b.visible[i], b.in_frustum[i] && moves);
            moving += b.visible[i];
        }
        memset(map, 1, EYES * 64 * 48);
        run_by_map(&b, map, false);
        memcpy(b.in_frustum, b.visible, EYES * count * sizeof *b.visible);
        run_by_map(&b, map, true); // adds at most what the frustum keeps beside the image
        for (uint32_t i = 0; i < EYES * count; i++)
            assert_true(b.visible[i] >= b.in_frustum[i]);
        memset(map, 0, EYES * 64 * 48);
    }
    assert_true(moving > 100);
    free(map);
    bed_close(&b);
}

static void looking_away_culls_everything(void **state)
{
    (void)state;
    struct bed b;
    bed_open(&b, 1, 64, 64);
    look(&b, 2);
    for (int eye = 0; eye < EYES; eye++)
        b.view.eyes[eye].pose = (struct pose){dvec3_add(middle, (struct dvec3){0, 0, -100}), {0, 0, 0, 1}};
    run(&b);
    check_draws(&b);
    const struct shared_counters *counters = b.rig.counters.mapped;
    assert_int_equal(counters->submodels, 0);
    bed_close(&b);
}

int main(void)
{
    struct rig probe;
    if (!rig_open(&probe))
        return 77;
    rig_close(&probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(culling_agrees_with_brute_force),
        cmocka_unit_test(looking_away_culls_everything),
        cmocka_unit_test(no_owner_of_a_redrawn_pixel_is_culled),
        cmocka_unit_test(moving_objects_may_be_drawn_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
