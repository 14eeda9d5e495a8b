// What exclusion rules ask of a study file, against numbers worked out by hand, and in time linear in the rows.
#include "fixture.h"

#include "studies/store/exclusions.h"
#include "studies/store/facts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MS = 1000000, ROWS = 8 };

struct taken {
    struct store_fact_row rows[ROWS];
    size_t count, kept;
};

static bool take(void *user, const struct store_fact_row *row)
{
    struct taken *taken = user;
    if (taken->kept < ROWS)
        taken->rows[taken->kept++] = *row;
    taken->count++;
    return true;
}

static struct taken read_facts(const char *path, int64_t participant, int64_t protocol)
{
    char error[512];
    struct taken taken = {.count = 0};
    struct store_reader *reader = store_reader_open(path, error, sizeof error);
    if (!reader)
        fail_msg("%s", error);
    if (!store_read_facts(reader, participant, protocol, take, &taken))
        fail_msg("%s", store_reader_error(reader));
    store_reader_close(reader);
    return taken;
}

static void gaze(struct store *store, const struct fixture_session *session, int trial, int64_t at_ms,
                 bool valid)
{
    struct store_gaze row = fixture_gaze(session, at_ms);
    row.trial_id = session->trial_ids[trial];
    row.sample.host_ns = at_ms * MS;
    row.sample.valid = valid;
    if (!valid)
        row.sample.x_deg = row.sample.y_deg = NAN;
    store_push_gaze(store, &row);
}

static void exposure(struct store *store, const struct fixture_session *session, int trial, int64_t attempt,
                     enum store_slot slot, int64_t from, int64_t full_from, int64_t full_to, int64_t to)
{
    store_push_exposure(store, &(struct store_exposure){.trial_id = session->trial_ids[trial],
                                                        .segment_id = session->ids.segment_id,
                                                        .attempt = attempt,
                                                        .option = slot,
                                                        .start_ns = from * MS,
                                                        .end_ns = to * MS,
                                                        .full_start_ns = full_from * MS,
                                                        .full_end_ns = full_to * MS});
}

// An attempt that was broken off and one that was answered: a, gray, b, a pause of five seconds, a again.
static void fill_trial(struct store *store, const struct fixture_session *session)
{
    struct store_error error;
    int64_t attempt = 0;
    expect_result(store_start_trial(store, session->trial_ids[0], session->ids.segment_id, 0, &attempt, &error),
                  STORE_OK, &error);
    exposure(store, session, 0, 1, STORE_A, 0, 100, 900, 1000);
    for (int64_t t = 0; t < 1000; t += 10)
        gaze(store, session, 0, t, false); // all of it lost: must not count
    expect_result(
        store_start_trial(store, session->trial_ids[0], session->ids.segment_id, 2000 * MS, &attempt, &error),
        STORE_OK, &error);
    exposure(store, session, 0, 2, STORE_A, 2000, 2100, 3100, 3200);
    exposure(store, session, 0, 2, STORE_B, 3450, 3550, 3950, 4050);
    exposure(store, session, 0, 2, STORE_A, 9000, 9100, 9600, 9700);
    for (int64_t t = 2000; t < 9800;
         t += 10) // 300 ms without a direction across the gray; the pause does not count
        gaze(store, session, 0, t, !(t > 3300 && t < 3600) && !(t > 4050 && t < 9000));
    for (int i = 0; i < 100; i++) {
        struct store_frame frame = fixture_frame(session, (uint64_t)i, 0);
        frame.attempt = i < 20 ? 1 : 2;
        frame.phase = i % 2 ? STORE_STIMULUS : STORE_FADE;
        frame.late = i >= 90;
        frame.fovea_source = i < 25 ? STORE_FOVEA_FIXED : i < 28 ? STORE_FOVEA_LOST : STORE_FOVEA_GAZE;
        frame.condition_id = session->condition_ids[i % 3 == 0 ? 0 : 1];
        store_push_frame(store, &frame);
    }
    struct store_choice choice = fixture_choice(session, 0);
    choice.reaction_ns = 7500 * (int64_t)MS;
    int64_t id = 0;
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
}

