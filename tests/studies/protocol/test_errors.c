// Every bad protocol gets one sentence with its place. Each case changes one thing in a good file.
#include "studies/protocol/protocol.h"
#include "tests/studies/protocol/sample_catalogue.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char good[] = "fovstudy: 1\n"                                           // 1
                           "name: good\n"                                            // 2
                           "title: A good one\n"                                     // 3
                           "seed: 7\n"                                               // 4
                           "scenes: [atrium, town]\n"                                // 5
                           "options:\n"                                              // 6
                           "  foveated: {mode: time_warped, epsilon: 0.1}\n"         // 7
                           "  regular: {mode: regular}\n"                            // 8
                           "reference: regular\n"                                    // 9
                           "questions:\n"                                            // 10
                           "  prefer: {text: Which?}\n"                              // 11
                           "  quality: {text: How?, scale: [1, 10]}\n"               // 12
                           "instructions: Look.\n"                                   // 13
                           "consent: {version: 1, text: Agree?}\n"                   // 14
                           "settings: {camera: path, question: prefer}\n"            // 15
                           "participant:\n"                                          // 16
                           "  - {name: age, type: integer, min: 18}\n"               // 17
                           "analysis:\n"                                             // 18
                           "  - {method: binomial, of: choice, per: cell}\n"         // 19
                           "blocks:\n"                                               // 20
                           "  - name: before\n"                                      // 21
                           "    kind: rate\n"                                        // 22
                           "    options: [foveated, regular]\n"                      // 23
                           "    settings: {question: quality}\n"                     // 24
                           "  - name: main\n"                                        // 25
                           "    kind: toggle\n"                                      // 26
                           "    options: [foveated, regular]\n"                      // 27
                           "    factors:\n"                                          // 28
                           "      epsilon: [0.2, 0.1]\n"                             // 29
                           "      fovea: {parameter: fovea_deg, levels: [17, 10]}\n" // 30
                           "  - name: after\n"                                       // 31
                           "    kind: rate\n"                                        // 32
                           "    options: [foveated, regular]\n"                      // 33
                           "    complement_of: before\n"                             // 34
                           "    settings: {question: quality}\n";                    // 35

// The good text with the first `from` after `after` replaced.
static char *changed(const char *after, const char *from, const char *to)
{
    const char *start = strstr(good, after);
    assert_non_null(start);
    const char *at = strstr(start, from);
    assert_non_null(at);
    size_t size = sizeof good + strlen(to);
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, "%.*s%s%s", (int)(at - good), good, to, at + strlen(from));
    return text;
}

static void expect(const char *text, size_t size, const char *sentence)
{
    char error[PROTOCOL_ERROR] = "";
    struct protocol *protocol = protocol_parse("p.yaml", text, size, sample_catalogue(), error, sizeof error);
    protocol_destroy(protocol);
    assert_string_equal(error, sentence);
    assert_true((protocol == NULL) == (*sentence != '\0'));
}

// Where to put every bad file as well, for the schema's test; NULL: nowhere.
static const char *folder;

static void keep(const char *text, const char *sentence)
{
    static unsigned count;
    char path[512];
    if (!folder)
        return;
    snprintf(path, sizeof path, "%s/%03u.yaml", folder, count++);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "# %s\n%s", sentence, text);
    assert_int_equal(fclose(file), 0);
}

struct bad {
    const char *after, *from, *to, *sentence;
};

static void expect_all(const struct bad *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char *text = changed(cases[i].after, cases[i].from, cases[i].to);
        expect(text, strlen(text), cases[i].sentence);
        keep(text, cases[i].sentence);
        free(text);
    }
}

static void test_the_good_file_is_good(void **state)
{
    (void)state;
    expect(good, strlen(good), "");
    keep(good, "");
}

