// The studies in studies/protocols are those of their papers: what each paper states is checked here, in its
// protocol and in the plans that come of it. Modes that the program lacks are named so, and nothing else is
// wrong.
#include "studies/engine/plan.h"
#include "studies/protocol/protocol.h"
#include "tests/studies/protocol/papers_catalogue.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SECOND = 1000000000 };

static struct protocol *load_with(const char *name, bool with_all, char error[PROTOCOL_ERROR])
{
    char path[512];
    snprintf(path, sizeof path, "%s/studies/protocols/%s", SOURCE_DIR, name);
    error[0] = '\0';
    return protocol_load(path, papers_catalogue(with_all), error, PROTOCOL_ERROR);
}

static struct protocol *load(const char *name)
{
    char error[PROTOCOL_ERROR];
    struct protocol *protocol = load_with(name, true, error);
    assert_string_equal(error, "");
    return protocol;
}

static double value_of(const struct protocol *protocol, const struct protocol_option *option, const char *name)
{
    const struct catalogue_mode *mode = &protocol->catalogue->modes[option->mode];
    for (uint32_t i = 0; i < mode->parameter_count; i++)
        if (strcmp(mode->parameters[i].name, name) == 0)
            return option->values[i];
    fail_msg("%s has no %s", mode->name, name);
    return 0;
}

static void assert_value(const struct protocol *protocol, const struct protocol_option *option,
                         const char *name, double expected)
{
    double found = value_of(protocol, option, name);
    if (found < expected || found > expected)
        fail_msg("%s of %s is %g, not %g", name, option->name, found, expected);
}

static const char *mode_of(const struct protocol *protocol, const struct protocol_option *option)
{
    return protocol->catalogue->modes[option->mode].name;
}

// Every factors JSON of a trial that a text stands in.
static bool says(const struct plan_trial *trial, const char *member)
{
    return strstr(trial->factors, member) != NULL;
}

static void test_every_file_can_be_read(void **state)
{
    (void)state;
    DIR *folder = opendir(SOURCE_DIR "/studies/protocols");
    assert_non_null(folder);
    uint32_t files = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        const char *end = strrchr(entry->d_name, '.');
        if (!end || strcmp(end, ".yaml") != 0)
            continue;
        struct protocol *protocol = load(entry->d_name);
        struct plan *plan = plan_create(protocol, protocol->seed, 0);
        assert_non_null(plan);
        assert_int_equal(plan->imbalance, 0);
        assert_int_equal(strncmp(protocol->name, entry->d_name, (size_t)(end - entry->d_name)), 0);
        plan_destroy(plan);
        protocol_destroy(protocol);
        files++;
    }
    closedir(folder);
    assert_true(files >= 8);
}

static void test_missing_modes_are_all_that_is_missing(void **state)
{
    (void)state;
    static const struct {
        const char *file, *mode;
    } files[] = {{"regions.yaml", "ray_traced"},
                 {"acuity.yaml", "adaptive"},
                 {"validation.yaml", "adaptive"},
                 {"alignment.yaml", "phase_aligned"},
                 {"latency.yaml", "latency_inset"}};
    char error[PROTOCOL_ERROR], expected[256];
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        assert_null(load_with(files[i].file, false, error));
        const char *after = strrchr(error, '/');
        assert_non_null(after);
        uint32_t line = 0, column = 0;
        assert_int_equal(sscanf(strchr(after, ':'), ":%u:%u", &line, &column), 2);
        snprintf(
            expected, sizeof expected,
            "/%s:%u:%u: mode '%s' does not exist in this program yet; `fovstudy modes` lists those that do",
            files[i].file, line, column, files[i].mode);
        assert_string_equal(after, expected);
        assert_true(line > 1 && column > 1);
    }
    static const char *const present[] = {"calibration.yaml", "verification.yaml", "short.yaml"};
    for (size_t i = 0; i < sizeof present / sizeof present[0]; i++) {
        struct protocol *protocol = load_with(present[i], false, error);
        assert_string_equal(error, "");
        protocol_destroy(protocol);
    }
}

