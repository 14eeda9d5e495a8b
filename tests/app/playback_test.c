// A played frame is, byte for byte, what the live option would have drawn with the same number; and what does
// not fit is refused in a sentence. Exit 77 where no device can draw.
#include "app/fovstudy/catalogue.h"
#include "app/session/playback.h"
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 64, HEIGHT = 72, RATE = 20 };
#define FORMAT                                                                                                 \
    "fovstudy: 1\n"                                                                                            \
    "name: played\n"                                                                                           \
    "title: Played back\n"                                                                                     \
    "seed: 3\n"                                                                                                \
    "scenes: [town]\n"                                                                                         \
    "options:\n"                                                                                               \
    "  warped: {mode: time_warped, playback: prerendered}\n"                                                   \
    "  regular: {mode: regular, playback: prerendered}\n"                                                      \
    "reference: regular\n"                                                                                     \
    "questions: {better: {text: \"Which?\"}}\n"                                                                \
    "instructions: Look.\n"                                                                                    \
    "consent: {version: \"1\", text: Yes?}\n"                                                                  \
    "settings: {question: better, fixation: cross, foveate: target, view_s: 0.6, ssao: on, taa: %s,\n"         \
    "  moving_objects: %s}\n"                                                                                  \
    "blocks: [{name: one, kind: sequential, options: [warped, regular], repetitions: 2, order: fixed}]\n"

struct rig {
    struct study_names names;
    struct protocol *protocol;
    struct plan *plan;
    struct renderer *renderer;
    struct scene *scene;
    struct stage_scene scenes[1];
    struct stage *stage;
    struct playback *playback;
    uint32_t drawn;
    uint8_t *live[2][64][EYES]; // as the screen had it
};

static bool at_cross(void *user, const struct machine_view *view, struct fovea_use *out)
{
    (void)user;
    (void)view;
    *out = (struct fovea_use){.known = false};
    return true;
}

static bool count_drawn(void *user, const struct machine_view *view, uint32_t number, const struct frame *frame)
{
    struct rig *rig = user;
    assert_int_equal(frame->number, number);
    assert_true(view->trial->prerendered[view->slot]);
    rig->drawn++;
    return true;
}

static void open_playback(struct rig *rig, uint64_t budget_bytes)
{
    rig->playback = playback_create(&(struct playback_desc){.renderer = rig->renderer,
                                                            .stage = rig->stage,
                                                            .width = WIDTH,
                                                            .height = HEIGHT,
                                                            .budget_bytes = budget_bytes,
                                                            .fovea = at_cross,
                                                            .drawn = count_drawn,
                                                            .user = rig});
    assert_non_null(rig->playback);
}

static void open_rig(struct rig *rig, const char *taa, const char *moving)
{
    char error[PROTOCOL_ERROR] = "", text[2048];
    snprintf(text, sizeof text, FORMAT, taa, moving);
    memset(rig, 0, sizeof *rig);
    assert_true(study_names_init(&rig->names, NULL, 0));
    rig->protocol = protocol_parse("played", text, strlen(text), &rig->names.catalogue, error, sizeof error);
    if (!rig->protocol)
        fail_msg("%s", error);
    rig->plan = plan_create(rig->protocol, 3, 0);
    assert_true(rig->plan && playback_needed(rig->plan));
    rig->renderer = renderer_create(&(struct renderer_desc){.width = WIDTH, .height = HEIGHT});
    rig->scene = scene_open("town:triangles=20000", error, sizeof error);
    assert_true(rig->renderer && rig->scene);
    rig->scenes[0] = (struct stage_scene){.name = "town", .spec = "town", .scene = rig->scene};
    rig->stage = stage_create(&(struct stage_desc){.renderer = rig->renderer,
                                                   .plan = rig->plan,
                                                   .scenes = rig->scenes,
                                                   .scene_count = 1,
                                                   .fov = viewing_symmetric_fov(100.0, WIDTH, HEIGHT),
                                                   .ipd_m = VIEWING_DEFAULT_IPD_M,
                                                   .moving_setting = STUDY_MOVING_OBJECTS,
                                                   .ssao_setting = STUDY_SSAO,
                                                   .taa_setting = STUDY_TAA});
    assert_non_null(rig->stage);
    open_playback(rig, 0);
}

