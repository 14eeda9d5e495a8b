// `fovstudy check` on protocols of every kind: what it prints, what it finds wrong, and that its figures are
// those of the session that follows.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char folder[512];

#define HEAD                                                                                                   \
    "fovstudy: 1\nname: kinds\ntitle: All kinds\nseed: 1\nreference: regular\ninstructions: Look.\n"           \
    "consent: {version: 1, text: Agree?}\n"                                                                    \
    "options:\n  foveated: {mode: time_warped}\n  regular: {mode: regular}\n"                                  \
    "questions:\n  prefer: {text: Which?}\n  original: {text: Which?, correct: reference}\n"                   \
    "  better: {text: Which?, equal: yes}\n  quality: {text: How?, scale: [1, 10]}\n"                          \
    "  spheres: {text: How many?, count: [0, 20]}\nsettings: {question: prefer}\n"
#define SCENES "scenes: [atrium, {name: hall, stand_in: \"town:triangles=20000\"}]\n"
#define TOGGLE "- name: main\n  kind: toggle\n  options: [foveated, regular]\n"

static void write_file(const char *name, const char *text)
{
    char path[600];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static const struct command_result *check(const char *text, const char *options)
{
    write_file("p.yaml", text);
    return command("cd '%s' && fovstudy check p.yaml %s", folder, options);
}

static void has(const struct command_result *result, const char *text)
{
    if (!strstr(result->out, text))
        fail_msg("no '%s' in\n%s%s", text, result->out, result->err);
}

static void refused(const char *text, const char *options, const char *sentence)
{
    const struct command_result *result = check(text, options);
    assert_int_equal(result->status, 1);
    assert_int_equal(result->out[0], '\0');
    assert_string_equal(result->err, sentence);
}

static const char every_kind[] = HEAD SCENES
    "blocks:\n"
    "- {name: warm_up, kind: toggle, role: practice, options: [foveated, regular]}\n"
    "- name: toggled\n  kind: toggle\n  options: [foveated, regular]\n  order: latin\n  null: 1\n"
    "  catch: {count: 1, option: foveated, parameters: {foveated: {epsilon: 1}}}\n"
    "  factors: {epsilon: [0.1, 0.2, 0.3, 0.4], lit: {between: yes, levels: {dim: {settings: {ssao: on}}, "
    "bright: "
    "{}}}}\n"
    "  settings: {ratings: quality}\n"
    "- {name: paired, kind: sequential, options: [foveated, regular], settings: {question: better, view_s: 3, "
    "fixation: cross}}\n"
    "- {name: set, kind: adjust, options: [foveated, regular], adjust: {epsilon: {start: [0.1, 0.5], step: "
    "0.01}}}\n"
    "- name: stairs\n  kind: staircase\n  options: [foveated, regular]\n  settings: {question: original}\n"
    "  staircase: {parameter: epsilon, method: 1up2down, larger: easier, level: {min: 0.01, max: 1}, start: "
    "0.5, "
    "steps: [0.1], trials: 3}\n"
    "- {name: counted, kind: task, options: [foveated], settings: {view_s: 9, spheres: [1, 9], count: spheres, "
    "question: quality}}\n"
    "- {name: rated, kind: rate, options: [foveated], settings: {question: quality}, repetitions: 2}\n";

static void every_kind_is_told(void **state)
{
    (void)state;
    const struct command_result *result = check(every_kind, "--counts 16");
    assert_int_equal(result->status, 0);
    has(result, "group ");
    has(result,
        "trial  block   role     kind       scene  question view_s fixation   a   b test first  factors");
    static const char *const cells[] = {"practice toggle",    "null     toggle",     "catch    toggle",
                                        "main     toggle",    "main     sequential", "main     adjust",
                                        "main     staircase", "main     task",       "main     rate"};
    for (size_t i = 0; i < sizeof cells / sizeof cells[0]; i++)
        has(result, cells[i]);
    has(result, "better        3 cross ");
    has(result, "16 participants from number 1");
    has(result, "block   role      trials  test=a  test=b   first  atrium    hall  factors\n");
    has(result, "\ntoggled null          16 ");
    has(result, "\ntoggled catch         16 ");
    has(result, "\npaired  main          16 ");
    has(result, "expected duration: ");
    has(result, "the file plans no analysis");
    for (const char *line = result->out; *line;) {
        size_t length = strcspn(line, "\n");
        if (length > 120)
            fail_msg("%zu columns: %.*s", length, (int)length, line);
        line += length + (line[length] != '\0');
    }
    result =
        command("cd '%s' && fovstudy check p.yaml --counts 16 --json | python3 -c 'import json, sys; print("
                "sorted((r[\"role\"], r[\"trials\"]) for r in json.load(sys.stdin)[\"counts\"] if r[\"block\"] "
                "== \"toggled\" and r[\"role\"] != \"main\"))'",
                folder);
    assert_string_equal(result->err, "");
    assert_string_equal(result->out, "[('catch', 16), ('null', 16)]\n");
    assert_null(strstr(check(HEAD SCENES "blocks:\n" TOGGLE, "--counts 4")->out, "role"));
}

// What modes refuse together has the place of the option, or of the block whose factor comes to it.
static void what_disagrees_has_its_place(void **state)
{
    (void)state;
    refused(
        HEAD SCENES "blocks:\n" TOGGLE "  factors: {fovea_deg: [10, 30]}\n", "",
        "fovstudy: p.yaml:20:3: periphery_deg of mode 'time_warped' is 30; it must be more than fovea_deg, 30; "
        "block 'main' comes to that\n");
    write_file("q.yaml", HEAD SCENES "blocks:\n" TOGGLE);
    const struct command_result *result = command(
        "cd '%s' && sed -i 's/mode: time_warped/&, fovea_deg: 40/' q.yaml && fovstudy check q.yaml", folder);
    assert_int_equal(result->status, 1);
    assert_string_equal(result->err,
                        "fovstudy: q.yaml:9:3: periphery_deg of mode 'time_warped' is 30; it must be more "
                        "than fovea_deg, 40\n");
}

// What the Python expression says of the JSON, `c`.
static void expect_json(const char *file, const char *options, const char *expression)
{
    const struct command_result *result = command(
        "cd '%s' && fovstudy check %s --json %s | python3 -c 'import json, sys; c = json.load(sys.stdin); "
        "print(%s)'",
        folder, file, options, expression);
    if (strcmp(result->out, "True\n") != 0)
        fail_msg("%s: %s%s", expression, result->out, result->err);
}

#define CALIBRATION "'" SOURCE_DIR "/studies/protocols/calibration.yaml'"

static void the_calibration_studys_figures(void **state)
{
    (void)state;
    // R: tests/reference/power.R
    expect_json(CALIBRATION, "--counts 22",
                "[p[\"n\"] for p in c[\"power\"][0][\"parts\"]] == [22] * 9 and "
                "abs(c[\"power\"][0][\"parts\"][0][\"share\"] - 0.81758760751884263) < 1e-12 and "
                "abs(c[\"power\"][0][\"parts\"][0][\"margin\"] - 0.30443738345184468) < 1e-12");
    expect_json(CALIBRATION, "--counts 20",
                "[(p[\"n\"], p[\"n_second\"]) for p in c[\"power\"][2][\"parts\"]] == [(10, 10)] and "
                "[p[\"n\"] for p in c[\"power\"][3][\"parts\"]] == [10, 10] and len(c[\"trials\"]) == 11 and "
                "sum(r[\"trials\"] for r in c[\"counts\"]) == 220 and c[\"remarks\"] == []");
    expect_json(CALIBRATION, "--counts 5", "c[\"power\"][0][\"parts\"][0][\"share\"] is None");
    const struct command_result *result = command("fovstudy check " CALIBRATION);
    has(result, "9 tests, n = 20 each: a preference of 79.9 % or more; equivalence within 50 +- 32.3 %");
    has(result, "20 participants are assumed");
    has(result, "balance: scenes, sides and first-shown options within one");
}

static void repeated_choices_count_people(void **state)
{
    (void)state;
    const struct command_result *result =
        check(HEAD SCENES
              "participants: 24\nanalysis: [{method: binomial, of: choice, per: factor}, {method: anova, of: "
              "choice}, {method: unpaired_t, of: choice, per: factor}]\nblocks:\n" TOGGLE
              "  factors: {epsilon: [0.1, 0.2], fovea_deg: [5, 10]}\n",
              "");
    has(result, "4 tests, n = 24 each");
    has(result, "choices repeat within participants, who differ, so that people are tested; n counts them");
    has(result, "power of this method is not computed here");
    has(result, "2 pairs, n = 24 and 24 each: no test: 24 have both; a paired test is theirs");
}

// R: equivalence of 22 within 0.2 in tests/reference/power_plan.csv; binom.test finds 57 and all more to have
// 80 %.
static void a_margin_out_of_reach_is_said(void **state)
{
    (void)state;
    static const char study[] =
        HEAD SCENES "participants: 22\nanalysis: [{method: binomial, of: choice, per: cell, "
                    "margin: 0.2}]\nblocks:\n" TOGGLE "  factors: {epsilon: [0.1, 0.2]}\n";
    const struct command_result *result = check(study, "");
    has(result, "    2 tests, n = 22 each: a preference of 81.8 % or more; equivalence within 50 +- 30.5 %\n"
                "    2 more of equality within the planned 50 +- 20 %: shown in 16.8 % of studies without a "
                "preference\n");
    has(result,
        "p.yaml: analysis 1 plans equality within 50 +- 20 %, which 22 people show in 16.8 % of studies where "
        "nobody prefers either; 80 % takes 57 in each test, or a wider margin\n");
    expect_json("p.yaml", "",
                "[abs(p[\"planned_margin_power\"] - 0.16818809509277344) < 1e-11 for p in "
                "c[\"power\"][0][\"parts\"]] == [True, True] and "
                "sum(\"plans equality\" in r for r in c[\"remarks\"]) == 1");
    assert_null(strstr(check(study, "--counts 57")->out, "plans equality"));
    assert_non_null(strstr(check(study, "--counts 56")->out, "plans equality"));
}

// Williams' squares of four: over four participants each cell follows each other once; over five it cannot.
static void carry_over_is_counted(void **state)
{
    (void)state;
    const char *design = HEAD SCENES "participants: 5\nblocks:\n" TOGGLE
                                     "  order: latin\n  factors: {epsilon: [0.1, 0.2, 0.3, 0.4]}\n";
    has(check(design, "--counts 4"), "main: 12 pairs, each 1 time; even would be 1: balanced");
    const struct command_result *result = check(design, "");
    has(result, "main: 12 pairs, each 1 to 2 times; even would be 1.25\n");
    has(result,
        "p.yaml:24:3: carry-over in block 'main' is balanced for each 4 participants; 5 are no multiple of it");
    // people of one group never get the other's cells
    has(check(HEAD SCENES
              "blocks:\n" TOGGLE
              "  order: latin\n  factors: {epsilon: [0.1, 0.2], fovea_deg: {between: yes, levels: [5, 10]}}\n",
              "--counts 4"),
        "main: 4 pairs, each 1 time");
}

static void scenes_are_checked(void **state)
{
    (void)state;
#define WITH(scenes) HEAD "scenes: [" scenes "]\nblocks:\n" TOGGLE
    refused(WITH("{name: a, stand_in: atrum}"), "",
            "fovstudy: p.yaml:18:30: stand_in 'atrum' is not known here; did you mean 'atrium'?\n");
    refused(WITH("{name: a, stand_in: cathedral}"), "",
            "fovstudy: p.yaml:18:30: stand_in: scene 'cathedral' is not known; use one of atrium, town, or a "
            ".gltf or "
            ".glb file\n");
    refused(WITH("{name: a, stand_in: \"town:triangles=5\"}"), "",
            "fovstudy: p.yaml:18:30: stand_in: scene 'town': triangles=5 is not a whole number from 20000 to "
            "8000000\n");
    refused(
        WITH("{name: a, stand_in: \"town:trees=5\"}"), "--scene a=atrium",
        "fovstudy: p.yaml:18:30: stand_in: scene 'town' does not know 'trees=5'; write name=value, with one of "
        "triangles, seed, moving\n");
    refused(WITH("atrium"), "--scene atrium=/no/such.glb",
            "fovstudy: --scene atrium: /no/such.glb cannot be opened: No such file or directory\n");
    refused(WITH("atrium"), "--scene atrium=town:seed=x",
            "fovstudy: --scene atrium: scene 'town': seed=x is not a whole number from 0 to 4294967295\n");
    write_file("broken.glb", "no glTF");
    assert_int_equal(check(WITH("atrium"), "--scene atrium=broken.glb")->status, 0); // not read
    const struct command_result *result = check(WITH("atrium"), "--scenes --scene atrium=broken.glb");
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "fovstudy: --scene atrium: "));
}