// Franke 2021, Table 1. Setup A is the option under test. 'f': all foveated, 'm': mixed, 'r': all regular.
static void test_verification_is_table_1(void **state)
{
    (void)state;
    static const struct {
        const char *test, *scene;
        char a, b;
        bool moves, occludes;
    } table[12] = {
        {"I", "suntemple1", 'f', 'r', false, false},  {"I", "rungholt1", 'f', 'r', false, false},
        {"II", "bistro", 'f', 'r', true, false},      {"II", "lostempire", 'f', 'r', true, false},
        {"III", "suntemple1", 'f', 'r', false, true}, {"III", "rungholt1", 'f', 'r', false, true},
        {"IV", "suntemple2", 'f', 'r', true, true},   {"IV", "rungholt2", 'f', 'r', true, true},
        {"V", "bistro", 'f', 'm', true, false},       {"V", "lostempire", 'f', 'm', true, false},
        {"VI", "bistro", 'm', 'r', true, false},      {"VI", "lostempire", 'm', 'r', true, false},
    };
    struct protocol *p = load("verification.yaml");
    assert_int_equal(p->participants, 22);
    assert_int_equal(p->block_count, 1);
    const struct protocol_block *block = &p->blocks[0];
    assert_int_equal(block->kind, PROTOCOL_TOGGLE);
    assert_true(block->listed);
    assert_int_equal(protocol_block_trials(block), 12);
    for (uint32_t i = 0; i < 12; i++) {
        const struct protocol_cell *cell = &block->cells[i];
        char label[64];
        snprintf(label, sizeof label, "\"test\":\"%s\"", table[i].test);
        assert_non_null(strstr(cell->labels, label));
        assert_string_equal(p->scenes[cell->scene], table[i].scene);
        bool realistic = table[i].scene[0] == 's' || table[i].scene[0] == 'b';
        assert_string_equal(p->scene_labels[cell->scene],
                            realistic ? ",\"scene_type\":\"realistic\"" : ",\"scene_type\":\"blocks\"");
        assert_true(*p->stand_ins[cell->scene]);
        for (uint32_t k = 0; k < 2; k++) {
            char setup = k ? table[i].b : table[i].a;
            const struct protocol_option *option = &cell->option[k];
            assert_string_equal(mode_of(p, option), setup == 'r' ? "regular" : "time_warped");
            if (setup == 'r')
                continue;
            assert_value(p, option, "epsilon", 0.2);
            assert_value(p, option, "fovea_deg", 10);
            assert_value(p, option, "dynamic_objects", setup == 'm');
        }
        assert_true((cell->settings.render[PAPERS_MOVING_OBJECTS] > 0) == table[i].moves);
        assert_true((cell->settings.render[PAPERS_SSAO] > 0) == table[i].occludes);
        assert_int_equal(cell->settings.fade_to_gray_ns + cell->settings.fade_gray_ns +
                             cell->settings.fade_from_gray_ns,
                         SECOND / 2);
        assert_int_equal(cell->settings.view_ns, 0);
        assert_int_equal(cell->settings.rating_count, 1);
        const struct protocol_question *rating = &p->questions[cell->settings.ratings[0]];
        assert_true(rating->scale_min == 1 && rating->scale_max == 10);
        const struct protocol_question *choice = &p->questions[cell->settings.asked[0]];
        assert_true(choice->type == PROTOCOL_ASK_CHOICE && !choice->equal && !choice->correct);
    }
    struct plan *plan = plan_create(p, p->seed, 3);
    assert_int_equal(plan->trial_count, 12);
    assert_true(says(&plan->trials[0], "\"scene_type\":\"") && says(&plan->trials[0], "\"test\":\""));
    plan_destroy(plan);
    protocol_destroy(p);
}