// What is rendered beforehand must be known beforehand: for how long, and where it is sharp.
static void test_prerendered(void **state)
{
    (void)state;
    const struct bad cases[] = {
        {"", "{mode: regular}", "{mode: regular, playback: prerendered}",
         "p.yaml:21:5: block 'before' shows the prerendered option 'regular' for a time that is not known "
         "beforehand; "
         "use a sequential, rate or task block with 'view_s', or 'playback: live'"},
        {"settings", "camera: path", "view_s: 3", ""},
        {"", "epsilon: 0.1}", "epsilon: 0.1, playback: prerendered}",
         "p.yaml:21:5: block 'before' shows the prerendered option 'foveated' for a time that is not known "
         "beforehand; "
         "use a sequential, rate or task block with 'view_s', or 'playback: live'"},
    };
    expect_all(cases, sizeof cases / sizeof cases[0]);
    static const char format[] =
        "fovstudy: 1\nname: p\ntitle: P\nseed: 7\nscenes: [town]\noptions:\n"
        "  foveated: {mode: time_warped, playback: prerendered}\n  regular: {mode: regular}\n"
        "reference: regular\nquestions: {prefer: {text: Which?}}\ninstructions: Look.\n"
        "consent: {version: 1, text: Agree?}\nsettings: {view_s: 3, question: prefer%s}\n"
        "blocks: [{name: one, kind: %s, options: [foveated, regular]}]\n";
    static const struct {
        const char *settings, *kind, *sentence;
    } files[] = {
        {"", "sequential",
         "p.yaml:14:10: block 'one' shows the prerendered option 'foveated', whose mode 'time_warped' follows "
         "the gaze, "
         "which is not known beforehand; set 'foveate: target', or 'playback: live'"},
        {", fixation: moving, foveate: target", "sequential", ""},
        {", fixation: cross, foveate: target", "sequential", ""},
        {", fixation: cross, foveate: target", "toggle",
         "p.yaml:14:10: block 'one' shows the prerendered option 'foveated' for a time that is not known "
         "beforehand; "
         "use a sequential, rate or task block with 'view_s', or 'playback: live'"},
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char text[2048];
        int size = snprintf(text, sizeof text, format, files[i].settings, files[i].kind);
        expect(text, (size_t)size, files[i].sentence);
    }
}

static void test_names(void **state)
{
    (void)state;
    const struct bad cases[] = {
        {"", "title:", "titel:",
         "p.yaml:3:1: in the protocol, key 'titel' is not known here; did you mean 'title'?"},
        {"", "seed:", "x:",
         "p.yaml:4:1: in the protocol, key 'x' is not known here; known: fovstudy, name, title, seed, "
         "participants, sessions, scenes, options, reference, settings, questions, instructions, consent, "
         "participant, exclude, analysis, blocks"},
        {"", "time_warped", "time_wrapped",
         "p.yaml:7:20: mode 'time_wrapped' is not known here; did you mean 'time_warped'?"},
        {"", "epsilon: 0.1", "epsilno: 0.1",
         "p.yaml:7:33: parameter of time_warped 'epsilno' is not known here; did you mean 'epsilon'?"},
        {"", "{mode: regular}", "{mode: regular, epsilon: 1}",
         "p.yaml:8:28: parameter of regular 'epsilon' is not known here; there is none"},
        {"", "[atrium, town]", "[atrium, twon]",
         "p.yaml:5:18: scene 'twon' is not known here; did you mean 'town'?"},
        {"", "reference: regular", "reference: normal",
         "p.yaml:9:12: option 'normal' is not known here; known: foveated, regular"},
        {"settings", "camera: path", "camera: stil",
         "p.yaml:15:20: camera 'stil' is not known here; did you mean 'still'?"},
        {"settings", "camera: path", "moving_object: off",
         "p.yaml:15:12: in settings, key 'moving_object' is not known here; did you mean 'moving_objects'?"},
        {"settings", "camera: path", "moving_objects: maybe",
         "p.yaml:15:28: settings.moving_objects 'maybe' is not known here; known: off, on"},
        {"main", "[foveated, regular]", "[foveatd, regular]",
         "p.yaml:27:15: option 'foveatd' is not known here; did you mean 'foveated'?"},
        {"before", "kind: rate", "kind: rat",
         "p.yaml:22:11: kind 'rat' is not known here; did you mean 'rate'?"},
        {"main", "kind: toggle", "kind: staircase",
         "p.yaml:25:5: the staircase block has no 'staircase'; add it"},
        {"", "mode: time_warped", "mode: ray_traced",
         "p.yaml:7:20: mode 'ray_traced' does not exist in this program yet; `fovstudy modes` lists those that "
         "do"},
        {"", "fovea_deg", "fovea_dg",
         "p.yaml:30:26: parameter of time_warped 'fovea_dg' is not known here; did you mean 'fovea_deg'?"},
        {"", "epsilon: [", "epsilom: [",
         "p.yaml:29:7: parameter of time_warped 'epsilom' is not known here; did you mean 'epsilon'?"},
        {"", "complement_of: before", "complement_of: befor",
         "p.yaml:34:20: complement_of 'befor' is not known here; did you mean 'before'?"},
        {"after", "question: quality", "question: qualify",
         "p.yaml:35:26: question 'qualify' is not known here; did you mean 'quality'?"},
        {"", "method: binomial", "method: binomal",
         "p.yaml:19:14: method 'binomal' is not known here; did you mean 'binomial'?"},
        {"", "type: integer", "type: int",
         "p.yaml:17:23: type 'int' is not known here; known: integer, number, text, choice"},
        {"", "levels:", "level:",
         "p.yaml:30:37: in the factor, key 'level' is not known here; did you mean 'levels'?"},
    };
    expect_all(cases, sizeof cases / sizeof cases[0]);
}