static void camera_paths_are_long_enough(void **state)
{
    (void)state;
#define VIEW(settings)                                                                                         \
    HEAD "scenes: [atrium]\nblocks:\n- {name: main, kind: rate, options: [foveated], settings: {question: "    \
         "quality, " settings "}}\n"
    const struct command_result *result = check(VIEW("view_s: 3000, path_start_s: 20"), "");
    assert_int_equal(result->status, 0);
    has(result, "p.yaml:20:3: block 'main' flies to 3020 s of scene 'atrium', whose path is one round of ");
    has(check(VIEW("path_start_s: 3000"), ""), "flies to 3000 s");
    assert_null(strstr(check(VIEW("view_s: 8, path_start_s: 2"), "")->out, "flies to"));
    assert_null(strstr(check(VIEW("view_s: 3000, camera: still"), "")->out, "flies to"));
}

static void modes_to_come_get_their_sentence(void **state)
{
    (void)state;
    const struct command_result *list = command("fovstudy modes");
    static const char *const planned[] = {"adaptive", "ray_traced", "ray_traced_full", "phase_aligned",
                                          "latency_inset"};
    for (size_t i = 0; i < sizeof planned / sizeof planned[0]; i++) {
        char line[64], text[4096], sentence[256];
        snprintf(line, sizeof line, "\n%s\n", planned[i]);
        if (strstr(list->out, line))
            continue;
        snprintf(text, sizeof text, "%s", HEAD SCENES "blocks:\n" TOGGLE);
        char *at = strstr(text, "time_warped");
        char rest[4096];
        snprintf(rest, sizeof rest, "%s", at + strlen("time_warped"));
        snprintf(at, sizeof text - (size_t)(at - text), "%s, strange: 1%s", planned[i], rest);
        snprintf(
            sentence, sizeof sentence,
            "fovstudy: p.yaml:9:20: mode '%s' does not exist in this program yet; `fovstudy modes` lists those "
            "that do\n",
            planned[i]);
        refused(text, "", sentence);
        list = command("fovstudy modes");
    }
}