static void check_region(const struct protocol *p, const struct protocol_option *option, const char *name)
{
    static const struct {
        const char *name;
        double inner, outer, least;
    } regions[] = {{"small", 5, 10, 0.01}, {"medium", 10, 20, 0.05}, {"large", 15, 30, 0.1}};
    assert_string_equal(option->name, name);
    if (strcmp(name, "full") == 0) {
        assert_string_equal(mode_of(p, option), "ray_traced_full");
        assert_int_equal(option->playback, PROTOCOL_PRERENDERED);
        return;
    }
    for (uint32_t i = 0; i < 3; i++) {
        if (strcmp(regions[i].name, name) != 0)
            continue;
        assert_string_equal(mode_of(p, option), "ray_traced");
        assert_value(p, option, "inner_deg", regions[i].inner);
        assert_value(p, option, "outer_deg", regions[i].outer);
        assert_value(p, option, "p_min", regions[i].least);
        assert_int_equal(option->playback, PROTOCOL_LIVE);
        return;
    }
    fail_msg("no region %s", name);
}

static void check_flight(const struct protocol *p, const struct plan_trial *trial, double start_s)
{
    const struct protocol_settings *settings = trial->resolved;
    const struct protocol_cell *cell = &p->blocks[trial->block].cells[trial->cell];
    assert_int_equal(trial->kind, PROTOCOL_RATE);
    assert_int_equal(settings->view_ns, 8 * (int64_t)SECOND);
    assert_true(settings->path_start_ns == (int64_t)(start_s * SECOND));
    bool free_gaze = says(trial, "\"fixation\":\"free\"");
    assert_int_equal(settings->fixation, free_gaze                                ? PROTOCOL_FIXATION_FREE
                                         : says(trial, "\"fixation\":\"moving\"") ? PROTOCOL_FIXATION_MOVING
                                                                                  : PROTOCOL_FIXATION_CROSS);
    assert_int_equal(settings->foveate, free_gaze ? PROTOCOL_FOVEATE_GAZE : PROTOCOL_FOVEATE_TARGET);
    char region[16] = "";
    assert_int_equal(sscanf(strstr(trial->factors, "\"region\":\"") + 10, "%15[a-z]", region), 1);
    check_region(p, &cell->option[0], region);
    assert_true(trial->prerendered[0] == (strcmp(region, "full") == 0));
    assert_int_equal(settings->asked_count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        const struct protocol_question *question = &p->questions[settings->asked[i]];
        assert_true(question->scale_min == -3 && question->scale_max == 3);
        assert_string_equal(question->label_min, "strongly disagree");
        assert_string_equal(question->label_max, "strongly agree");
    }
}

// Weier 2016, section 4.2.1.
static void test_regions_are_weiers(void **state)
{
    (void)state;
    struct protocol *p = load("regions.yaml");
    assert_int_equal(p->participants, 15);
    static const char *const scenes[] = {"sponza", "tunnel_geom", "tunnel_maps", "rungholt"};
    assert_int_equal(p->scene_count, 4);
    for (uint32_t i = 0; i < 4; i++)
        assert_string_equal(p->scenes[i], scenes[i]);
    struct plan *plan = plan_create(p, p->seed, 5), *other = plan_create(p, p->seed, 6);
    assert_int_equal(plan->trial_count, 6 + 96);
    uint32_t seen[48] = {0}, place[2][48] = {{0}}, target[48] = {0}, breaks = 0, practised = 0;
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        bool practice = i < 6;
        assert_int_equal(trial->role, practice ? PROTOCOL_PRACTICE : PROTOCOL_MAIN);
        check_flight(p, trial, practice ? 20 : 0);
        breaks += trial->break_before;
        if (practice) {
            assert_string_equal(trial->scene, "sponza");
            assert_true(says(trial, "\"region\":\"small\"") || says(trial, "\"region\":\"full\""));
            practised |= 1u << trial->cell;
            continue;
        }
        place[seen[trial->cell]++ % 2][trial->cell] = i;
        target[trial->cell] = trial->target_seed;
        char scene[64];
        snprintf(scene, sizeof scene, "\"scene\":\"%s\"", trial->scene);
        assert_true(says(trial, scene));
        assert_true((strstr(trial->settings, "target_seed") != NULL) ==
                    (trial->resolved->fixation == PROTOCOL_FIXATION_MOVING));
    }
    assert_int_equal(practised, 63); // 2 regions x 3 fixations
    assert_int_equal(breaks, 3);
    for (uint32_t a = 0; a < 48; a++) { // twice each; another path in every trial but the repetition
        assert_int_equal(seen[a], 2);
        assert_int_equal(plan->trials[place[0][a]].target_seed, plan->trials[place[1][a]].target_seed);
        for (uint32_t b = 0; b < a; b++)
            assert_int_not_equal(target[a], target[b]);
    }
    uint32_t same = 0; // order: random, over both repetitions
    for (uint32_t i = 6; i < plan->trial_count; i++)
        same += plan->trials[i].cell == other->trials[i].cell;
    assert_true(same < 12);
    plan_destroy(plan);
    plan_destroy(other);
    protocol_destroy(p);
}