static void test_values(void **state)
{
    (void)state;
    const struct bad cases[] = {
        {"", "epsilon: 0.1", "epsilon: 1.5",
         "p.yaml:7:42: time_warped.epsilon is 1.5; it must lie between 0 and 1"},
        {"", "epsilon: 0.1", "epsilon: much", "p.yaml:7:42: time_warped.epsilon is a number, not 'much'"},
        {"", "epsilon: 0.1", "epsilon: nan", "p.yaml:7:42: time_warped.epsilon is a number, not 'nan'"},
        {"", "epsilon: 0.1", "epsilon: 1e999", "p.yaml:7:42: time_warped.epsilon is a number, not '1e999'"},
        {"", "epsilon: 0.1", "epsilon: 0x1p-1", "p.yaml:7:42: time_warped.epsilon is a number, not '0x1p-1'"},
        {"", "epsilon: 0.1", "epsilon: \"0.1\"", "p.yaml:7:42: time_warped.epsilon is a number, not '0.1'"},
        {"", "epsilon: 0.1", "epsilon: [0.1]", "p.yaml:7:42: time_warped.epsilon is a number, not a list"},
        {"", "epsilon: 0.1", "splat: 3",
         "p.yaml:7:40: time_warped.splat '3' is not known here; known: atomic, points"},
        {"", "seed: 7", "seed: -1", "p.yaml:4:7: seed is -1; it must lie between 0 and 9223372036854775807"},
        {"", "seed: 7", "seed: 99999999999999999999",
         "p.yaml:4:7: seed is 99999999999999999999; it must lie between 0 and 9223372036854775807"},
        {"", "seed: 7", "seed: 7.5", "p.yaml:4:7: seed is a whole number, not '7.5'"},
        {"", "seed: 7", "seed:", "p.yaml:4:1: seed has no value; give a whole number"},
        {"", "fovstudy: 1", "fovstudy: 2",
         "p.yaml:1:11: fovstudy (the version of the protocol language) is 2; it must be 1"},
        {"", "name: good", "name: a b", "p.yaml:2:7: name 'a b' is not a name; use letters, digits, _ and -"},
        {"", "scale: [1, 10]", "scale: [10, 1]",
         "p.yaml:12:32: scale ends at 1, below its begin 10; swap them"},
        {"", "per: cell}", "per: cell, margin: 0.6}",
         "p.yaml:19:55: margin is 0.6; it must lie between 0 and 0.5"},
        {"", "per: cell}", "per: cell, margin: 0}",
         "p.yaml:19:55: 'margin' is 0 but must lie between 0 and 0.5, and be neither"},
        {"", "per: cell}", "per: cell, margin: 0.5}",
         "p.yaml:19:55: 'margin' is 0.5 but must lie between 0 and 0.5, and be neither"},
        {"", "method: binomial, of: choice", "method: mean, of: choice, margin: 0.1",
         "p.yaml:19:32: 'margin' is for a binomial test of choices, not for mean of choice"},
        {"", "scale: [1, 10]", "scale: 10",
         "p.yaml:12:32: scale is a list; write [..., ...] or one '- ' line each"},
        {"", "[0.2, 0.1]", "[0.2, 2]", "p.yaml:29:22: time_warped.epsilon is 2; it must lie between 0 and 1"},
        {"", "[0.2, 0.1]", "[0.2, 0.20]", "p.yaml:29:22: level 0.20 of 'epsilon' stands here twice; keep one"},
        {"", "[0.2, 0.1]", "[]", "p.yaml:29:16: factor 'epsilon': 0 entries where 1 to 16 are needed"},
        {"", "[atrium, town]", "[atrium, atrium]", "p.yaml:5:18: scene 'atrium' stands here twice; keep one"},
        {"settings", "camera: path", "fade: {gray_s: 11}",
         "p.yaml:15:27: gray_s is 11; it must lie between 0 and 10"},
    };
    expect_all(cases, sizeof cases / sizeof cases[0]);
}

