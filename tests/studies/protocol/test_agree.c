// Designs that contradict themselves get a sentence; odd ones get a remark. Each case changes one thing.
#include "studies/protocol/protocol.h"
#include "tests/studies/protocol/sample_catalogue.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// What stands before the case's own lines.
#define HEAD                                                                                                   \
    "fovstudy: 1\nname: host\ntitle: A host\nseed: 1\nscenes: [atrium]\nreference: regular\n"                  \
    "instructions: Look.\nconsent: {version: 1, text: Agree?}\n"                                               \
    "options:\n  foveated: {mode: time_warped}\n  regular: {mode: regular}\n"                                  \
    "questions:\n  prefer: {text: Which?}\n"
#define BLOCK "blocks:\n- name: main\n  kind: toggle\n  options: [foveated, regular]\n"
#define SETTINGS "settings: {question: prefer}\n"

struct odd {
    const char *text, *sentence; // of the only remark; "": none
};

#define MORE "  equal: {text: Which?, correct: reference, equal: yes}\n  sure: {text: Sure?, scale: [1, 4]}\n"

static struct protocol *parse(const char *lines, char *error)
{
    char text[4096];
    int length = snprintf(text, sizeof text, "%s%s", HEAD, lines);
    assert_true(length > 0 && (size_t)length < sizeof text);
    error[0] = '\0';
    return protocol_parse("p", text, strlen(text), sample_catalogue(), error, PROTOCOL_ERROR);
}

static void expect_remarks(const struct odd *cases, size_t count)
{
    char error[PROTOCOL_ERROR];
    for (size_t i = 0; i < count; i++) {
        struct protocol *p = parse(cases[i].text, error);
        if (!p)
            fail_msg("%s\n%s", error, cases[i].text);
        if (p->remark_count != (*cases[i].sentence != '\0'))
            fail_msg("%u remarks, first: %s\n%s", p->remark_count, p->remark_count ? p->remarks[0] : "",
                     cases[i].text);
        if (p->remark_count)
            assert_string_equal(p->remarks[0], cases[i].sentence);
        protocol_destroy(p);
    }
}

static void expect_errors(const struct odd *cases, size_t count)
{
    char error[PROTOCOL_ERROR];
    for (size_t i = 0; i < count; i++) {
        struct protocol *p = parse(cases[i].text, error);
        protocol_destroy(p);
        assert_string_equal(error, cases[i].sentence);
    }
}

static void test_nothing_to_say(void **state)
{
    (void)state;
    const struct odd cases[] = {
        {SETTINGS BLOCK, ""},
        {SETTINGS BLOCK "  break_every: 2\n  break_s: 5\n  repetitions: 4\n", ""},
        {"participants: 8\n" SETTINGS BLOCK "  order: latin\n  factors: {epsilon: [0.1, 0.2, 0.3, 0.4]}\n", ""},
        {"settings: {question: prefer, min_exposure_s: 1, deadline_s: 3}\n" BLOCK, ""},
    };
    expect_remarks(cases, sizeof cases / sizeof cases[0]);
}

// Of two options a guess is right half of the time.
static void test_guesses(void **state)
{
    (void)state;
#define QUEST(guess)                                                                                           \
    "  right: {text: Which is the original?, correct: reference}\nsettings: {question: right}\n"               \
    "blocks:\n- {name: a, kind: toggle, options: [foveated, regular], settings: {question: prefer}}\n- name: " \
    "main\n  kind: staircase\n  options: [foveated, regular]\n"                                                \
    "  staircase: {parameter: hole_decay, larger: easier, trials: 10, method: quest_plus, "                    \
    "level: {min: 0.1, max: 1, count: 5},\n"                                                                   \
    "    model: {family: logistic, threshold: {min: 0.2, max: 0.8, count: 3}, slope: {min: 1, max: 1}" guess   \
    "}}\n"
    const struct odd cases[] = {
        {QUEST(""), ""},
        {QUEST(", guess: {min: 0.5, max: 0.5}"), ""},
        {QUEST(", guess: {min: 0.25, max: 0.25}"), "p:22:99: who guesses between two options is right half of "
                                                   "the time, so guess is 0.5; another one makes "
                                                   "another threshold"},
    };
    expect_remarks(cases, sizeof cases / sizeof cases[0]);
#undef QUEST
}