// Stengel 2016, section 6.1.
static void test_acuity_is_stengels(void **state)
{
    (void)state;
    struct protocol *p = load("acuity.yaml");
    assert_int_equal(p->participants, 6);
    assert_int_equal(p->question_count, 0);
    assert_int_equal(p->block_count, 1);
    const struct protocol_block *block = &p->blocks[0];
    assert_int_equal(block->kind, PROTOCOL_ADJUST);
    assert_int_equal(protocol_block_trials(block), 3);
    assert_string_equal(mode_of(p, &block->cells[0].option[0]), "adaptive");
    assert_string_equal(mode_of(p, &block->cells[0].option[1]), "regular");
    assert_value(p, &block->cells[0].option[0], "periphery_min", 0.02);
    static const struct {
        const char *name;
        double found; // the paper's average
    } adjusted[] = {{"acuity_limit", 1.1715}, {"acuity_slope", -2.45}, {"fovea_radius", 0.07}};
    assert_int_equal(block->adjust_count, 3);
    for (uint32_t i = 0; i < 3; i++) {
        const struct protocol_adjust *adjust = &block->adjusts[i];
        assert_string_equal(
            p->catalogue->modes[block->cells[0].option[0].mode].parameters[adjust->parameter].name,
            adjusted[i].name);
        assert_true(adjust->start_min < adjusted[i].found && adjusted[i].found < adjust->start_max);
        assert_true(adjust->min <= adjust->start_min && adjust->start_max <= adjust->max && adjust->step > 0);
    }
    struct plan *plan = plan_create(p, p->seed, 0);
    uint32_t scenes = 0;
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t s = 0; s < p->scene_count; s++)
            scenes |= (strcmp(plan->trials[i].scene, p->scenes[s]) == 0 ? 1u : 0u) << s;
    assert_int_equal(scenes, 7);
    plan_destroy(plan);
    protocol_destroy(p);
}

// The tests of one block of validation.yaml: what differs between the two options, how long, and what else.
struct validation {
    const char *name, *cue; // cue: switched off in the reference; NULL: the reference is regular
    double view_s;
    enum protocol_camera camera;
    enum protocol_fixation fixation;
};