static void test_structure(void **state)
{
    (void)state;
    const struct bad cases[] = {
        {"", "title: A good one\n", "", "p.yaml:1:1: the protocol has no 'title'; add it"},
        {"", "seed: 7", "seed: 7\nseed: 8", "p.yaml:5:1: 'seed' stands here twice; keep one"},
        {"", "  regular: {mode: regular}\n", "  regular: {epsilon: 1}\n",
         "p.yaml:8:12: the option has no 'mode'; add it"},
        {"", "options:\n", "options: 3\nx:\n",
         "p.yaml:7:1: in the protocol, key 'x' is not known here; known: fovstudy, name, title, seed, "
         "participants, sessions, scenes, options, reference, settings, questions, instructions, consent, "
         "participant, exclude, analysis, blocks"},
        {"", "consent: {version: 1, text: Agree?}", "consent: yes",
         "p.yaml:14:10: consent is a mapping; write 'key: value' below it"},
        {"main", "[foveated, regular]", "[foveated]",
         "p.yaml:27:14: options of a toggle block: 1 entry where 2 are needed"},
        {"main", "[foveated, regular]", "[regular, regular]",
         "p.yaml:27:24: option 'regular' stands here twice; keep one"},
        {"", "name: main", "name: before", "p.yaml:25:11: block 'before' stands here twice; rename one"},
        {"", "question: prefer}", "camera2: x}",
         "p.yaml:15:26: in settings, key 'camera2' is not known here; did you mean 'camera'?"},
        {"", "camera: path, question: prefer", "camera: path",
         "p.yaml:25:5: block 'main' asks no question; set 'question' in its settings"},
        {"before", "question: quality", "question: prefer",
         "p.yaml:21:5: block 'before' rates, but question 'prefer' has no 'scale'; add one, or ask another"},
        {"", "question: prefer", "question: quality",
         "p.yaml:25:5: block 'main' lets one choose, but question 'quality' has a scale; ask another"},
        {"after", "[foveated, regular]", "[regular, foveated]",
         "p.yaml:34:20: block 'before' and its complement need the same two options in the same order"},
        {"after", "complement_of: before", "complement_of: main",
         "p.yaml:34:20: a complement is a rate block that rates the other option of an earlier one; block "
         "'main' is "
         "none"},
        {"after", "complement_of: before", "repetitions: 2",
         "p.yaml:34:5: a rate block of two options is one rating of the option drawn; for repetitions name one "
         "option"},
        {"main", "    factors:\n", "    trials: [{}]\n    factors:\n",
         "p.yaml:28:5: a block has either factors or trials; remove one"},
        {"main", "    factors:\n", "    repetitions: 200\n    factors:\n",
         "p.yaml:25:5: block 'main' has 800 trials; at most 512 fit"},
        {"", "fovea: {parameter: fovea_deg,", "fovea: {parameter: epsilon,",
         "p.yaml:30:7: factor 'fovea' varies the same as 'epsilon'; keep one"},
        {"", "fovea: {parameter: fovea_deg, levels: [17, 10]", "fovea: {parameter: epsilon, levels: [1]",
         "p.yaml:30:7: factor 'fovea' varies the same as 'epsilon'; keep one"},
        {"", "type: integer, min: 18", "type: choice", "p.yaml:17:5: the attribute has no 'choices'; add them"},
        {"", "type: integer", "type: text", "p.yaml:17:29: min and max are for numbers; remove them"},
    };
    expect_all(cases, sizeof cases / sizeof cases[0]);
}

