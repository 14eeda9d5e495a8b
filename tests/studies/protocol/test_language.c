// Every example of the language's tables is read where it stands: a protocol is built around each.
#include "studies/protocol/language.h"
#include "studies/protocol/protocol.h"
#include "studies/protocol/schema.h"
#include "tests/studies/protocol/sample_catalogue.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// A whole protocol by its keys, in the order of the language.
static const struct {
    const char *key, *text;
} base[] = {
    {"fovstudy", "fovstudy: 1"},
    {"name", "name: host"},
    {"title", "title: A host"},
    {"seed", "seed: 1"},
    {"scenes", "scenes: [atrium, town]"},
    {"options",
     "options: {foveated: {mode: time_warped}, regular: {mode: regular}, mixed: {mode: time_warped, "
     "epsilon: 0.3}, blurred: {mode: time_warped, epsilon: 1}, small: {mode: regular}, medium: {mode: "
     "time_warped, epsilon: 0.5}, large: {mode: time_warped, epsilon: 0.6}}"},
    {"reference", "reference: regular"},
    {"questions",
     "questions: {prefer: {text: Which?}, original: {text: Which?, correct: reference}, quality: {text: "
     "How?, scale: [1, 10]}, artefacts: {text: Any?, scale: [1, 7]}, sure: {text: Sure?, scale: [1, 7]}, "
     "spheres_seen: {text: How many?, count: [0, 20]}}"},
    {"instructions", "instructions: Look."},
    {"consent", "consent: {version: 1, text: Agree?}"},
    {"settings", "settings: {question: prefer}"},
    {"blocks", "blocks: [{name: main, kind: toggle, options: [foveated, regular]}]"},
};

#define BLOCK "blocks:\n  - name: main\n    kind: toggle\n    options: [foveated, regular]\n"
#define RATE "blocks:\n  - name: before\n    kind: rate\n"
#define PAIR "    options: [foveated, regular]\n"
#define STAIRS                                                                                                 \
    "blocks:\n  - name: main\n    kind: staircase\n" PAIR "    settings: {question: original}\n    "           \
    "staircase:\n"
#define UP_DOWN "      method: 1up2down\n"
#define GRID "      level: {min: 0.01, max: 1}\n"
#define STEPS "      start: 0.5\n      steps: [0.1]\n"
#define QUEST_LEVEL "      level: {min: 0.01, max: 1, count: 5}\n"
#define QUEST                                                                                                  \
    "      model: {family: logistic, threshold: {min: 0.1, max: 1, count: 5}, slope: {min: 1, max: 10, "       \
    "count: 4}}\n"
#define SIDE "      parameter: epsilon\n      larger: easier\n      trials: 40\n"
#define LARGER "      larger: easier\n"
#define TRIALS "      trials: 40\n"
#define PARAMETER "      parameter: epsilon\n"
#define MODEL STAIRS SIDE QUEST_LEVEL "      method: quest_plus\n      model:\n"
#define FAMILY "        family: logistic\n"
#define THRESHOLD "        threshold: {min: 0.1, max: 1, count: 5}\n"
#define SLOPE "        slope: {min: 1, max: 10, count: 4}\n"