static void check_validation_pair(const struct protocol *p, const struct protocol_cell *cell,
                                  const struct validation *test)
{
    const struct protocol_option *tested = &cell->option[0], *reference = &cell->option[1];
    static const char *const cues[] = {"eye_motion", "silhouettes", "saliency", "highlights",
                                       "brightness", "texture",     NULL};
    assert_string_equal(mode_of(p, tested), "adaptive");
    assert_string_equal(mode_of(p, reference), test->cue ? "adaptive" : "regular");
    for (uint32_t k = 0; k < (test->cue ? 2u : 1u); k++) {
        assert_value(p, &cell->option[k], "acuity_limit", 1.1715);
        assert_value(p, &cell->option[k], "acuity_slope", -2.45);
        assert_value(p, &cell->option[k], "fovea_radius", 0.07);
        assert_value(p, &cell->option[k], "periphery_min", 0.02);
        for (uint32_t c = 0; cues[c]; c++)
            assert_value(p, &cell->option[k], cues[c], !(k == 1 && strcmp(cues[c], test->cue) == 0));
    }
    assert_true(cell->settings.view_ns == (int64_t)(test->view_s * SECOND));
    assert_int_equal(cell->settings.camera, test->camera);
    assert_int_equal(cell->settings.fixation, test->fixation);
    assert_int_equal(cell->settings.foveate, PROTOCOL_FOVEATE_GAZE);
    assert_int_equal(cell->settings.asked_count, 1);
    assert_true(p->questions[cell->settings.asked[0]].equal);
    assert_true((cell->settings.count_question >= 0) == (strcmp(test->name, "T1") == 0));
}

// Stengel 2016, section 6.2.
static void test_validation_is_stengels(void **state)
{
    (void)state;
    static const struct validation tests[6] = {
        {"T1", NULL, 20, PROTOCOL_CAMERA_PATH, PROTOCOL_FIXATION_FREE},
        {"T2", NULL, 8, PROTOCOL_CAMERA_PATH, PROTOCOL_FIXATION_FREE},
        {"T3", NULL, 0, PROTOCOL_CAMERA_PATH, PROTOCOL_FIXATION_FREE},
        {"T4", "brightness", 8, PROTOCOL_CAMERA_STILL, PROTOCOL_FIXATION_FREE},
        {"T5", "eye_motion", 8, PROTOCOL_CAMERA_PATH, PROTOCOL_FIXATION_MOVING},
        {"T6", "texture", 8, PROTOCOL_CAMERA_PATH, PROTOCOL_FIXATION_FREE},
    };
    struct protocol *p = load("validation.yaml");
    assert_int_equal(p->participants, 16);
    assert_int_equal(p->block_count, 6);
    for (uint32_t i = 0; i < 6; i++) {
        const struct protocol_block *block = &p->blocks[i];
        bool once = i == 2;
        assert_string_equal(block->name, tests[i].name);
        assert_int_equal(block->kind, once ? PROTOCOL_TOGGLE : PROTOCOL_SEQUENTIAL);
        assert_int_equal(block->cell_count, 1);
        assert_int_equal(block->repetitions, once ? 1 : 3);
        assert_int_equal(block->extras[0].count, once ? 0 : 1);
        assert_int_equal(block->extras[1].count, 0);
        check_validation_pair(p, &block->cells[0], &tests[i]);
    }
    struct plan *plan = plan_create(p, p->seed, 2);
    assert_int_equal(plan->trial_count, 5 * 4 + 1);
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        assert_string_equal(trial->scene, "sponza");
        assert_true((trial->option[0] == trial->option[1]) == (trial->role == PROTOCOL_NULL));
        for (uint32_t k = 0; k < 2 && trial->block == 0; k++)
            assert_true(trial->spheres[k] >= 4 && trial->spheres[k] <= 9);
        for (uint32_t k = 0; k < i; k++) // T5: pursuit is repeatable
            if (trial->block == 4 && plan->trials[k].block == 4 && plan->trials[k].cell == trial->cell)
                assert_int_equal(trial->target_seed, plan->trials[k].target_seed);
    }
    plan_destroy(plan);
    protocol_destroy(p);
}

