// The tests whose power `fovstudy check` forecasts are those that `fovstats planned` then makes: as many rows,
// a test where the forecast has one, and with as many people.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { PEOPLE = 8 };

static char folder[512];

static void write_file(const char *name, const char *text)
{
    char path[600];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

#define HEAD                                                                                                   \
    "fovstudy: 1\nname: forecast\ntitle: Forecast\nseed: 3\nparticipants: 8\nreference: regular\n"             \
    "instructions: Look.\nconsent: {version: \"1\", text: Agree?}\nscenes: [atrium, town]\n"                   \
    "options:\n  foveated: {mode: time_warped, epsilon: 0.2}\n  regular: {mode: regular}\n"                    \
    "questions:\n  prefer: {text: Which?}\n  original: {text: Which?, correct: reference}\n"                   \
    "  quality: {text: How?, scale: [1, 10]}\nsettings: {question: prefer}\n"
#define OF(method, of, per) "- {method: " method ", of: " of ", per: " per "}\n"
#define ALL(method, of)                                                                                        \
    OF(method, of, "cell") OF(method, of, "factor") OF(method, of, "scene") OF(method, of, "study")
#define COMPARED(of) ALL("paired_t", of) ALL("unpaired_t", of)

#define LIT "lit: {between: yes, levels: {dim: {settings: {rest_s: 0.4}}, bright: {}}}"
#define CHOICE_BLOCKS                                                                                          \
    "blocks:\n- name: main\n  kind: toggle\n  options: [foveated, regular]\n"                                  \
    "  catch: {count: 1, option: foveated}\n  factors: {epsilon: [0.1, 0.2, 0.4], " LIT "}\n"                  \
    "- name: other\n  kind: toggle\n  options: [foveated, regular]\n  repetitions: 2\n"                        \
    "  factors: {epsilon: [0.1, 0.3]}\n"                                                                       \
    "- {name: right, kind: toggle, options: [foveated, regular], settings: {question: original}}\n"
#define VALUE_BLOCKS                                                                                           \
    "blocks:\n- name: main\n  kind: toggle\n  options: [foveated, regular]\n"                                  \
    "  factors: {epsilon: [0.1, 0.2], scene: {scenes: [atrium, town]}}\n"                                      \
    "- name: rated\n  kind: rate\n  options: [foveated]\n  settings: {question: quality, view_s: 3}\n"         \
    "  factors: {how: {options: [foveated, regular]}, " LIT "}\n"                                              \
    "- name: stairs\n  kind: staircase\n  options: [foveated, regular]\n  settings: {question: original}\n"    \
    "  factors: {" LIT "}\n"                                                                                   \
    "  staircase: {parameter: epsilon, method: 1up2down, larger: easier, level: {min: 0.01, max: 1}, "         \
    "start: 0.5, steps: [0.1], trials: 60}\n"                                                                  \
    "- {name: set, kind: adjust, options: [foveated, regular], adjust: {epsilon: {start: [0.1, 0.5], step: "   \
    "0.01}}}\n"

// Between and within factors, repetitions, a factor that some blocks lack, a question with a right answer.
static const char choices[] =
    HEAD "analysis:\n"
         "- {method: binomial, of: choice, per: cell, margin: 0.2}\n"
         "- {method: binomial, of: choice, per: factor, margin: 0.3}\n"
         "- {method: binomial, of: choice, margin: 0.25}\n" OF("binomial", "choice", "study") COMPARED("choice")
             CHOICE_BLOCKS;
static const char toggles[] =
    HEAD "analysis:\n" COMPARED("toggles") OF("binomial", "toggles", "cell") CHOICE_BLOCKS;
static const char ratings[] = HEAD "analysis:\n" COMPARED("rating") COMPARED("reaction") VALUE_BLOCKS;
static const char set[] = HEAD "analysis:\n" COMPARED("threshold") COMPARED("adjusted") VALUE_BLOCKS;

// Ratings before and after, whose order is the people's.
static const char before_after[] = HEAD "analysis:\n" OF("unpaired_t", "rating", "order")
    OF("paired_t", "rating", "order") OF("paired_t", "rating", "study") OF("paired_t", "rating", "cell")
        OF("paired_t", "choice", "order") "blocks:\n"
                                          "- {name: before, kind: rate, options: [foveated, regular], "
                                          "settings: {question: quality, view_s: 3}}\n"
                                          "- {name: main, kind: toggle, options: [foveated, regular]}\n"
                                          "- {name: after, kind: rate, complement_of: before, settings: "
                                          "{question: quality, view_s: 3}}\n";

// Both options rated after a choice.
static const char both_rated[] = HEAD "analysis:\n" COMPARED("rating")
    OF("paired_t", "rating", "order") "blocks:\n- name: main\n  kind: toggle\n  options: [foveated, regular]\n "
                                      " settings: {ratings: quality}\n"
                                      "  factors: {epsilon: [0.1, 0.2]}\n";

// Whether each row is a test, and of how many people; a plan without one has a row that says why.
static const char compare[] =
    "import json, sys\n"
    "check, planned = (json.load(open(name)) for name in sys.argv[1:])\n"
    "plans = {(p['method'], p['of'], p['per'], p['margin'] or 0): p['rows'] for p in planned['plans']}\n"
    "compared = 0\n"
    "for a in check['power']:\n"
    "    key = a['method'], a['of'], a['per'] or '-', a.get('margin', 0)\n"
    "    rows = []\n"
    "    for p in a['parts']:\n"
    "        n = p['n'] + p.get('n_second', 0) - p.get('both', 0)\n"
    "        tested = n > 0 and not p.get('both', 0)\n"
    "        rows += [(n * tested, tested)] * (2 if p['margin_planned'] else 1)\n"
    "    if a['none']:\n"
    "        assert not rows, key\n"
    "        rows = [(0, False)]\n"
    "    made = [r['test'] != '' or 'no spread' in r['note'] or 'not estimable: one' in r['note']\n"
    "            for r in plans[key]]\n"
    "    made = [(r['people'] * tested, tested) for r, tested in zip(plans[key], made)]\n"
    "    if sorted(rows) != sorted(made):\n"
    "        sys.exit(f'{key}: forecast {sorted(rows)}, made {sorted(made)}, {[r[\"row\"] + r[\"note\"] for r "
    "in "
    "plans[key]]}')\n"
    "    compared += len(rows)\n"
    "print(compared)\n";

static int compare_study(const char *text)
{
    int rows = 0;
    char errors[1024];
    size_t used = 0;
    write_file("p.yaml", text);
    const char *const scenes[] = {"atrium", "town"}, *const levels[] = {"0.01", "0.1", "0.2",
                                                                        "0.3",  "0.4", "1"};
    for (size_t i = 0; i < 12; i++)
        used += (size_t)snprintf(errors + used, sizeof errors - used, "%s,0.0%zu,time_warped:epsilon=%s\n",
                                 scenes[i / 6], i % 6 + 1, levels[i % 6]);
    write_file("errors.csv", errors);
    write_file("compare.py", compare);
    const struct command_result *result = command(
        "cd '%s' && rm -f s.db && fovstudy run p.yaml --db s.db --display none --participants %d --observer "
        "sim:errors=errors.csv && fovstudy check p.yaml --json > check.json && '%s/bin/fovstats' planned s.db "
        "--simulated --json > planned.json; python3 compare.py check.json planned.json",
        folder, PEOPLE, BUILD_DIR);
    if (result->status != 0 || sscanf(result->out, "%d", &rows) != 1)
        fail_msg("%s%s", result->out, result->err);
    return rows;
}

static void forecasts_are_of_the_tests_that_follow(void **state)
{
    (void)state;
    const struct {
        const char *text;
        int rows;
    } studies[] = {{choices, 60}, {toggles, 30}, {ratings, 30}, {set, 16}, {before_after, 5}, {both_rated, 8}};
    for (size_t i = 0; i < sizeof studies / sizeof studies[0]; i++) {
        int rows = compare_study(studies[i].text);
        print_message("study %zu: %d rows\n", i, rows);
        assert_true(rows >= studies[i].rows);
    }
}

static int set_up(void **state)
{
    (void)state;
    command_folder("forecast", folder, sizeof folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(forecasts_are_of_the_tests_that_follow)};
    return cmocka_run_group_tests(tests, set_up, NULL);
}