static void test_what_nobody_sees(void **state)
{
    (void)state;
    static const char text[] =
        "fovstudy: 1\nname: n\ntitle: t\nseed: 1\nscenes:\n- atrium\n- town\nreference: a\n"
        "instructions: i\nconsent: {version: 1, text: c}\n"
        "options:\n  a: {mode: regular}\n  b: {mode: time_warped}\n  c: {mode: time_warped, epsilon: 0.3}\n"
        "questions:\n  q: {text: q}\n  z: {text: z, scale: [1, 7]}\nsettings: {question: q}\n"
        "blocks:\n- {name: m, kind: toggle, options: [b, a], scenes: [town]}\n";
    char error[PROTOCOL_ERROR];
    struct protocol *p = protocol_parse("p", text, strlen(text), sample_catalogue(), error, sizeof error);
    assert_non_null(p);
    assert_int_equal(p->remark_count, 3);
    assert_string_equal(p->remarks[0], "p:14:3: no block shows option 'c'; use it or remove it");
    assert_string_equal(p->remarks[1], "p:17:3: no block asks question 'z'; use it or remove it");
    assert_string_equal(p->remarks[2], "p:6:3: no block shows scene 'atrium'; use it or remove it");
    protocol_destroy(p);
}

static void test_blocks(void **state)
{
    (void)state;
    const struct odd cases[] = {
        {SETTINGS BLOCK "  repetitions: 9\n  break_every: 20\n",
         "p:20:3: block 'main' has 9 trials, so its break after 20 never comes; lower it or remove it"},
        {SETTINGS BLOCK "  break_s: 20\n", "p:19:3: block 'main' has no breaks; set 'break_every' too"},
        {SETTINGS BLOCK "  trials: [{role: practice}, {role: null}]\n",
         "p:16:3: block 'main' has no trial that an analysis counts: all are practice, catch or null"},
        {SETTINGS BLOCK "  factors:\n    epsilon: [0.1, 0.3]\n    which: {levels: {x: {parameters: {foveated: "
                        "{epsilon: 0.2}}}}}\n",
         "p:20:5: levels 0.1 and 0.3 of 'epsilon' show the same in block 'main'; does a factor after it "
         "replace the "
         "option that it changes?"},
        {SETTINGS BLOCK "  factors:\n    epsilon: [0.1, 0.3]\n    which: {options: [foveated]}\n", ""},
        {SETTINGS BLOCK "  factors:\n    which: {options: [foveated]}\n    epsilon: [0.1, 0.3]\n", ""},
        {"settings: {question: prefer, view_s: 20, deadline_s: 5}\n" BLOCK,
         "p:16:3: block 'main' ends a trial after 5 s (deadline_s), before its view_s of 20 s; raise the one "
         "or lower "
         "the other"},
        {SETTINGS "blocks:\n- name: main\n  kind: sequential\n  options: [foveated, regular]\n"
                  "  settings: {view_s: 0.3}\n",
         "p:16:3: block 'main' fades for 0.5 s, longer than it shows an option (view_s, 0.3 s)"},
    };
    expect_remarks(cases, sizeof cases / sizeof cases[0]);
}

static void test_people(void **state)
{
    (void)state;
#define GROUPS "  factors: {epsilon: {between: yes, levels: [0.1, 0.2, 0.3, 0.4]}}\n"
    const struct odd cases[] = {
        {"participants: 3\n" SETTINGS BLOCK GROUPS, "p:14:1: 3 participants are fewer than the 4 groups that "
                                                    "the factors between participants make; some level "
                                                    "gets nobody"},
        {"participants: 10\n" SETTINGS BLOCK GROUPS,
         "p:14:1: 10 participants do not fill 4 groups of people evenly; plan a multiple of 4"},
        {"participants: 8\n" SETTINGS BLOCK GROUPS, ""},
        {"participants: 8\n" SETTINGS BLOCK "  order: latin\n  factors: {epsilon: [0.1, 0.2, 0.3]}\n",
         "p:20:3: carry-over in block 'main' is balanced for each 6 participants; 8 are no multiple of it"},
        {"participants: 8\n" SETTINGS BLOCK "  order: latin\n  null: 1\n  factors: {epsilon: [0.1, 0.2]}\n",
         "p:20:3: carry-over in block 'main' is not balanced exactly: null and catch trials come between its "
         "cells"},
        {"participants: 8\n" SETTINGS BLOCK "  null: 1\n  factors: {epsilon: [0.1, 0.2]}\n", ""},
    };
    expect_remarks(cases, sizeof cases / sizeof cases[0]);
}