// Of a staircase: what is missing or too much is said by name, never by a value that nobody wrote.
static void test_staircases(void **state)
{
    (void)state;
#define STAIRS(keys)                                                                                           \
    "kind: staircase\n    staircase: {parameter: hole_decay, larger: easier, trials: 10, " keys "}\n"          \
    "    settings: {question: quality}"
#define UP_DOWN "level: {min: 0.1, max: 1}, "
#define QUEST "method: quest_plus, level: {min: 0.1, max: 1, count: 5}, "
    const struct bad cases[] = {
        {"main", "kind: toggle", STAIRS("method: weighted, " UP_DOWN "start: 0.5, steps: [0.1]"),
         "p.yaml:27:16: method 'weighted' has no 'target'; add the share of right answers to settle at, as "
         "'target: "
         "0.75'"},
        {"main", "kind: toggle", STAIRS("method: 1up2down, " UP_DOWN "steps: [0.1]"),
         "p.yaml:27:16: method '1up2down' has no 'start'; add the first level, as 'start: 0.5'"},
        {"main", "kind: toggle", STAIRS("method: 1up2down, " UP_DOWN "start: 0.5"),
         "p.yaml:27:16: method '1up2down' has no 'steps'; add the sizes of its steps, as 'steps: [0.1, 0.05]'"},
        {"main", "kind: toggle", STAIRS("method: 1up2down, target: 0.7, " UP_DOWN "start: 0.5, steps: [0.1]"),
         "p.yaml:27:86: method '1up2down' takes no 'target', it settles at 70.7 % right answers; remove it"},
        {"main", "kind: toggle",
         STAIRS("method: 1up2down, level: {count: 3, min: 0, max: 1}, start: 0.5, steps: [0.1]"),
         "p.yaml:27:94: method '1up2down' steps from level to level, so it takes no 'count'; remove it"},
        {"main", "kind: toggle", STAIRS(QUEST),
         "p.yaml:27:16: method 'quest_plus' has no 'model'; add the psychometric functions it weighs, with "
         "family, "
         "threshold and slope"},
        {"main", "kind: toggle", STAIRS("start: 0.5, " QUEST "model: {}"),
         "p.yaml:27:68: method 'quest_plus' takes no 'start'; remove it"},
        {"main", "kind: toggle",
         STAIRS(QUEST
                "model: {family: logistic, threshold: {min: 5, max: 9, count: 3}, slope: {min: 1, max: 2}}"),
         "p.yaml:27:162: the thresholds (5 to 9) all lie outside the levels (0.1 to 1), so no answer tells "
         "them apart"},
        {"main", "kind: toggle", STAIRS("method: quest_plus, model: {}, level: {min: 0.1, max: 1}"),
         "p.yaml:27:106: method 'quest_plus' chooses among levels; add how many, as 'count: 25'"},
        {"main", "kind: toggle", "kind: adjust\n    null: 2",
         "p.yaml:25:5: the adjust block has no 'adjust'; add it"},
        {"main", "kind: toggle", "kind: staircase\n    null: 2",
         "p.yaml:25:5: the staircase block has no 'staircase'; add it"},
        {"main", "kind: toggle",
         "kind: adjust\n    null: 2\n    adjust: {hole_decay: {start: [0.1, 0.5], step: 0.1}}",
         "p.yaml:27:5: blocks of kind adjust have no null and catch trials; use them in toggle and sequential "
         "blocks"},
    };
    expect_all(cases, sizeof cases / sizeof cases[0]);
}