static void test_facts_are_those_of_the_answered_attempt(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store_error error;
    struct store *store = fixture_open(path, STORE_CREATE);
    expect_result(fixture_create(store, "p1", 1, &session, &error), STORE_OK, &error);
    fill_trial(store, &session);
    fixture_close(store);
    outsider(path, "UPDATE session SET settings = json_set(settings, '$.gaze', 'hid')");

    struct taken taken = read_facts(path, 1, 1);
    assert_int_equal(taken.count, 1); // the others have no answer
    const struct store_fact_row *row = &taken.rows[0];
    assert_float_equal(row->seen_s[0], 1.5, 1e-9);
    assert_float_equal(row->seen_s[1], 0.4, 1e-9);
    assert_int_equal(row->gaze_samples, 206 + 71); // 2000 to 4050 and 9000 to 9700 every 10 ms
    assert_int_equal(row->gaze_lost, 29);
    assert_float_equal(row->gaze_gap_ms, 300, 1e-9);
    assert_int_equal(row->stimulus_frames, 40);
    assert_int_equal(row->late_frames, 5);
    assert_int_equal(row->rendered_frames, 80);
    // 20 to 27 of the second attempt, of the foveated option: not those that 3 divides
    bool first_is_regular = query(path, "SELECT mode = 'regular' FROM condition WHERE id = 1");
    assert_true(first_is_regular);
    assert_int_equal(row->fallback_frames, 5);
    assert_float_equal(row->reaction_s, 7.5, 1e-9);
    assert_false(row->caught);

    outsider(path, "UPDATE session SET settings = json_set(settings, '$.gaze', 'none')");
    taken = read_facts(path, 1, 1);
    assert_true(isnan(taken.rows[0].gaze_gap_ms)); // no tracker, nothing to miss
    assert_int_equal(taken.rows[0].gaze_samples, 0);
    outsider(path, "UPDATE trial SET settings = json_set(settings, '$.foveate', 'target')");
    assert_int_equal(read_facts(path, 1, 1).rows[0].fallback_frames, 0);
    outsider(path, "UPDATE trial SET kind = 'practice'");
    assert_int_equal(read_facts(path, 1, 1).count, 0);
}

static void test_catch_trials(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store_error error;
    struct store *store = fixture_open(path, STORE_CREATE);
    expect_result(fixture_create(store, "p1", 1, &session, &error), STORE_OK, &error);
    fill_trial(store, &session);
    fixture_close(store);
    outsider(path, "UPDATE trial SET kind = 'catch', test_slot = 'a'");
    static const struct {
        const char *sql;
        bool missed;
    } cases[] = {{"UPDATE choice SET chosen = 'a'", true}, // the obviously different one, taken for the better
                 {"UPDATE choice SET chosen = 'equal'", true},
                 {"UPDATE choice SET chosen = 'b'", false},
                 {"UPDATE choice SET correct = 0", true}, // the question's own right answer goes before
                 {"UPDATE choice SET correct = 1, chosen = 'a'", false}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_int_equal(outsider(path, cases[i].sql), 0);
        struct taken taken = read_facts(path, 1, 1);
        assert_true(taken.rows[0].caught);
        assert_int_equal(taken.rows[0].missed, cases[i].missed);
    }
    // Without a test slot nothing tells which option was the right one; equal they are not.
    assert_int_equal(outsider(path, "UPDATE trial SET test_slot = NULL; UPDATE choice SET correct = NULL"), 0);
    assert_false(read_facts(path, 1, 1).rows[0].caught);
    assert_int_equal(outsider(path, "UPDATE choice SET chosen = 'equal'"), 0);
    struct taken taken = read_facts(path, 1, 1);
    assert_true(taken.rows[0].caught && taken.rows[0].missed);
}