// Where an example of a section stands: the top-level key that is replaced and what by, with one %s. The first
// row that names the key, or else the section's row without a key.
static const struct host {
    const struct language_section *section;
    const char *key, *top, *text;
} hosts[] = {
    {&language_scene, "name", "scenes", "scenes:\n  - %s\n    stand_in: atrium"},
    {&language_scene, "stand_in", "scenes", "scenes:\n  - name: hall\n    %s"},
    {&language_scene, "labels", "scenes", "scenes:\n  - name: atrium\n    %s"},
    {&language_option, "mode", "options", "options:\n  regular: {mode: regular}\n  foveated:\n    %s"},
    {&language_option, "playback", "options",
     "options:\n  regular: {mode: regular}\n  foveated: {mode: time_warped}\n  slow:\n    mode: regular\n    "
     "%s"},
    {&language_option, NULL, "options",
     "options:\n  regular: {mode: regular}\n  foveated:\n    mode: time_warped\n    %s"},
    {&language_settings, "foveate", "settings", "settings:\n  question: prefer\n  fixation: cross\n  %s"},
    {&language_settings, "question", "blocks", RATE "    options: [foveated]\n    settings:\n      %s"},
    {&language_settings, "spheres", "settings", "settings:\n  question: prefer\n  count: spheres_seen\n  %s"},
    {&language_settings, "count", "settings", "settings:\n  question: prefer\n  spheres: [1, 2]\n  %s"},
    {&language_settings, NULL, "settings", "settings:\n  question: prefer\n  %s"},
    {&language_fade, NULL, "settings", "settings:\n  question: prefer\n  fade:\n    %s"},
    {&language_question, "text", "questions", "questions:\n  prefer:\n    %s"},
    {&language_question, "labels", "questions",
     "questions:\n  prefer: {text: Which?}\n  good:\n    text: How?\n    scale: [1, 10]\n    %s"},
    {&language_question, NULL, "questions",
     "questions:\n  prefer: {text: Which?}\n  q:\n    text: How?\n    %s"},
    {&language_consent, "version", "consent", "consent:\n  text: Agree?\n  %s"},
    {&language_consent, "text", "consent", "consent:\n  version: 1\n  %s"},
    {&language_attribute, "name", "participant", "participant:\n  - type: integer\n    %s"},
    {&language_attribute, "type", "participant", "participant:\n  - name: age\n    %s"},
    {&language_attribute, "choices", "participant", "participant:\n  - name: vr\n    type: choice\n    %s"},
    {&language_attribute, NULL, "participant", "participant:\n  - name: age\n    type: integer\n    %s"},
    {&language_exclusion, "rule", "exclude", "exclude:\n  - %s"},
    {&language_exclusion, "below", "exclude", "exclude:\n  - rule: reaction\n    %s"},
    {&language_exclusion, "share", "exclude", "exclude:\n  - rule: gaze_loss\n    of: person\n    %s"},
    {&language_exclusion, NULL, "exclude", "exclude:\n  - rule: gaze_loss\n    %s"},
    {&language_analysis, "method", "analysis", "analysis:\n  - of: choice\n    %s"},
    {&language_analysis, "of", "analysis", "analysis:\n  - method: binomial\n    %s"},
    {&language_analysis, NULL, "analysis", "analysis:\n  - method: binomial\n    of: choice\n    %s"},
    {&language_block, "name", "blocks", "blocks:\n  - %s\n    kind: toggle\n" PAIR},
    {&language_block, "kind", "blocks", "blocks:\n  - name: main\n    %s\n" PAIR},
    {&language_block, "options", "blocks", "blocks:\n  - name: main\n    kind: toggle\n    %s"},
    {&language_block, "complement_of", "blocks",
     "blocks:\n  - {name: rating_before, kind: rate, options: [foveated, regular], settings: {question: "
     "quality}}\n"
     "  - name: after\n    kind: rate\n    settings: {question: quality}\n" PAIR "    %s"},
    {&language_block, "settings", "blocks", RATE "    options: [foveated]\n    %s"},
    {&language_block, "adjust", "blocks", "blocks:\n  - name: main\n    kind: adjust\n" PAIR "    %s"},
    {&language_block, "staircase", "blocks",
     "blocks:\n  - name: main\n    kind: staircase\n    settings: {question: original}\n" PAIR "    %s"},
    {&language_block, NULL, "blocks", BLOCK "    %s"},
    {&language_factor, "options", "blocks", BLOCK "    factors:\n      f:\n        %s"},
    {&language_factor, "scenes", "blocks", BLOCK "    factors:\n      f:\n        %s"},
    {&language_factor, "setting", "blocks",
     BLOCK "    factors:\n      f:\n        levels: [off, on]\n        %s"},
    {&language_factor, "levels", "blocks", BLOCK "    factors:\n      f:\n        %s"},
    {&language_factor, NULL, "blocks",
     BLOCK "    factors:\n      epsilon:\n        levels: [0.3, 0.4]\n        %s"},
    {&language_level, NULL, "blocks", BLOCK "    trials:\n      - %s"},
    {&language_catch, "count", "blocks", BLOCK "    catch:\n      option: blurred\n      %s"},
    {&language_catch, "option", "blocks", BLOCK "    catch:\n      count: 1\n      %s"},
    {&language_catch, NULL, "blocks", BLOCK "    catch:\n      count: 1\n      option: blurred\n      %s"},
    {&language_adjust, "start", "blocks",
     "blocks:\n  - name: main\n    kind: adjust\n" PAIR
     "    adjust:\n      epsilon:\n        step: 0.01\n        %s"},
    {&language_adjust, "step", "blocks",
     "blocks:\n  - name: main\n    kind: adjust\n" PAIR
     "    adjust:\n      epsilon:\n        start: [0, 1]\n        %s"},
    {&language_adjust, NULL, "blocks",
     "blocks:\n  - name: main\n    kind: adjust\n" PAIR
     "    adjust:\n      epsilon:\n        start: [0, 1]\n        step: 0.1\n        %s"},
    {&language_staircase, "parameter", "blocks", STAIRS UP_DOWN GRID STEPS LARGER TRIALS "      %s"},
    {&language_staircase, "larger", "blocks", STAIRS UP_DOWN GRID STEPS PARAMETER TRIALS "      %s"},
    {&language_staircase, "trials", "blocks", STAIRS UP_DOWN GRID STEPS PARAMETER LARGER "      %s"},
    {&language_staircase, "start", "blocks", STAIRS UP_DOWN GRID SIDE "      steps: [0.1]\n      %s"},
    {&language_staircase, "steps", "blocks", STAIRS UP_DOWN GRID SIDE "      start: 0.5\n      %s"},
    {&language_staircase, "target", "blocks", STAIRS "      method: weighted\n" GRID SIDE STEPS "      %s"},
    {&language_staircase, "level", "blocks", STAIRS "      method: quest_plus\n" SIDE QUEST "      %s"},
    {&language_staircase, "method", "blocks", STAIRS SIDE QUEST_LEVEL QUEST "      %s"},
    {&language_staircase, "model", "blocks", STAIRS "      method: quest_plus\n" SIDE QUEST_LEVEL "      %s"},
    {&language_staircase, NULL, "blocks", STAIRS UP_DOWN GRID SIDE STEPS "      %s"},
    {&language_model, "family", "blocks", MODEL THRESHOLD SLOPE "        %s"},
    {&language_model, "threshold", "blocks", MODEL FAMILY SLOPE "        %s"},
    {&language_model, "slope", "blocks", MODEL FAMILY THRESHOLD "        %s"},
    {&language_model, NULL, "blocks", MODEL FAMILY THRESHOLD SLOPE "        %s"},
    {&language_grid, "min", "blocks",
     MODEL FAMILY SLOPE "        threshold:\n          count: 5\n          max: 1\n          %s"},
    {&language_grid, "max", "blocks",
     MODEL FAMILY SLOPE "        threshold:\n          count: 5\n          min: 0.1\n          %s"},
    {&language_grid, "count", "blocks",
     MODEL FAMILY SLOPE "        threshold:\n          min: 0.1\n          max: 1\n          %s"},
    {&language_grid, NULL, "blocks",
     MODEL FAMILY SLOPE
     "        threshold:\n          min: 0.1\n          max: 1\n          count: 5\n          %s"},
};

