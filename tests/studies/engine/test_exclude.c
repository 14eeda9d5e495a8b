// Exclusion rules as laws: each holds on one side of its limit and not on the other, says why, spares what is
// not known; pairs go together; people go by share.
#include "studies/engine/exclude.h"
#include "tests/studies/protocol/sample_catalogue.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { VERDICTS = 64 };

struct verdicts {
    struct exclude_verdict list[VERDICTS];
    size_t count;
};

static bool take(void *user, const struct exclude_verdict *verdict)
{
    struct verdicts *verdicts = user;
    assert_true(verdicts->count < VERDICTS);
    verdicts->list[verdicts->count++] = *verdict;
    return true;
}

static struct protocol *protocol_of(const char *rules)
{
    static const char head[] =
        "fovstudy: 1\nname: n\ntitle: t\nseed: 1\nscenes: [atrium, town]\n"
        "options:\n  foveated: {mode: time_warped}\n  regular: {mode: regular}\n"
        "reference: regular\nsettings: {question: q}\n"
        "questions:\n  q: {text: which}\n  r: {text: how, scale: [1, 10]}\n"
        "instructions: i\nconsent: {version: \"1\", text: c}\n"
        "blocks:\n"
        "  - {name: before, kind: rate, options: [foveated, regular], settings: {question: r}}\n"
        "  - {name: main, kind: toggle, options: [foveated, regular]}\n"
        "  - {name: after, kind: rate, options: [foveated, regular], complement_of: before,\n"
        "     settings: {question: r}}\n";
    char text[4096], error[PROTOCOL_ERROR];
    int size = snprintf(text, sizeof text, "%sexclude:\n%s", head, rules);
    struct protocol *protocol =
        protocol_parse("test", text, (size_t)size, sample_catalogue(), error, sizeof error);
    if (!protocol)
        fail_msg("%s", error);
    return protocol;
}

// A trial that no rule has anything against.
static struct exclude_facts good(int64_t trial, const char *block)
{
    return (struct exclude_facts){.trial = trial,
                                  .session = 1,
                                  .block = block,
                                  .kind = "toggle",
                                  .seen_s = {4, 4},
                                  .gaze_samples = 1000,
                                  .gaze_gap_ms = 10,
                                  .stimulus_frames = 720,
                                  .rendered_frames = 800,
                                  .reaction_s = 8};
}

static struct verdicts judge(const char *rules, const struct exclude_facts *facts, size_t count)
{
    struct verdicts verdicts = {.count = 0};
    struct protocol *protocol = protocol_of(rules);
    assert_true(exclude_apply(protocol, facts, count, take, &verdicts));
    for (size_t i = 0; i < verdicts.count; i++)
        verdicts.list[i].rule = NULL; // goes with the protocol
    protocol_destroy(protocol);
    return verdicts;
}

// Nothing, or one verdict on trial 1 with this sentence.
static void expect(const char *rules, struct exclude_facts facts, const char *reason)
{
    struct verdicts verdicts = judge(rules, &facts, 1);
    if (verdicts.count != (reason ? 1u : 0u))
        fail_msg("%s: %zu verdicts; %s", rules, verdicts.count, verdicts.count ? verdicts.list[0].reason : "");
    if (reason) {
        assert_string_equal(verdicts.list[0].reason, reason);
        assert_int_equal(verdicts.list[0].trial, 1);
    }
}

static void test_each_rule_has_one_side(void **state)
{
    (void)state;
    struct exclude_facts f = good(1, "main");
    static const char all[] = "  - {rule: unseen_option}\n  - {rule: gaze_loss}\n  - {rule: gaze_gap_ms}\n"
                              "  - {rule: late_frames}\n  - {rule: reaction}\n  - {rule: failed_catch}\n"
                              "  - {rule: fallback}\n";
    expect(all, f, NULL);
    f.seen_s[1] = 1;
    expect(all, f, NULL); // exactly the second that is asked for
    f.seen_s[1] = 0.4;
    expect(all, f, "option b was seen for 0.4 s, less than 1 s");
    expect("  - {rule: unseen_option, below: 0.4}\n", f, NULL);
    f = good(1, "main");
    f.gaze_lost = 200;
    expect(all, f, NULL);
    f.gaze_lost = 201;
    expect(all, f, "201 of 1000 gaze samples have no direction (20.1 %), more than 20 %");
    f = good(1, "main");
    f.gaze_gap_ms = 500;
    expect(all, f, NULL);
    f.gaze_gap_ms = 812.3;
    expect(all, f, "no gaze direction for 812.3 ms, more than 500 ms");
    f = good(1, "main");
    f.late_frames = 7; // 0.97 %
    expect(all, f, NULL);
    f.late_frames = 8;
    expect(all, f, "8 of 720 stimulus frames came late (1.11 %), more than 1 %");
    f = good(1, "main");
    f.reaction_s = 0.2;
    expect(all, f, NULL);
    f.reaction_s = 0.15;
    expect(all, f, "answered after 0.15 s, less than 0.2 s");
    f.reaction_s = 61;
    expect("  - {rule: reaction, above: 60}\n", f, "answered after 61 s, more than 60 s");
    f = good(1, "main");
    f.caught = f.missed = true;
    expect(all, f, "a catch trial that was missed");
    f = good(1, "main");
    f.fallback_frames = 1;
    expect(all, f, "1 of 800 frames were not what was asked (0.125 %), more than 0 %");
}