// One value is judged by another that stands in the file, and both are named.
static void test_ends(void **state)
{
    (void)state;
#define ADJUST(keys) "kind: adjust\n    adjust: {hole_decay: {" keys "}}"
    const struct bad cases[] = {
        {"main", "kind: toggle", ADJUST("start: [0.5, 0.2], step: 0.1"),
         "p.yaml:27:34: start ends at 0.2, below its begin 0.5; swap them"},
        {"main", "kind: toggle", ADJUST("start: [0.5, 0.5], step: 0.1, min: 0.6, max: 0.4"),
         "p.yaml:27:72: max is 0.4, and min 0.6; it must be above min"},
        {"main", "kind: toggle", ADJUST("start: [0.5, 0.5], step: 5"),
         "p.yaml:27:52: step is 5; from min to max it is only 1"},
        {"", "min: 18", "min: 18, max: 9", "p.yaml:17:46: max is 9, below min 18; swap them"},
        {"main", "    factors:\n", "    catch: {count: 1, option: regular}\n    factors:\n",
         "p.yaml:28:12: block 'main' has a catch trial whose two options are the same; name an option, or "
         "parameters of "
         "it, that differ obviously"},
        {"main", "    factors:\n", "    trials:\n    factors:\n",
         "p.yaml:28:5: a block has either factors or trials; remove one"},
        {"", "scenes: [atrium, town]",
         "scenes:", "p.yaml:5:1: scenes has no value; write [..., ...] or one '- ' line each"},
        {"", "{version: 1, text: Agree?}", "",
         "p.yaml:14:1: consent has no value; write 'key: value' below it"},
    };
    expect_all(cases, sizeof cases / sizeof cases[0]);
}

static void test_yaml(void **state)
{
    (void)state;
    const struct bad cases[] = {
        {"", "[atrium, town]", "[atrium, town", "p.yaml:7:11: this is not YAML: missing comma"},
        {"", "seed: 7", "\tseed: 7", "p.yaml:3:8: this is not YAML: "},
        {"", "[atrium, town]", "&a [atrium, town]",
         "p.yaml:5:12: anchors (&) and aliases (*) are not used in protocols; write the value out"},
        {"", "[atrium, town]", "*a",
         "p.yaml:5:9: anchors (&) and aliases (*) are not used in protocols; write the value out"},
        {"", "seed: 7", "seed: !!int 7", "p.yaml:4:13: tags (!) are not used in protocols; remove it"},
        {"", "seed: 7\n", "seed: 7\n---\n",
         "p.yaml:5:1: a second document begins here; a protocol is one document"},
        {"", "seed: 7", "? [a]\n: 7", "p.yaml:4:3: a name is needed here, not a list or a mapping"},
        {"", "A good one", "\"a\\0b\"", "p.yaml:3:8: a text may not hold the character NUL"},
    };
    for (size_t i = 0; i < 2; i++) { // the parser's own words follow
        char *text = changed(cases[i].after, cases[i].from, cases[i].to), error[PROTOCOL_ERROR] = "";
        assert_null(protocol_parse("p.yaml", text, strlen(text), sample_catalogue(), error, sizeof error));
        free(text);
        if (strncmp(error, cases[i].sentence, strlen(cases[i].sentence)) != 0)
            assert_string_equal(error, cases[i].sentence);
    }
    expect_all(cases + 2, sizeof cases / sizeof cases[0] - 2);
}