static void test_twice_changes_nothing(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store_error error;
    struct store *store = fixture_open(path, STORE_CREATE);
    expect_result(fixture_create(store, "p1", 1, &session, &error), STORE_OK, &error);
    struct store_exclusion rows[] = {{.trial_id = 1,
                                      .rule = "gaze_loss",
                                      .rule_set = "planned",
                                      .reason = "r",
                                      .by = "b",
                                      .applied_at = "t"},
                                     {.trial_id = 1,
                                      .rule = "gaze_loss",
                                      .rule_set = "stricter",
                                      .reason = "r",
                                      .by = "b",
                                      .applied_at = "t"},
                                     {.trial_id = 2,
                                      .rule = "gaze_loss",
                                      .rule_set = "stricter",
                                      .reason = "r",
                                      .by = "b",
                                      .applied_at = "t"},
                                     {.participant_id = 1,
                                      .rule = "failed_catch",
                                      .rule_set = "planned",
                                      .reason = "r",
                                      .by = "b",
                                      .applied_at = "t"}};
    struct store_event event = {.session_id = session.ids.session_id,
                                .segment_id = session.ids.segment_id,
                                .kind = "rules_applied",
                                .detail = "{\"protocol\":\"x\"}"};
    size_t added = 9;
    expect_result(store_apply_exclusions(store, rows, 4, &event, 1, &added, &error), STORE_OK, &error);
    assert_int_equal(added, 3); // the stricter rule takes nothing out that a planned one has
    expect_result(store_apply_exclusions(store, rows, 4, &event, 1, &added, &error), STORE_OK, &error);
    assert_int_equal(added, 0);
    rows[2].reason = NULL; // all or nothing
    rows[0].trial_id = 5;
    expect_result(store_apply_exclusions(store, rows, 3, &event, 1, &added, &error), STORE_OK, &error);
    assert_int_equal(added, 1); // what is out already is not looked at again
    rows[1].trial_id = 7;
    rows[2].trial_id = 8;
    expect_result(store_apply_exclusions(store, rows, 3, &event, 1, &added, &error), STORE_REFUSED, &error);
    assert_int_equal(added, 0);
    fixture_close(store);
    assert_int_equal(query(path, "SELECT count(*) FROM exclusion"), 4);
    assert_int_equal(query(path, "SELECT count(*) FROM event WHERE kind = 'rules_applied'"), 3);
}

// A stricter rule is for a table of the report: the person is analysed, and the number is taken.
static void test_stricter_rules_free_no_number(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store_error error;
    int64_t number = 0;
    size_t added = 0;
    struct store *store = fixture_open(path, STORE_CREATE);
    struct store_exclusion row = {.participant_id = 1,
                                  .rule = "gaze_loss",
                                  .rule_set = "stricter",
                                  .reason = "r",
                                  .by = "b",
                                  .applied_at = "t"};
    expect_result(fixture_create(store, "p1", 1, &session, &error), STORE_OK, &error);
    expect_result(store_apply_exclusions(store, &row, 1, NULL, 0, &added, &error), STORE_OK, &error);
    expect_result(store_participant_number(store, "p2", 0, &number, &error), STORE_OK, &error);
    assert_int_equal(number, 2);
    row.rule_set = "late";
    expect_result(store_apply_exclusions(store, &row, 1, NULL, 0, &added, &error), STORE_OK, &error);
    expect_result(store_participant_number(store, "p2", 0, &number, &error), STORE_OK, &error);
    assert_int_equal(number, 1);
    expect_result(fixture_create(store, "p2", 1, &session, &error), STORE_OK, &error);
    fixture_close(store);
}