static void test_analysis_and_rules(void **state)
{
    (void)state;
#define PLAN(what) "analysis:\n- " what "\n" SETTINGS BLOCK
    const struct odd cases[] = {
        {PLAN("{method: binomial, of: choice, per: cell}"), ""},
        {PLAN("{method: mean, of: threshold}"), "p:15:18: no block gives thresholds to analyse"},
        {PLAN("{method: mean, of: adjusted}"), "p:15:18: no block gives adjusted values to analyse"},
        {PLAN("{method: paired_t, of: rating}"), "p:15:22: no block gives ratings to analyse"},
        {PLAN("{method: binomial, of: toggles}"), "p:15:4: the binomial test counts choices, not toggles"},
        {PLAN("{method: mean, of: choice, per: factor}"), "p:15:30: no block has factors to split by"},
        {PLAN("{method: mean, of: choice, per: order}"),
         "p:15:30: no rate block has its complement, so there are no orders to split by"},
        {PLAN("{method: binomial, of: choice, per: cell}\n- {method: binomial, of: choice}\n"
              "- {method: binomial, of: choice, per: cell}"),
         "p:17:3: this analysis is planned twice, as number 1 and 3; remove one"},
        {PLAN("{method: anova, of: choice, per: cell}"),
         "p:15:31: an analysis of variance compares levels of factors, not each cell; write 'per: factor'"},
        {"exclude:\n- {rule: failed_catch}\n" SETTINGS BLOCK,
         "p:15:4: no block has catch trials that could be failed"},
    };
    expect_remarks(cases, sizeof cases / sizeof cases[0]);
}

static void test_contradictions(void **state)
{
    (void)state;
#define STAIRS(asked, model)                                                                                   \
    MORE "settings: {question: " asked                                                                         \
         "}\nblocks:\n- name: main\n  kind: staircase\n  options: [foveated, regular]\n"                       \
         "  staircase: {parameter: epsilon, method: quest_plus, larger: easier, trials: 9, level: {min: 0.1, " \
         "max: "                                                                                               \
         "1, "                                                                                                 \
         "count: 5}, model: {family: logistic, threshold: {min: 0.1, max: 1, count: 5}, slope: {min: 1, max: " \
         "9, "                                                                                                 \
         "count: 3}" model "}}\n"
    const struct odd cases[] = {
        {SETTINGS "blocks:\n- name: main\n  kind: sequential\n  options: [foveated, regular]\n"
                  "  settings: {view_s: 2, min_exposure_s: 3}\n",
         "p:19:41: block 'main' shows an option for 2 s (view_s), but asks that it was shown for 3 s "
         "(min_exposure_s); lower min_exposure_s or raise view_s"},
        {SETTINGS BLOCK "  settings: {min_exposure_s: 2, deadline_s: 4}\n",
         "p:19:45: block 'main' takes no answer before both options were shown for 2 s (min_exposure_s), with "
         "the "
         "fade 4.5 s, but none after 4 s (deadline_s); raise deadline_s or lower min_exposure_s"},
        {"settings: {question: prefer, min_exposure_s: 2, deadline_s: 4}\n" BLOCK,
         "p:16:3: block 'main' takes no answer before both options were shown for 2 s (min_exposure_s), with "
         "the "
         "fade 4.5 s, but none after 4 s (deadline_s); raise deadline_s or lower min_exposure_s"},
        {STAIRS("prefer", ""),
         "p:21:14: a staircase follows right and wrong answers, but question 'prefer' is a preference; give it "
         "'correct: reference', or ask one that has a scale"},
        {STAIRS("equal", ", guess: {min: 0.5, max: 0.5}"),
         "p:21:14: guess is for two outcomes; leave it out with 3"},
        {STAIRS("sure", ", guess: {min: 0.5, max: 0.5}"),
         "p:21:14: guess is for two outcomes; leave it out with 4"},
        {STAIRS("equal", ""), ""},
    };
    expect_errors(cases, sizeof cases / sizeof cases[0]);
}

