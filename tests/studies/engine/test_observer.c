// The simulated observer through the real machine: it recovers its own laws within binomial error, repeats
// exactly, and keeps the demonstration's times.
#include "studies/engine/observer.h"

#include "tests/studies/engine/sample_design.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

struct tally {
    uint32_t choices, ratings, trials;
    uint32_t by_level[5], better[5]; // toggle trials by error difference, and how often the better was chosen
    uint32_t slot_a;
    double toggles, toggle_s, rate_s, rating_sum, rating_squares;
    uint32_t frames;
    uint64_t digest; // of every event and its time
};

// Differences of error of the cells, in thresholds; a cell's option under test is the worse one.
static const double levels[5] = {0, 0.5, 1, 2, 4};

// One session; `errors` of trial t: the option under test is worse by levels[t mod 5] thresholds.
static void run_session(const struct observer_parameters *parameters, const struct protocol *protocol,
                        uint64_t seed, uint32_t number, int64_t frame_ns, struct tally *tally)
{
    struct plan *plan = plan_create(protocol, seed, number);
    struct machine *machine = machine_create(plan, NULL);
    struct observer observer;
    struct machine_view view;
    observer_start(&observer, parameters, seed, number);
    machine_look(machine, &view);
    int64_t started = 0;
    for (int64_t now = 0; view.screen != MACHINE_END && now < INT64_C(3600000000000); now += frame_ns) {
        struct observer_errors errors = {{0, 0}};
        double difference = levels[view.trial_index % 5];
        if (view.trial && view.trial->test_slot != PLAN_SLOT_NONE && view.trial->kind == PROTOCOL_TOGGLE)
            errors.slot[view.trial->test_slot] = difference * parameters->threshold;
        struct machine_event event;
        int64_t at;
        while (observer_next(&observer, now, &view, &errors, &at, &event)) {
            assert_true(at <= now && at > now - frame_ns);
            machine_event(machine, at, &event);
            machine_look(machine, &view);
            tally->digest =
                (tally->digest ^ (uint64_t)at ^ (uint64_t)event.kind << 56 ^ (uint64_t)event.value << 48) *
                UINT64_C(1099511628211); // FNV-1a
        }
        tally->frames += view.screen == MACHINE_STIMULUS && view.fade < 1;
        machine_frame(machine, now, &view);
        struct machine_record record;
        bool stored = false;
        while (machine_next_record(machine, &record)) {
            assert_true(record.kind != MACHINE_CHOICE_EARLY && record.kind != MACHINE_TOGGLE_IGNORED);
            if (record.kind == MACHINE_TRIAL_STARTED)
                started = record.at_ns;
            const struct plan_trial *trial =
                record.trial < plan->trial_count ? &plan->trials[record.trial] : NULL;
            if (record.kind == MACHINE_CHOICE) {
                uint32_t level = record.trial % 5;
                tally->choices++;
                tally->by_level[level]++;
                tally->better[level] += record.slot != trial->test_slot;
                tally->slot_a += record.slot == PLAN_SLOT_A;
                tally->toggles += record.toggles;
                tally->toggle_s += (double)(record.at_ns - started) / 1e9;
            } else if (record.kind == MACHINE_RATING) {
                tally->ratings++;
                tally->rate_s += (double)(record.at_ns - started) / 1e9;
                tally->rating_sum += record.value;
                tally->rating_squares += record.value * record.value;
            }
            stored = stored || record.kind == MACHINE_TRIAL_DONE;
        }
        if (stored)
            machine_event(machine, now, &(struct machine_event){MACHINE_ANSWER_STORED, 0});
    }
    assert_true(view.complete);
    machine_destroy(machine);
    plan_destroy(plan);
}

static void run_asking(const struct observer_parameters *parameters, uint32_t sessions, int64_t frame_ns,
                       enum protocol_correct correct, struct tally *out)
{
    char error[PROTOCOL_ERROR] = "";
    struct protocol *protocol = sample_design("[atrium, town]", SAMPLE_NINE, error, sizeof error);
    assert_string_equal(error, "");
    *out = (struct tally){0};
    for (uint32_t i = 0; i < protocol->question_count; i++)
        protocol->questions[i].correct = correct;
    for (uint32_t i = 0; i < sessions; i++)
        run_session(parameters, protocol, 11, i, frame_ns, out);
    protocol_destroy(protocol);
}