// The session that the simulated observer then sits through takes about as long as was said.
static void the_duration_is_that_of_a_session(void **state)
{
    (void)state;
    write_file("errors.csv", "atrium,0.03,time_warped:epsilon=0.2\natrium,0.02,time_warped:epsilon=0.05\n");
    const struct command_result *result = command(
        "cd '%s' && fovstudy check '%s/studies/protocols/short.yaml' --json | python3 -c 'import json, sys; "
        "print(json.load(sys.stdin)[\"duration_s\"][\"total\"])'",
        folder, SOURCE_DIR);
    double said = atof(result->out), sum = 0;
    assert_true(said > 10);
    for (int i = 1; i <= 12; i++) {
        result = command(
            "cd '%s' && fovstudy run '%s/studies/protocols/short.yaml' --db duration.db --participant p%d "
            "--display none --observer sim:errors=errors.csv --events - | tail -1",
            folder, SOURCE_DIR, i);
        const char *at = strstr(result->out, "\"t_ns\":");
        assert_non_null(at);
        sum += atof(at + strlen("\"t_ns\":")) / 1e9;
    }
    print_message("said %.1f s, twelve sessions took %.1f s on average\n", said, sum / 12);
    assert_true(sum / 12 > 0.85 * said && sum / 12 < 1.15 * said);
}

static int set_up(void **state)
{
    (void)state;
    command_folder("check", folder, sizeof folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_is_told),
        cmocka_unit_test(what_disagrees_has_its_place),
        cmocka_unit_test(the_calibration_studys_figures),
        cmocka_unit_test(repeated_choices_count_people),
        cmocka_unit_test(a_margin_out_of_reach_is_said),
        cmocka_unit_test(carry_over_is_counted),
        cmocka_unit_test(scenes_are_checked),
        cmocka_unit_test(camera_paths_are_long_enough),
        cmocka_unit_test(modes_to_come_get_their_sentence),
        cmocka_unit_test(the_duration_is_that_of_a_session),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