static void close_rig(struct rig *rig)
{
    for (int slot = 0; slot < 2; slot++)
        for (int i = 0; i < 64; i++)
            for (int eye = 0; eye < EYES; eye++)
                free(rig->live[slot][i][eye]);
    playback_destroy(rig->playback);
    stage_destroy(rig->stage);
    renderer_destroy(rig->renderer);
    scene_destroy(rig->scene);
    plan_destroy(rig->plan);
    protocol_destroy(rig->protocol);
    study_names_finish(&rig->names);
}

// As the machine has it at the n-th frame of a showing.
static struct machine_view view_of(const struct rig *rig, uint32_t trial, int slot, uint32_t number)
{
    return (struct machine_view){.screen = MACHINE_STIMULUS,
                                 .trial = &rig->plan->trials[trial],
                                 .trial_index = trial,
                                 .attempt = 1,
                                 .slot = (enum plan_slot)slot,
                                 .condition = rig->plan->trials[trial].option[slot],
                                 .showing = (uint32_t)slot,
                                 .trial_started = number == 0,
                                 .stimulus_ns = (int64_t)number * (1000000000 / RATE)};
}

static struct machine_view rest_before(const struct rig *rig, uint32_t trial)
{
    struct machine_view view = view_of(rig, trial, 0, 0);
    view.screen = MACHINE_REST;
    view.attempt = 0;
    return view;
}

static void read_screen(const struct rig *rig, uint8_t *out[EYES])
{
    for (int eye = 0; eye < EYES; eye++) {
        out[eye] = malloc(4 * WIDTH * HEIGHT);
        assert_true(out[eye] && renderer_read_screen(rig->renderer, eye, out[eye]));
    }
}

static double fade_at(uint32_t number)
{
    return number < 3 ? 0.75 - 0.25 * number : 0.0;
}

static void draw_live(struct rig *rig, int slot, uint32_t frames)
{
    char error[512];
    struct machine_view at_rest = rest_before(rig, 0);
    assert_true(stage_prepare(rig->stage, &at_rest, error, sizeof error));
    for (uint32_t i = 0; i < frames; i++) {
        struct pose head;
        struct frame_stats stats;
        struct fovea_use use = {.known = false};
        struct machine_view view = view_of(rig, 0, slot, i);
        struct frame frame = stage_frame(rig->stage, &view, i, &use, &head);
        struct renderer_option *option = stage_option(rig->stage, (enum plan_slot)slot);
        assert_true(renderer_draw(option, &frame, &stats) && renderer_show(rig->renderer, option, fade_at(i)));
        read_screen(rig, rig->live[slot][i]);
    }
}

static void prepare(struct rig *rig, uint32_t trial)
{
    char error[512] = "";
    double done = 0.0, before = -1.0;
    struct machine_view view = rest_before(rig, trial);
    assert_true(stage_prepare(rig->stage, &view, error, sizeof error));
    while (done < 1.0) { // a frame at a time
        if (!playback_prepare(rig->playback, &view, RATE, 0.0, &done, error, sizeof error))
            fail_msg("%s", error);
        assert_true(done > before);
        before = done;
    }
}

static void play(struct rig *rig, uint32_t trial, int slot, uint32_t frames)
{
    int live = rig->plan->trials[trial].option[slot] == rig->plan->trials[0].option[slot] ? slot : 1 - slot;
    for (uint32_t i = 0; i < frames; i++) {
        bool fresh = false, held = true;
        char wanted[64];
        uint8_t *shown[EYES];
        struct store_frame row = {.shaded_px = -1, .triangles = -1};
        struct machine_view view = view_of(rig, trial, slot, i);
        assert_true(playback_plays(rig->playback, &view));
        playback_take(rig->playback, &view, true, &row, &fresh, &held);
        assert_true(fresh && !held);
        snprintf(wanted, sizeof wanted, "{\"playback\":\"prerendered\",\"frame\":%u}", i);
        assert_string_equal(row.effective, wanted);
        assert_true(row.shaded_px > 0 && row.triangles > 0 && row.fovea_source == STORE_FOVEA_TARGET);
        assert_true(playback_show(rig->playback, (enum plan_slot)slot, fade_at(i)));
        read_screen(rig, shown);
        for (int eye = 0; eye < EYES; eye++) {
            assert_memory_equal(shown[eye], rig->live[live][i][eye], 4 * WIDTH * HEIGHT);
            free(shown[eye]);
        }
        // The same once more, as between two pictures of a slower rate.
        playback_take(rig->playback, &view, true, &row, &fresh, &held);
        assert_true(!fresh && !held);
    }
}