static void test_empty_and_not_text(void **state)
{
    (void)state;
    expect("", 0, "p.yaml:1:1: the file is empty; a protocol begins with 'fovstudy: 1'");
    expect("# only\n", 7, "p.yaml:1:1: the file is empty; a protocol begins with 'fovstudy: 1'");
    expect("hello", 5, "p.yaml:1:1: the protocol is a mapping; write 'key: value' below it");
    expect("a: b\nn\xc3\xa9: \xff", 11, "p.yaml:2:5: byte 0xff is not UTF-8 text; save the file as UTF-8");
    expect("a: \xed\xa0\x80", 6, "p.yaml:1:4: byte 0xed is not UTF-8 text; save the file as UTF-8");
    expect("a: \xc0\xaf", 5, "p.yaml:1:4: byte 0xc0 is not UTF-8 text; save the file as UTF-8");
    expect("a: \xe2\x82", 5, "p.yaml:1:4: byte 0xe2 is not UTF-8 text; save the file as UTF-8");
    expect("a\0b", 3, "p.yaml:1:2: byte 0x00 is not UTF-8 text; save the file as UTF-8");
}

static void test_limits(void **state)
{
    (void)state;
    size_t size = PROTOCOL_BYTES + 1;
    char *text = malloc(size);
    assert_non_null(text);
    memset(text, 'a', size);
    expect(text, size, "p.yaml:1:1: the file is larger than 1048576 bytes; a protocol is never that long");
    memset(text, '[', size);
    expect(text, size - 1, "p.yaml:1:17: nested deeper than 16 levels; no protocol needs that");
    memset(text, ',', size);
    for (size_t i = 0; i + 1 < size; i += 2)
        text[i] = 'x';
    text[0] = '[';
    text[1] = 'x';
    char error[PROTOCOL_ERROR] = "";
    assert_null(protocol_parse("p.yaml", text, size - 1, sample_catalogue(), error, sizeof error));
    assert_non_null(strstr(error, "more than 20000 values"));
    free(text);
}

// Whatever is cut off or overwritten, there is a protocol or a sentence.
static void test_damaged_files_never_crash(void **state)
{
    (void)state;
    char error[PROTOCOL_ERROR];
    char copy[sizeof good];
    uint32_t random = 1;
    for (size_t size = 0; size < sizeof good; size++) {
        error[0] = '\0';
        struct protocol *protocol = protocol_parse("p", good, size, sample_catalogue(), error, sizeof error);
        assert_true((protocol != NULL) != (error[0] != '\0'));
        protocol_destroy(protocol);
    }
    for (int i = 0; i < 3000; i++) {
        memcpy(copy, good, sizeof good);
        for (int k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u; // Numerical Recipes' generator, enough to pick a byte
            copy[(random >> 8) % (sizeof good - 1)] = "[]{}:,-\"'#&*! \n\t|>0a\xff\x80"[(random >> 24) % 22];
        }
        error[0] = '\0';
        struct protocol *protocol =
            protocol_parse("p", copy, sizeof good - 1, sample_catalogue(), error, sizeof error);
        assert_true((protocol != NULL) != (error[0] != '\0'));
        protocol_destroy(protocol);
    }
}

static void test_files(void **state)
{
    (void)state;
    char error[PROTOCOL_ERROR] = "";
    assert_null(protocol_load("/nowhere/x.yaml", sample_catalogue(), error, sizeof error));
    assert_string_equal(error, "/nowhere/x.yaml: cannot be opened: No such file or directory; "
                               "give the path of a protocol file");
    assert_null(protocol_load(SOURCE_DIR, sample_catalogue(), error, sizeof error));
    assert_non_null(strstr(error, "cannot be read: Is a directory"));
    assert_null(protocol_load("/dev/zero", sample_catalogue(), error, sizeof error));
    assert_non_null(strstr(error, "larger than 1048576 bytes"));
}

int main(int argc, char **argv)
{
    folder = argc == 3 && strcmp(argv[1], "--keep") == 0 ? argv[2] : NULL;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_good_file_is_good),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_prerendered),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_structure),
        cmocka_unit_test(test_staircases),
        cmocka_unit_test(test_ends),
        cmocka_unit_test(test_yaml),
        cmocka_unit_test(test_empty_and_not_text),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_damaged_files_never_crash),
        cmocka_unit_test(test_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