static void run_many(const struct observer_parameters *parameters, uint32_t sessions, int64_t frame_ns,
                     struct tally *out)
{
    run_asking(parameters, sessions, frame_ns, PROTOCOL_NO_CORRECT, out);
}

#define SLOW INT64_C(62500000) // 16 Hz, the demonstration's

static void binomial(uint32_t k, uint32_t n, double p)
{
    // Five standard deviations: one false alarm in a million; the seed is fixed, so it does not come and go.
    assert_true(fabs(k - n * p) <= 5 * sqrt(n * p * (1 - p)) + 1e-9);
}

static void test_it_recovers_its_psychometric_function(void **state)
{
    (void)state;
    struct observer_parameters parameters;
    struct tally tally;
    assert_true(observer_parse("sim:lapse=0.1,slope=1.5,threshold=3", &parameters, NULL, 0));
    run_many(&parameters, 800, SLOW, &tally);
    assert_int_equal(tally.choices, 7200);
    for (int i = 0; i < 5; i++) {
        // The law written out anew: at one threshold three to one, lapses shared between both sides.
        double odds = pow(3, pow(levels[i], 1.5));
        double p = i == 0 ? 0.5 : 0.05 + 0.9 * odds / (1 + odds);
        assert_true(tally.by_level[i] >= 800);
        binomial(tally.better[i], tally.by_level[i], p);
    }
    binomial(tally.slot_a, tally.choices, 0.5); // sides are balanced and there is no bias
}

// "Which one looks worse?" has the tested option as its right answer.
static void test_it_answers_the_question(void **state)
{
    (void)state;
    struct observer_parameters parameters;
    struct tally better, worse;
    observer_defaults(&parameters);
    run_asking(&parameters, 200, SLOW, PROTOCOL_CORRECT_REFERENCE, &better);
    run_asking(&parameters, 200, SLOW, PROTOCOL_CORRECT_TESTED, &worse);
    for (int i = 2; i < 5; i++) {
        assert_true(better.better[i] > 0.6 * better.by_level[i]);
        assert_true(worse.better[i] < 0.4 * worse.by_level[i]);
    }
}

static void test_bias_lapses_and_certainty(void **state)
{
    (void)state;
    struct observer_parameters parameters;
    struct tally tally;
    assert_true(observer_parse("sim:lapse=0,side_bias=1,threshold=1e9", &parameters, NULL, 0));
    struct observer_errors equal = {{0.3, 0.3}}, worse_a = {{4, 1}}, none = {{NAN, 1}};
    assert_true(fabs(observer_probability_a(&parameters, &equal) - 1 / (1 + exp(-1))) < 1e-12);
    observer_defaults(&parameters);
    assert_true(observer_probability_a(&parameters, &equal) == 0.5); // by law, exactly
    assert_true(observer_probability_a(&parameters, &none) == 0.5);
    assert_true(fabs(observer_probability_a(&parameters, &worse_a) - parameters.lapse / 2) < 1e-12);
    parameters.lapse = 0;
    run_many(&parameters, 100, SLOW, &tally);
    binomial(tally.better[4], tally.by_level[4], 81.0 / 82);
}

static void test_times_and_toggles_suit_the_demonstration(void **state)
{
    (void)state;
    struct observer_parameters parameters;
    struct tally tally;
    observer_defaults(&parameters);
    run_many(&parameters, 200, SLOW, &tally);
    double toggles = tally.toggles / tally.choices, seconds = tally.toggle_s / tally.choices,
           rating_s = tally.rate_s / tally.ratings, frames = tally.frames / 200.0;
    print_message("%.2f toggles, %.2f s a decision, %.2f s a rating, %.0f drawn frames a session at 16 Hz\n",
                  toggles, seconds, rating_s, frames);
    assert_true(toggles > 5 && fabs(toggles - 6) < 0.2); // Franke 2021: more than five on average
    assert_true(seconds > 5 && seconds < 8);
    assert_true(rating_s > 4 && rating_s < 7);
    assert_true(frames > 700 && frames < 1400);
}

