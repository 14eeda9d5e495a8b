// Culling against brute force: by the frustum, points of boxes against frusta and points of frusta against
// boxes; by the redraw map, boxes drawn pixel by pixel; and the compaction of what is left.
#include "tests/renderer/passes/cull_bed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

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
            bed_look(&b, 10 * world + seed);
            bed_run(&b);
            check_draws(&b);
            for (uint32_t i = 0; i < EYES * count; i++) {
                const struct rig_eye *e = &b.view.eyes[i / count];
                const struct box *box = &b.boxes[i % count];
                assert_true(b.visible[i] <= 1);
                const bool in = bed_box_point_seen(box, e) || bed_frustum_point_in_box(box, e);
                const bool behind = bed_clearly_out(box, e);
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
        const struct dvec3 world =
            bed_at_share(box, i % GRID / 8.0, i / GRID % GRID / 8.0, i / GRID / GRID / 8.0);
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
        pose->position =
            seed % 2 ? bed_at_share(box, 0.5, 0.5, 0.5) : dvec3_sub(bed_at_share(box, 0, 1, 0), ahead);
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
            bed_look(&b, 10 * s + seed);
            if (seed % 4 > 1)
                stand_at_a_box(&b, 10 * s + seed);
            bed_run(&b);
            for (size_t i = 0; i < count; i++) {
                if (b.in_frustum[i])
                    draw_box(&b, &b.boxes[i % (count / EYES)], &b.view.eyes[i / (count / EYES)],
                             owned + i * pixels);
            }
            for (uint64_t k = 0; k < 2 * MAPS; k++) {
                paint(&b, (enum maps)(k % MAPS), 100 * s + 10 * seed + k, map);
                bed_run_by_map(&b, map, false);
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
        bed_look(&b, seed);
        bed_run(&b);
        bed_run_by_map(&b, map, true);
        check_draws(&b);
        for (uint32_t i = 0; i < EYES * count; i++) {
            const uint32_t instance = b.uploaded->object_instance[b.items[i % count].object];
            const bool moves = b.scene->nodes[b.scene->instances[instance].node].animated;
            assert_int_equal(b.visible[i], b.in_frustum[i] && moves);
            moving += b.visible[i];
        }
        memset(map, 1, EYES * 64 * 48);
        bed_run_by_map(&b, map, false);
        memcpy(b.in_frustum, b.visible, EYES * count * sizeof *b.visible);
        bed_run_by_map(&b, map, true); // adds at most what the frustum keeps beside the image
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
    bed_look(&b, 2);
    for (int eye = 0; eye < EYES; eye++)
        b.view.eyes[eye].pose = (struct pose){dvec3_add(middle, (struct dvec3){0, 0, -100}), {0, 0, 0, 1}};
    bed_run(&b);
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