// A parameter that the participant or the staircase sets is no factor's too: the factors would say one value,
// and another would be shown.
static void test_one_thing_sets_a_parameter(void **state)
{
    (void)state;
    static const char *const factors[] = {"epsilon: [0.1, 0.2]", "epsilon: [0.1]", "fovea_deg: [6, 10]"};
    for (int stairs = 0; stairs < 2; stairs++) {
        for (int i = 0; i < 3; i++) {
            char text[2048], error[PROTOCOL_ERROR] = "";
            snprintf(
                text, sizeof text,
                "fovstudy: 1\nname: host\ntitle: A host\nseed: 1\nscenes: [atrium]\nreference: r\n"
                "instructions: Look.\nconsent: {version: 1, text: Agree?}\n"
                "options: {f: {mode: time_warped}, r: {mode: regular}}\n"
                "questions: {o: {text: Which?, correct: reference}}\nsettings: {question: o}\n"
                "blocks:\n- name: b\n  kind: %s\n  options: [f, r]\n  factors: {%s}\n  %s\n",
                stairs ? "staircase" : "adjust", factors[i],
                stairs ? "staircase: {parameter: epsilon, method: 1up2down, larger: easier, level: {min: 0.1, "
                         "max: 1}, start: 0.5, steps: [0.1], trials: 9}"
                       : "adjust: {epsilon: {start: [0.1, 0.5], step: 0.1}}");
            struct protocol *p =
                protocol_parse("p", text, strlen(text), sample_catalogue(), error, sizeof error);
            assert_int_equal(p != NULL, i == 2);
            if (i < 2)
                assert_string_equal(
                    error,
                    stairs
                        ? "p:17:26: the staircase sets 'epsilon', and so does a factor or a trial of block "
                          "'b'; keep one"
                        : "p:17:21: the participant sets 'epsilon', and so does a factor or a trial of block "
                          "'b'; keep one");
            protocol_destroy(p);
        }
    }
}

// No block is the complement of itself, or of one that comes later: no circle can be written.
static void test_circles(void **state)
{
    (void)state;
    static const char *const blocks[] = {"a", "b"};
    static const struct {
        const char *of[2], *sentence;
    } cases[] = {
        {{"a", ""}, "p:16:70: block 'a' cannot be the complement of itself; name the block before it"},
        {{"b", ""},
         "p:16:70: block 'b' comes later; a complement names an earlier one, so turn the two around"},
        {{"b", "a"},
         "p:16:70: block 'b' comes later; a complement names an earlier one, so turn the two around"},
        {{"", "c"}, "p:17:70: complement_of 'c' is not known here; did you mean 'a'?"},
        {{"", "a"}, ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[2048] =
            "fovstudy: 1\nname: host\ntitle: A host\nseed: 1\nscenes: [atrium]\nreference: regular\n"
            "instructions: Look.\nconsent: {version: 1, text: Agree?}\n"
            "options:\n  foveated: {mode: time_warped}\n  regular: {mode: regular}\n"
            "questions:\n  q: {text: How?, scale: [1, 7]}\nsettings: {question: q}\nblocks:\n";
        char error[PROTOCOL_ERROR] = "";
        for (size_t b = 0; b < 2; b++) {
            size_t used = strlen(text);
            snprintf(text + used, sizeof text - used,
                     "- {name: %s, kind: rate, options: [foveated, regular]%s%s}\n", blocks[b],
                     *cases[i].of[b] ? ", complement_of: " : "", cases[i].of[b]);
        }
        protocol_destroy(protocol_parse("p", text, strlen(text), sample_catalogue(), error, sizeof error));
        assert_string_equal(error, cases[i].sentence);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_to_say),   cmocka_unit_test(test_guesses),
        cmocka_unit_test(test_what_nobody_sees), cmocka_unit_test(test_blocks),
        cmocka_unit_test(test_people),           cmocka_unit_test(test_analysis_and_rules),
        cmocka_unit_test(test_contradictions),   cmocka_unit_test(test_one_thing_sets_a_parameter),
        cmocka_unit_test(test_circles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