static void played_is_live(const char *taa, const char *moving)
{
    struct rig rig;
    open_rig(&rig, taa, moving);
    for (int slot = 0; slot < 2; slot++)
        draw_live(&rig, slot, 16);
    bool differ = false;
    for (int i = 0; i < 16; i++)
        differ = differ || memcmp(rig.live[0][i][0], rig.live[1][i][0], 4 * WIDTH * HEIGHT) != 0;
    assert_true(differ); // the two options are two
    prepare(&rig, 0);
    uint32_t drawn = rig.drawn;
    assert_true(drawn >= 2 * 16);
    for (int slot = 0; slot < 2; slot++)
        play(&rig, 0, slot, 16);
    // The repetition, sides perhaps changed, is played from the same recordings.
    prepare(&rig, 1);
    assert_int_equal(rig.drawn, drawn);
    for (int slot = 0; slot < 2; slot++)
        play(&rig, 1, slot, 16);
    close_rig(&rig);
}

static void played_is_live_without_taa(void **state)
{
    (void)state;
    played_is_live("off", "off");
}

static void played_is_live_with_taa(void **state)
{
    (void)state;
    played_is_live("on", "off");
}

static void played_is_live_with_moving_objects(void **state)
{
    (void)state;
    played_is_live("on", "on");
}

// Time decides which frame is shown; past the last one that is held, and told.
static void time_decides(void **state)
{
    (void)state;
    struct rig rig;
    open_rig(&rig, "off", "off");
    prepare(&rig, 0);
    uint32_t frames = 0;
    uint64_t bytes = 0;
    playback_size(rig.playback, PLAN_SLOT_A, &frames, &bytes);
    assert_true(frames >= (0.6 + 0.125 + 0.125) * RATE && bytes > 0 &&
                bytes < (uint64_t)frames * 8 * WIDTH * HEIGHT);
    static const struct {
        double time_s;
        uint32_t frame;
    } cases[] = {{0.0, 0}, {0.024, 0}, {0.026, 1}, {0.3, 6}, {0.31, 6}, {0.1, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char wanted[64];
        bool fresh, held;
        struct store_frame row = {0};
        struct machine_view view = view_of(&rig, 0, 0, 0);
        view.stimulus_ns = (int64_t)(cases[i].time_s * 1e9);
        playback_take(rig.playback, &view, true, &row, &fresh, &held);
        snprintf(wanted, sizeof wanted, "{\"playback\":\"prerendered\",\"frame\":%u}", cases[i].frame);
        assert_string_equal(row.effective, wanted);
        assert_false(held);
    }
    bool fresh, held;
    struct store_frame row = {0};
    struct machine_view view = view_of(&rig, 0, 0, 1);
    view.stimulus_ns = 60000000000;
    playback_take(rig.playback, &view, true, &row, &fresh, &held);
    assert_true(fresh && held);
    close_rig(&rig);
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    char error[512] = "";
    double done = 0.0;
    struct rig rig;
    open_rig(&rig, "off", "off");
    playback_destroy(rig.playback);
    open_playback(&rig, 50000);
    struct machine_view view = view_of(&rig, 0, 0, 0);
    assert_true(stage_prepare(rig.stage, &view, error, sizeof error));
    assert_false(playback_prepare(rig.playback, &view, RATE, 60.0, &done, error, sizeof error));
    print_message("%s\n", error);
    assert_non_null(strstr(error, "prerendered pictures of an option in trial 1 need about "));
    assert_non_null(strstr(error, "view_s"));
    assert_true(rig.drawn < 16); // known before it is drawn to its end
    close_rig(&rig);
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(played_is_live_without_taa),         cmocka_unit_test(played_is_live_with_taa),
        cmocka_unit_test(played_is_live_with_moving_objects), cmocka_unit_test(time_decides),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