// The sample with the settings of the real one.
static const struct catalogue *catalogue(void)
{
    static const char *const switched[] = {"off", "on", NULL};
    static const struct catalogue_parameter settings[] = {{"moving_objects", "", 0, 1, 0, switched, NULL},
                                                          {"ssao", "", 0, 1, 0, switched, NULL}};
    static struct catalogue whole;
    whole = *sample_catalogue();
    whole.settings = settings;
    whole.setting_count = 2;
    return &whole;
}

static const struct host *find_host(const struct language_section *section, const char *key)
{
    static struct host plain = {&language_protocol, NULL, NULL, "%s"};
    const struct host *found = NULL;
    if (section == &language_protocol) {
        plain.top = key;
        return &plain;
    }
    for (size_t i = 0; i < sizeof hosts / sizeof hosts[0]; i++) {
        if (hosts[i].section != section || (hosts[i].key && strcmp(hosts[i].key, key) != 0))
            continue;
        if (!found || (!found->key && hosts[i].key))
            found = &hosts[i];
    }
    if (!found)
        fail_msg("no protocol to put %s, key %s in", section->title, key);
    return found;
}

static void add(char *out, size_t size, const char *text)
{
    size_t used = strlen(out);
    int more = snprintf(out + used, size - used, "%s\n", text);
    assert_true(more >= 0 && (size_t)more < size - used);
}

