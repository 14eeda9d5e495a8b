#include "tests/renderer/passes/cull_bed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

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

struct dvec3 bed_at_share(const struct box *b, double x, double y, double z)
{
    return dmat4_point(&b->world_from_mesh, (struct dvec3){b->min[0] + x * (b->max[0] - b->min[0]),
                                                           b->min[1] + y * (b->max[1] - b->min[1]),
                                                           b->min[2] + z * (b->max[2] - b->min[2])});
}

bool bed_box_point_seen(const struct box *b, const struct rig_eye *e)
{
    enum { GRID = 7 };
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        double in[5], least = HUGE_VAL;
        inside_by(e, bed_at_share(b, i % GRID / 6.0, i / GRID % GRID / 6.0, i / GRID / GRID / 6.0), in);
        for (int k = 0; k < 5; k++)
            least = fmin(least, in[k]);
        if (least > 0)
            return true;
    }
    return false;
}

bool bed_frustum_point_in_box(const struct box *b, const struct rig_eye *e)
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

bool bed_clearly_out(const struct box *b, const struct rig_eye *e)
{
    double most[5] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int corner = 0; corner < 8; corner++) {
        double in[5];
        inside_by(e, bed_at_share(b, corner & 1, corner >> 1 & 1, corner >> 2), in);
        for (int k = 0; k < 5; k++)
            most[k] = fmax(most[k], in[k]);
    }
    for (int k = 0; k < 5; k++) {
        if (most[k] < -5e-4)
            return true;
    }
    return false;
}

void bed_open(struct bed *b, uint64_t seed, uint32_t width, uint32_t height)
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

void bed_close(struct bed *b)
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

void bed_look(struct bed *b, uint64_t seed)
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

void bed_run(struct bed *b)
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

void bed_run_by_map(struct bed *b, const uint8_t *map, bool moving_everywhere)
{
    memset(b->rig.counters.mapped, 0, sizeof(struct shared_counters));
    rig_upload(&b->rig, &b->map_image, 1, map);
    VkCommandBuffer cmd = rig_begin(&b->rig);
    redraw_record(&b->redraw, cmd, false);
    cull_record(&b->by_map, cmd, moving_everywhere);
    rig_end(&b->rig, cmd);
    read_back(b, &b->by_map);
}