// After Turner 2018: both at the same downsampling, aligned on against off. The rest is our design, as the file
// says.
static void test_alignment_is_after_turner(void **state)
{
    (void)state;
    static const double downsample[] = {2, 4, 6, 8};
    struct protocol *p = load("alignment.yaml");
    assert_int_equal(p->block_count, 1);
    const struct protocol_block *block = &p->blocks[0];
    assert_int_equal(block->kind, PROTOCOL_TOGGLE);
    assert_int_equal(block->order, PROTOCOL_ORDER_LATIN);
    assert_int_equal(block->cell_count, 8);
    for (uint32_t i = 0; i < 8; i++) {
        for (uint32_t k = 0; k < 2; k++) {
            assert_string_equal(mode_of(p, &block->cells[i].option[k]), "phase_aligned");
            assert_value(p, &block->cells[i].option[k], "aligned", k == 0);
            assert_value(p, &block->cells[i].option[k], "downsample", downsample[i % 4]);
        }
        assert_int_equal(block->cells[i].settings.camera, PROTOCOL_CAMERA_PATH);
    }
    const struct protocol_cell *check = &block->extras[1].cell;
    assert_value(p, &check->option[0], "downsample", 16);
    assert_value(p, &check->option[1], "downsample", 1);
    assert_int_equal(p->participants % 8, 0); // whole groups of rows
    struct plan *plan = plan_create(p, p->seed, 1);
    uint32_t roles[PROTOCOL_ROLES] = {0};
    for (uint32_t i = 0; i < plan->trial_count; i++)
        roles[plan->trials[i].role]++;
    assert_true(roles[PROTOCOL_MAIN] == 8 && roles[PROTOCOL_NULL] == 2 && roles[PROTOCOL_CATCH] == 2);
    assert_int_equal(plan->trials[0].role, PROTOCOL_MAIN);
    assert_true(says(&plan->trials[0], "\"downsample\":"));
    plan_destroy(plan);
    protocol_destroy(p);
}

// After Swafford 2015: saccades of 200 degrees a second, a fovea of 5 degrees, two scenes. The rest is our
// design.
static void test_latency_is_after_swafford(void **state)
{
    (void)state;
    struct protocol *p = load("latency.yaml");
    assert_int_equal(p->block_count, 2);
    const struct protocol_block *block = &p->blocks[1];
    assert_int_equal(block->kind, PROTOCOL_STAIRCASE);
    assert_int_equal(block->cell_count, 2);
    assert_value(p, &block->cells[0].option[0], "saccade_deg_per_s", 200);
    assert_value(p, &block->cells[0].option[0], "fovea_deg", 2.5);
    assert_string_equal(mode_of(p, &block->cells[0].option[1]), "regular");
    assert_int_equal(p->questions[block->cells[0].settings.asked[0]].correct, PROTOCOL_CORRECT_REFERENCE);
    const struct staircase_desc *desc = &block->staircase.desc;
    assert_string_equal(staircase_method_name(desc->method), "quest_plus");
    assert_int_equal(desc->larger, STAIRCASE_LARGER_HARDER);
    assert_int_equal(desc->model.outcomes, 2);
    assert_string_equal(
        p->catalogue->modes[block->cells[0].option[0].mode].parameters[block->staircase.parameter].name,
        "latency_ms");
    double paper_ms = (9.03 - 2.5) / 200 * 1000; // 1000 px of a 28-inch UHD display at 20 inches
    assert_true(desc->level.min < paper_ms && paper_ms < desc->level.max);
    struct plan *plan = plan_create(p, p->seed, 1);
    assert_int_equal(plan->trial_count, 6 + 2 * 40);
    assert_int_equal(plan->trials[5].role, PROTOCOL_PRACTICE);
    plan_destroy(plan);
    protocol_destroy(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_file_can_be_read),
        cmocka_unit_test(test_missing_modes_are_all_that_is_missing),
        cmocka_unit_test(test_verification_is_table_1),
        cmocka_unit_test(test_regions_are_weiers),
        cmocka_unit_test(test_acuity_is_stengels),
        cmocka_unit_test(test_validation_is_stengels),
        cmocka_unit_test(test_alignment_is_after_turner),
        cmocka_unit_test(test_latency_is_after_swafford),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
