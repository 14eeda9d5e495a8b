// A rehearsal at the keyboard, in this process: from a trial's first frame to its answer no pipeline, target or
// buffer is made, by text neither. Exit 77 where no device can draw.
#include "app/fovstudy/run_study.h"
#include "app/session/session.h"
#include "tests/app/command.h"
#include "tests/renderer/creations.h"

#include <GLFW/glfw3.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char protocol[] =
    "fovstudy: 1\n"
    "name: all_modes\n"
    "title: Every mode, every setting\n"
    "seed: 3\n"
    "scenes: [atrium]\n"
    "options:\n"
    "  warped: {mode: time_warped}\n"
    "  coarse: {mode: vrs}\n"
    "  regular: {mode: regular}\n"
    "  kept: {mode: regular, playback: prerendered}\n"
    "reference: regular\n"
    "settings: {advance: auto, rest_s: 0.2, question: prefer, moving_objects: on}\n"
    "questions:\n"
    "  prefer: {text: \"A or B?\"}\n"
    "  quality: {text: How good?, scale: [1, 10], labels: [bad, good]}\n"
    "instructions: Choose.\n"
    "consent: {version: \"1\", text: Yes?}\n"
    "blocks:\n"
    "  - {name: one, kind: toggle, options: [warped, regular],\n"
    "     settings: {ssao: on, taa: on, fixation: moving, foveate: target}}\n"
    "  - {name: two, kind: toggle, options: [coarse, warped], settings: {moving_objects: off, fixation: "
    "cross}}\n"
    "  - {name: three, kind: toggle, options: [coarse, regular], settings: {ssao: on}}\n"
    "  - {name: four, kind: rate, options: [warped], settings: {question: quality, taa: on}}\n"
    "  - {name: five, kind: rate, options: [kept], settings: {question: quality, taa: on, view_s: 1}}\n"
    "  - {name: six, kind: sequential, options: [warped, kept], settings: {view_s: 1}}\n";

// Somebody presses these over and over, a key every KEY_FRAMES frames, a fade and a little: what means nothing
// is ignored.
enum { KEY_FRAMES = 12, MOST_FRAMES = 6000 };
static const int keys[2][6] = {
    {GLFW_KEY_Y, GLFW_KEY_ENTER, GLFW_KEY_ENTER, GLFW_KEY_Y, GLFW_KEY_ENTER, GLFW_KEY_ENTER},
    {GLFW_KEY_SPACE, GLFW_KEY_P, GLFW_KEY_ENTER, GLFW_KEY_7, GLFW_KEY_ENTER, GLFW_KEY_A}, // in a trial
};

// Of the running test; a display's calls carry nothing of ours.
static bool in_trial;
static uint64_t frame, pressed_at;
static size_t pressed;

static bool press(struct display *display, struct display_key *out)
{
    if (frame < pressed_at + KEY_FRAMES)
        return false;
    pressed_at = frame;
    *out = (struct display_key){
        .at_ns = display_now_ns(display), .key = keys[in_trial][pressed++ % 6], .pressed = true};
    return true;
}

static void count_frame(struct display *display)
{
    frame++;
    display_headless.shown(display);
}

static bool go_on(struct display *display)
{
    (void)display;
    return frame < MOST_FRAMES;
}

struct watch {
    uint32_t trials;
    struct creations made; // of all trials
    uint32_t before;       // things made outside of trials
};

static void add(struct creations *sum, const struct creations *c)
{
    sum->pipelines += c->pipelines;
    sum->shaders += c->shaders;
    sum->images += c->images;
    sum->views += c->views;
    sum->buffers += c->buffers;
    sum->allocations += c->allocations;
}

// From its first frame until the answer is on disk.
static bool is_trial(enum machine_screen screen)
{
    return screen == MACHINE_STIMULUS || screen == MACHINE_QUESTION || screen == MACHINE_STORING ||
           screen == MACHINE_PAUSED;
}

static void follow(void *user, const struct machine_view *view)
{
    struct watch *w = user;
    if (is_trial(view->screen) == in_trial)
        return;
    const struct creations made = creations_end();
    if (in_trial)
        add(&w->made, &made);
    else
        w->before += creations_total(&made);
    in_trial = !in_trial;
    w->trials += in_trial;
    creations_begin();
}