static void test_what_is_not_known_is_spared(void **state)
{
    (void)state;
    struct exclude_facts f = {.trial = 1,
                              .session = 1,
                              .block = "main",
                              .kind = "toggle",
                              .seen_s = {NAN, NAN},
                              .gaze_gap_ms = NAN,
                              .reaction_s = NAN};
    expect("  - {rule: unseen_option}\n  - {rule: gaze_loss, above: 0}\n  - {rule: gaze_gap_ms, above: 0}\n"
           "  - {rule: late_frames, above: 0}\n  - {rule: reaction, above: 0}\n  - {rule: failed_catch}\n"
           "  - {rule: fallback}\n  - {rule: gaze_loss, of: person, share: 0}\n"
           "  - {rule: failed_catch, of: person, above: 0}\n",
           f, NULL);
    f = good(1, "main"); // a trial of one option
    f.seen_s[1] = NAN;
    expect("  - {rule: unseen_option}\n", f, NULL);
}

static void test_pairs_go_together(void **state)
{
    (void)state;
    struct exclude_facts f[6] = {good(1, "before"), good(2, "main"),  good(3, "after"),
                                 good(4, "before"), good(5, "after"), good(6, "main")};
    f[0].rated = f[2].rated = f[3].rated = f[4].rated = f[5].rated = true; // 6: ratings after a choice
    f[3].session = f[4].session = 2;
    f[1].gaze_gap_ms = f[2].gaze_gap_ms = f[5].gaze_gap_ms = 900;
    struct verdicts v = judge("  - {rule: gaze_gap_ms, of: rating_pair}\n", f, 6);
    assert_int_equal(v.count, 3); // not 2, where nothing was rated, and not the other session's
    assert_int_equal(v.list[0].trial, 1);
    assert_string_equal(v.list[0].reason,
                        "its pair, trial 3, is out: no gaze direction for 900 ms, more than 500 ms");
    assert_int_equal(v.list[1].trial, 3);
    assert_int_equal(v.list[2].trial, 6);

    struct protocol *protocol = protocol_of("  - {rule: gaze_loss, of: rating_pair}\n  - {rule: fallback}\n");
    char name[PROTOCOL_NAME];
    exclude_rule_name(&protocol->exclusions[0], name);
    assert_string_equal(name, "gaze_loss:rating_pair");
    exclude_rule_name(&protocol->exclusions[1], name);
    assert_string_equal(name, "fallback");
    protocol_destroy(protocol);
}

static void test_people_go_by_share(void **state)
{
    (void)state;
    struct exclude_facts f[8];
    for (int i = 0; i < 8; i++)
        f[i] = good(i + 1, "main");
    for (int i = 0; i < 4; i++)
        f[i].gaze_lost = 500;
    assert_int_equal(judge("  - {rule: gaze_loss, of: person}\n", f, 8).count, 0); // half, not more
    f[4].gaze_lost = 500;
    struct verdicts v = judge("  - {rule: gaze_loss, of: person}\n", f, 8);
    assert_int_equal(v.count, 1);
    assert_int_equal(v.list[0].trial, 0);
    assert_string_equal(v.list[0].reason, "gaze_loss holds in 5 of 8 trials (62.5 %), more than 50 %");
    // Catch trials count among themselves.
    f[6].caught = f[7].caught = f[7].missed = true;
    assert_int_equal(judge("  - {rule: failed_catch, of: person}\n", f, 8).count, 0);
    v = judge("  - {rule: failed_catch, of: person, above: 0.25}\n", f, 8);
    assert_int_equal(v.count, 1);
    assert_string_equal(v.list[0].reason, "missed 1 of 2 catch trials (50 %), more than 25 %");
    assert_int_equal(judge("  - {rule: failed_catch, of: person, share: 0.3}\n", f, 8).count, 1);
    assert_int_equal(judge("  - {rule: failed_catch, of: person, above: 0}\n", f, 8).count, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_rule_has_one_side),
        cmocka_unit_test(test_what_is_not_known_is_spared),
        cmocka_unit_test(test_pairs_go_together),
        cmocka_unit_test(test_people_go_by_share),
    };
    return cmocka_run_group_tests_name("exclude", tests, NULL, NULL);
}