// The host's text with the example in the place of its one %s.
static void fill(const struct host *host, const char *example, char *out, size_t size)
{
    const char *place = strstr(host->text, "%s");
    assert_non_null(place);
    int length = snprintf(out, size, "%.*s%s%s", (int)(place - host->text), host->text, example, place + 2);
    assert_true(length > 0 && (size_t)length < size);
}

// Where to put every protocol as well, for the schema's test; NULL: nowhere.
static const char *folder;

static void keep(const char *text, size_t number)
{
    char path[512];
    if (!folder)
        return;
    snprintf(path, sizeof path, "%s/example-%03zu.yaml", folder, number);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "#\n%s", text);
    assert_int_equal(fclose(file), 0);
}

static void test_every_example_is_read(void **state)
{
    (void)state;
    size_t examples = 0;
    for (size_t s = 0; language_sections[s]; s++)
        for (const struct language_key *key = language_sections[s]->keys; key->name; key++, examples++) {
            const struct host *host = find_host(language_sections[s], key->name);
            char text[8192] = "", own[4096], error[PROTOCOL_ERROR] = "";
            bool placed = false;
            fill(host, key->example, own, sizeof own);
            for (size_t i = 0; i < sizeof base / sizeof base[0]; i++) {
                bool mine = strcmp(base[i].key, host->top) == 0;
                add(text, sizeof text, mine ? own : base[i].text);
                placed = placed || mine;
            }
            if (!placed)
                add(text, sizeof text, own);
            struct protocol *protocol =
                protocol_parse("p", text, strlen(text), catalogue(), error, sizeof error);
            if (!protocol)
                fail_msg("%s: %s\n%s\n%s", language_sections[s]->title, key->example, error, text);
            protocol_destroy(protocol);
            keep(text, examples);
        }
    print_message("%zu examples\n", examples);
    assert_true(examples > 100);
}

// Every example begins with its own key, every key has its sentence, every section that is named exists.
static void test_the_tables_are_whole(void **state)
{
    (void)state;
    for (size_t s = 0; language_sections[s]; s++)
        for (const struct language_key *key = language_sections[s]->keys; key->name; key++) {
            size_t length = strlen(key->name);
            assert_true(strncmp(key->example, key->name, length) == 0 && key->example[length] == ':');
            assert_null(strpbrk(key->example, "|\n")); // a table's cell
            assert_null(strpbrk(key->about, "|\n"));
            assert_true(key->about[strlen(key->about) - 1] == '.');
            if (key->type == LANGUAGE_WORD)
                assert_non_null(key->words);
            bool known = !key->of;
            for (size_t i = 0; language_sections[i]; i++)
                known = known || strcmp(language_sections[i]->title, key->of) == 0;
            assert_true(known);
        }
}

static void test_schema_and_page_name_every_key(void **state)
{
    (void)state;
    char *schema = protocol_schema(catalogue()), *page = protocol_reference(catalogue());
    assert_non_null(schema);
    assert_non_null(page);
    for (size_t s = 0; language_sections[s]; s++)
        for (const struct language_key *key = language_sections[s]->keys; key->name; key++) {
            char quoted[128];
            snprintf(quoted, sizeof quoted, "\"%s\":", key->name);
            assert_non_null(strstr(schema, quoted));
            snprintf(quoted, sizeof quoted, "| `%s` |", key->name);
            assert_non_null(strstr(page, quoted));
        }
    assert_non_null(strstr(schema, "\"fovea_deg\""));
    assert_non_null(strstr(page, "| `fovea_deg` | 0 to 90 deg | 10 |"));
    assert_non_null(strstr(schema, "\"moving_objects\""));
    assert_non_null(strstr(page, "| `moving_objects` | `off`, `on` | off |"));
    free(schema);
    free(page);
}

int main(int argc, char **argv)
{
    folder = argc == 3 && strcmp(argv[1], "--keep") == 0 ? argv[2] : NULL;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_example_is_read),
        cmocka_unit_test(test_the_tables_are_whole),
        cmocka_unit_test(test_schema_and_page_name_every_key),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