static void test_ratings_follow_the_latent_normal(void **state)
{
    (void)state;
    struct observer_parameters parameters;
    struct tally tally;
    assert_true(
        observer_parse("sim:rating_mean=5.5,rating_sd=1.2,dwell_s=0.05,toggles_mean=1", &parameters, NULL, 0));
    run_many(&parameters, 600, SLOW, &tally);
    double mean = tally.rating_sum / tally.ratings;
    double sd = sqrt(tally.rating_squares / tally.ratings - mean * mean);
    assert_true(fabs(mean - 5.5) < 5 * 1.2 / sqrt(1200));
    assert_true(fabs(sd - sqrt(1.2 * 1.2 + 1.0 / 12)) < 0.15); // Sheppard's correction: rounding adds 1/12
}

static void test_the_same_session_gives_the_same_events(void **state)
{
    (void)state;
    struct observer_parameters parameters;
    struct tally first, again, other;
    observer_defaults(&parameters);
    run_many(&parameters, 3, SLOW, &first);
    run_many(&parameters, 3, SLOW, &again);
    assert_true(first.digest == again.digest);
    run_many(&parameters, 4, SLOW, &other);
    assert_true(first.digest != other.digest);
    run_many(&parameters, 20, SLOW, &first); // the answers do not hang on the frame rate
    run_many(&parameters, 20, INT64_C(11111111), &again);
    assert_memory_equal(first.better, again.better, sizeof first.better);
    assert_true(first.toggles == again.toggles && first.rating_sum == again.rating_sum);
}

static void bad(const char *spec, const char *sentence)
{
    struct observer_parameters parameters;
    char error[256] = "";
    assert_false(observer_parse(spec, &parameters, error, sizeof error));
    assert_string_equal(error, sentence);
}

static void test_parsing(void **state)
{
    (void)state;
    struct observer_parameters p;
    char error[256] = "";
    assert_true(observer_parse("sim:threshold=0.5,errors=a/b.csv,dwell_s=1", &p, error, sizeof error));
    assert_true(p.threshold == 0.5 && p.dwell_s == 1 && p.slope == 1);
    assert_string_equal(p.errors, "a/b.csv");
    assert_string_equal(error, "");
    bad("person", "observer 'person' is not known; it is sim or sim:name=value,...");
    bad("sim:lapze=0", "observer: parameter 'lapze' is not known; did you mean 'lapse'?");
    bad("sim:qqqqqq=0", "observer: parameter 'qqqqqq' is not known; the help lists them");
    bad("sim:lapse", "observer: 'lapse' has no value; write name=value");
    bad("sim:lapse=", "observer: lapse is a number, not ''");
    bad("sim:lapse=nan", "observer: lapse is a number, not 'nan'");
    bad("sim:lapse=1.5", "observer: lapse is 1.5; it must lie between 0 and 1");
    bad("sim:threshold=0", "observer: threshold is 0; it must lie between 1e-09 and 1e+09");
    bad("sim:lapse=0,", "observer: '' has no value; write name=value");
    bad("sim:errors=", "observer: errors names a file by 1 to 255 characters");
}

static void test_the_code_makes_the_observer(void **state)
{
    (void)state;
    struct observer_parameters parameters;
    struct observer a, b, again;
    observer_defaults(&parameters);
    observer_start(&a, &parameters, 1, observer_subject("S001"));
    observer_start(&b, &parameters, 1, observer_subject("S002"));
    observer_start(&again, &parameters, 1, observer_subject("S001"));
    assert_true(a.key != b.key && a.key == again.key);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_code_makes_the_observer),
        cmocka_unit_test(test_it_recovers_its_psychometric_function),
        cmocka_unit_test(test_it_answers_the_question),
        cmocka_unit_test(test_bias_lapses_and_certainty),
        cmocka_unit_test(test_times_and_toggles_suit_the_demonstration),
        cmocka_unit_test(test_ratings_follow_the_latent_normal),
        cmocka_unit_test(test_the_same_session_gives_the_same_events),
        cmocka_unit_test(test_parsing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