// People of 96 trials of eight seconds, gaze at 250 Hz in two alternating eyes' rows, frames at 90 Hz.
// FACTS_PEOPLE=52 is the size of a whole study: 10^7 rows of gaze.
static double seconds_for(const char *path, int people)
{
    struct timespec from, to;
    static const char fill[] = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < %d)";
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    fprintf(out, "BEGIN;");
    fprintf(out, fill, people);
    fprintf(
        out,
        " INSERT INTO participant SELECT i + 1, i + 1, 'q' || i, (SELECT kind FROM participant), '{}' FROM n;");
    fprintf(out, fill, people);
    fprintf(
        out,
        " INSERT INTO session SELECT i + 1, 1, i + 1, seed, 'complete', 't', 't', NULL, NULL, NULL, NULL, NULL,"
        " 90, 640, 720, 100, '{\"gaze\":\"hid\"}' FROM n, session WHERE session.id = 1;");
    fprintf(out, fill, people);
    fprintf(out, " INSERT INTO segment SELECT i + 1, i + 1, 't', 0, 'monotonic', NULL, '0', 'start' FROM n;");
    fprintf(out, fill, people * 96);
    fprintf(
        out,
        " INSERT INTO trial SELECT 1000 + i, (i - 1) / 96 + 2, (i - 1) / 96 + 2, (i - 1) %% 96 + 1, 'main', "
        "'toggle',"
        " 'atrium', '{\"foveate\":\"gaze\"}', '{}', 1, 2, 'a', 'a', NULL, 1, NULL, 'done', 1, i * 10000000000,"
        " i * 10000000000 + 8000000000 FROM n;");
    fprintf(out, fill, people * 96);
    fprintf(out,
            " INSERT INTO choice SELECT NULL, 1000 + i, (i - 1) / 96 + 2, 'a', NULL, 8000000000, 0, 3 FROM n;");
    fprintf(out, fill, people * 96);
    fprintf(out, " INSERT INTO exposure SELECT NULL, 1000 + i, (i - 1) / 96 + 2, 1, 'a', i * 10000000000,"
                 " i * 10000000000 + 8000000000, i * 10000000000, i * 10000000000 + 8000000000 FROM n;");
    fprintf(out, fill, people * 96 * 2000);
    fprintf(
        out,
        " INSERT INTO gaze SELECT NULL, (i - 1) / 192000 + 2, (i - 1) / 192000 + 2, 1001 + (i - 1) / 2000, i,"
        " (1 + (i - 1) / 2000) * 10000000000 + (i - 1) %% 2000 * 4000000, 'both', 1, 1, 3.5, i %% 50 > 0, 1 "
        "FROM n;");
    fprintf(out, fill, people * 96 * 720);
    fprintf(
        out,
        " INSERT INTO frame (session_id, segment_id, trial_id, attempt, number, option, condition_id, phase,"
        " fade_level, start_ns, present_estimated, late, fovea, fovea_source) SELECT (i - 1) / 69120 + 2,"
        " (i - 1) / 69120 + 2, 1001 + (i - 1) / 720, 1, i, 'a', 2, 'stimulus', 0, i, 1, 0,"
        " '{\"left\":[1.5,2.5],\"right\":[1.5,2.5]}', 'gaze' FROM n; COMMIT");
    fclose(out);
    assert_int_equal(outsider(path, text), 0);
    free(text);

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
    for (int person = 2; person <= people + 1; person++) {
        struct taken taken = read_facts(path, person, 1);
        assert_int_equal(taken.count, 96);
        assert_int_equal(taken.rows[5].gaze_samples, 2000);
        assert_int_equal(taken.rows[5].gaze_lost, 40);
        assert_int_equal(taken.rows[5].stimulus_frames, 720);
    }
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
    return (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
}

static void test_a_whole_study_takes_seconds(void **state)
{
    const char *path = ((struct fixture *)*state)->path, *wanted = getenv("FACTS_PEOPLE");
    struct fixture_session session;
    struct store_error error;
    int people = wanted ? atoi(wanted) : 2;
    struct store *store = fixture_open(path, STORE_CREATE);
    expect_result(fixture_create(store, "p1", 1, &session, &error), STORE_OK, &error);
    fixture_close(store);
    double took = seconds_for(path, people);
    print_message("%d people, %d rows of gaze, %d frames: %.2f s of processor time\n", people, people * 192000,
                  people * 69120, took);
    // 20 s of processor time for the 52 people of a whole study.
    assert_true(INSTRUMENTED || took < 1 + 20.0 * people / 52);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_facts_are_those_of_the_answered_attempt, fixture_setup,
                                        fixture_teardown),
        cmocka_unit_test_setup_teardown(test_catch_trials, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_twice_changes_nothing, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_stricter_rules_free_no_number, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_a_whole_study_takes_seconds, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("store facts", tests, NULL, NULL);
}