struct session {
    struct run_study study;
    struct run_view view;
    struct run_rows rows;
    struct event_lines lines;
    struct stage *stage;
    struct display_kind kind; // headless, with keys
};

static void open_session(struct session *s, const struct run_options *options)
{
    char error[RUN_ERROR] = "";
    s->lines.file = -1;
    if (!run_study_init(&s->study, options, error, sizeof error) ||
        !run_view_init(&s->view, options, s->study.protocol, error, sizeof error) ||
        !run_rows_open(&s->rows, options, &s->study, error, sizeof error) ||
        !run_view_gaze(&s->view, options, 1, error, sizeof error) ||
        !run_rows_create(&s->rows, options, &s->study, &s->view, error, sizeof error) ||
        !run_rows_reference(&s->rows, &s->study, error, sizeof error))
        fail_msg("%s", error);
    s->kind = display_headless;
    s->kind.key = press;
    s->kind.shown = count_frame;
    s->kind.poll = go_on;
    s->view.display->kind = &s->kind;
    s->stage = stage_create(&(struct stage_desc){.renderer = s->view.renderer,
                                                 .plan = s->rows.plan,
                                                 .scenes = s->view.scenes,
                                                 .scene_count = s->view.scene_count,
                                                 .fov = s->view.fov,
                                                 .ipd_m = VIEWING_DEFAULT_IPD_M,
                                                 .moving_setting = STUDY_MOVING_OBJECTS,
                                                 .ssao_setting = STUDY_SSAO,
                                                 .taa_setting = STUDY_TAA});
    assert_non_null(s->stage);
}

static void close_session(struct session *s)
{
    char error[RUN_ERROR] = "";
    stage_destroy(s->stage);
    if (!run_rows_finish(&s->rows, error, sizeof error))
        fail_msg("%s", error);
    run_view_finish(&s->view);
    run_study_finish(&s->study);
}

static void a_session_makes_nothing_in_its_trials(void **state)
{
    (void)state;
    char folder[512], file[600], database[600], error[RUN_ERROR] = "";
    command_folder("creations", folder, sizeof folder);
    snprintf(file, sizeof file, "%s/protocol.yaml", folder);
    snprintf(database, sizeof database, "%s/study.db", folder);
    FILE *out = fopen(file, "w");
    assert_true(out && fputs(protocol, out) >= 0 && fclose(out) == 0);
    const struct run_options options = {.protocol = file,
                                        .database = database,
                                        .participant = "p1",
                                        .display = "headless",
                                        .gaze = "sim",
                                        .scenes = {{"atrium", "town:triangles=20000"}},
                                        .scene_count = 1,
                                        .width = 48,
                                        .height = 54,
                                        .fov_deg = VIEWING_DEFAULT_FOV_DEG,
                                        .refresh_hz = 20};
    struct session s = {0};
    struct watch watch = {0};
    open_session(&s, &options);
    creations_begin();
    const enum session_result result = session_run(&(struct session_desc){.plan = s.rows.plan,
                                                                          .store = s.rows.store,
                                                                          .ids = &s.rows.ids,
                                                                          .reference_id = s.rows.reference_id,
                                                                          .lines = &s.lines,
                                                                          .display = s.view.display,
                                                                          .renderer = s.view.renderer,
                                                                          .stage = s.stage,
                                                                          .scenes = s.view.scenes,
                                                                          .scene_count = s.view.scene_count,
                                                                          .fov = s.view.fov,
                                                                          .ipd_m = VIEWING_DEFAULT_IPD_M,
                                                                          .gaze = s.view.gaze,
                                                                          .progress = follow,
                                                                          .progress_user = &watch},
                                                   error, sizeof error);
    creations_end();
    if (result != SESSION_COMPLETE)
        fail_msg("%s", error);
    print_message("%llu frames, %u stretches of trials; %u things made outside of them\n",
                  (unsigned long long)frame, watch.trials, watch.before);
    close_session(&s);
    assert_true(watch.trials >= 6 && watch.before > 100);
    const struct creations *c = &watch.made;
    if (creations_total(c))
        fail_msg("made in a trial: %u pipelines, %u shaders, %u images, %u views, %u buffers, %u allocations",
                 c->pipelines, c->shaders, c->images, c->views, c->buffers, c->allocations);
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_session_makes_nothing_in_its_trials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
