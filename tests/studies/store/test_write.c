#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct store *begin(const char *path, struct fixture_session *session)
{
    struct store *store = fixture_open(path, STORE_CREATE);
    struct store_error error;
    expect_result(fixture_create(store, "s1", 1, session, &error), STORE_OK, &error);
    return store;
}

static void test_session(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    assert_int_equal(query(path, "SELECT count(*) FROM trial WHERE status = 'planned' AND attempt = 0"), 9);
    assert_int_equal(query(path, "SELECT count(*) FROM condition"), 3);
    char *text =
        query_text(path, "SELECT group_concat(id || ':' || option_a || '/' || option_b || test_slot, ' ') "
                         "FROM (SELECT * FROM trial ORDER BY ordinal LIMIT 4)");
    assert_string_equal(text, "1:2/1a 2:1/2b 3:3/1a 4:1/3b\n");
    free(text);
    for (int i = 0; i < FIXTURE_TRIALS; i++)
        assert_int_equal(session.trial_ids[i], i + 1);
    assert_int_equal(query(path, "SELECT seed FROM trial WHERE id = 1"), -1); // UINT64_MAX, the same bits
    text = query_text(path, "SELECT status || started_at || refresh_hz || width_px || settings FROM session");
    assert_string_equal(text, "running2026-01-02T03:04:05Z90.0640{}\n");
    free(text);
    assert_int_equal(query(path, "SELECT count(*) FROM session WHERE consent_at IS NULL AND device IS NULL"),
                     1);
    struct store_error error;
    expect_result(store_set_consent(store, 1, "2026-01-02T03:04:06Z", "v2", &error), STORE_OK, &error);
    expect_result(store_set_consent(store, 1, "2026-01-02T03:04:06Z", NULL, &error), STORE_REFUSED, &error);
    expect_result(store_set_consent(store, 9, "2026-01-02T03:04:06Z", "v2", &error), STORE_REFUSED, &error);
    expect_result(store_end_session(store, 1, "finished", "2026-01-02T04:00:00Z", 99, &error), STORE_REFUSED,
                  &error);
    expect_result(store_end_session(store, 1, "complete", "2026-01-02T04:00:00Z", 99, &error), STORE_OK,
                  &error);
    expect_result(store_end_session(store, 1, "aborted", "2026-01-02T04:00:00Z", 99, &error), STORE_REFUSED,
                  &error);
    expect_sentence(&error, "session 1 is not running");
    fixture_close(store);
    expect_sound(path);
}

static void test_participants(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_error error;
    int64_t number = 0;
    expect_result(store_participant_number(store, "s1", 0, &number, &error), STORE_OK, &error);
    assert_int_equal(number, 1); // the one it has
    expect_result(store_participant_number(store, "s1", 2, &number, &error), STORE_REFUSED, &error);
    expect_result(store_participant_number(store, "new", 1, &number, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "number 1 is taken");
    expect_result(store_participant_number(store, "new", -1, &number, &error), STORE_REFUSED, &error);
    expect_result(store_participant_number(store, "new", 3, &number, &error), STORE_OK, &error);
    expect_result(fixture_create(store, "s3", 3, &session, &error), STORE_OK, &error);
    expect_result(store_participant_number(store, "new", 0, &number, &error), STORE_OK, &error);
    assert_int_equal(number, 2); // the gap
    expect_result(fixture_create(store, "s2", 2, &session, &error), STORE_OK, &error);
    expect_result(store_participant_number(store, "new", 0, &number, &error), STORE_OK, &error);
    assert_int_equal(number, 4);
    // One code, one session, one number.
    expect_result(fixture_create(store, "s2", 2, &session, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "has a session already");
    expect_result(fixture_create(store, "s2", 5, &session, &error), STORE_REFUSED, &error);
    expect_result(fixture_create(store, "s5", 2, &session, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "number is taken");
    // Unless another session is wanted, which uses the same participant, protocol and conditions.
    struct fixture_parts parts;
    struct store_session again = fixture_session(&parts, "s2", 2);
    again.again = true;
    struct store_session_ids ids = {0};
    expect_result(store_create_session(store, &again, &ids, &error), STORE_OK, &error);
    assert_int_equal(query(path, "SELECT count(*) FROM session"), 4);
    assert_int_equal(query(path, "SELECT count(*) FROM participant"), 3);
    assert_int_equal(query(path, "SELECT count(*) * 10 + (SELECT count(*) FROM condition) FROM protocol"), 13);
    // A person who is excluded as a whole frees the number.
    struct store_exclusion exclusion = {.participant_id = 1,
                                        .rule = "withdrawn",
                                        .rule_set = "planned",
                                        .reason = "asked to",
                                        .by = "experimenter",
                                        .applied_at = "2026-01-03T00:00:00Z"};
    int64_t id = 0;
    expect_result(store_add_exclusion(store, &exclusion, &id, &error), STORE_OK, &error);
    expect_result(store_participant_number(store, "new", 0, &number, &error), STORE_OK, &error);
    assert_int_equal(number, 1);
    expect_result(fixture_create(store, "new", 1, &session, &error), STORE_OK, &error);
    exclusion.trial_id = 1; // two things at once
    expect_result(store_add_exclusion(store, &exclusion, &id, &error), STORE_REFUSED, &error);
    fixture_close(store);
    expect_sound(path);
}

static void test_one_kind_one_seed(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_error error;
    struct fixture_parts parts;
    struct store_session desc = fixture_session(&parts, "p1", 2);
    struct store_session_ids ids = {0};
    desc.participant.kind = "person";
    expect_result(store_create_session(store, &desc, &ids, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "simulated observers and people never share a study file");
    assert_non_null(strstr(error.text, path));
    desc.participant.code = "s1";
    desc.participant.number = 1;
    expect_result(store_create_session(store, &desc, &ids, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "never share");
    desc = fixture_session(&parts, "s2", 2);
    desc.seed = UINT64_MAX;
    expect_result(store_create_session(store, &desc, &ids, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "have the seed 7, not 18446744073709551615");
    // Nothing of the refused ones was written.
    assert_int_equal(query(path, "SELECT count(*) FROM participant"), 1);
    assert_int_equal(query(path, "SELECT count(*) FROM session"), 1);
    assert_int_equal(query(path, "SELECT count(*) FROM trial"), 9);
    fixture_close(store);
}

static void test_whole_session_or_none(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct store *store = fixture_open(path, STORE_CREATE);
    struct store_error error;
    struct fixture_parts parts;
    struct store_session_ids ids = {0};
    for (int fault = 0; fault < 9; fault++) {
        struct store_session desc = fixture_session(&parts, "s1", 1);
        switch (fault) {
        case 0:
            parts.trials[8].kind = "guess";
            break;
        case 1:
            parts.trials[8].option_b = FIXTURE_CONDITIONS;
            break;
        case 2:
            parts.trials[8].option_a = -2;
            break;
        case 3:
            parts.trials[8].ordinal = 1;
            break;
        case 4:
            parts.trials[8].settings = "{not json";
            break;
        case 5:
            parts.trials[8].test_slot = STORE_EQUAL;
            break;
        case 6:
            desc.segment.clock = "sundial";
            break;
        case 7:
            desc.protocol.sha256 = "0123456789ABCDEF0123456789abcdef0123456789abcdef0123456789abcdef";
            break;
        case 8:
            parts.conditions[2].parameters = NULL;
            break;
        }
        expect_result(store_create_session(store, &desc, &ids, &error), STORE_REFUSED, &error);
        assert_int_equal(query(path,
                               "SELECT (SELECT count(*) FROM session) + (SELECT count(*) FROM participant) + "
                               "(SELECT count(*) FROM trial) + (SELECT count(*) FROM condition) + "
                               "(SELECT count(*) FROM protocol)"),
                         0);
    }
    struct fixture_session session;
    expect_result(fixture_create(store, "s1", 1, &session, &error), STORE_OK, &error);
    fixture_close(store);
}

static void test_trials(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_error error;
    int64_t attempt = 0, segment = session.ids.segment_id;
    expect_result(store_start_trial(store, 1, segment, 50, &attempt, &error), STORE_OK, &error);
    assert_int_equal(attempt, 1);
    // Interrupted, and again in its own row in another segment.
    struct store_segment next = {"2026-01-02T04:00:00Z", 77, "monotonic", "boot", "0.1.0", "resume"};
    expect_result(store_add_segment(store, session.ids.session_id, &next, &segment, &error), STORE_OK, &error);
    expect_result(store_start_trial(store, 1, segment, 20, &attempt, &error), STORE_OK, &error);
    assert_int_equal(attempt, 2);
    expect_result(store_end_trial(store, 1, "done", 90, &error), STORE_OK, &error);
    char *text =
        query_text(path, "SELECT status || started_ns || '-' || ended_ns || '/' || segment_id FROM trial "
                         "WHERE id = 1");
    assert_string_equal(text, "done20-90/2\n");
    free(text);
    expect_result(store_start_trial(store, 1, segment, 95, &attempt, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "trial 1 is neither planned nor running");
    expect_result(store_end_trial(store, 2, "finished", 90, &error), STORE_REFUSED, &error);
    expect_result(store_end_trial(store, 99, "done", 90, &error), STORE_REFUSED, &error);
    // Flagged as bad: a new row after the plan.
    expect_result(store_end_trial(store, 1, "invalid", 90, &error), STORE_OK, &error);
    struct store_trial repeat = {
        .ordinal = 10, .block = "main", .kind = "toggle", .scene = "town", .repeat_of = 1};
    int64_t id = 0;
    expect_result(store_add_trial(store, session.ids.session_id, &repeat, 2, 1, &id, &error), STORE_OK, &error);
    assert_int_equal(query(path, "SELECT repeat_of FROM trial WHERE ordinal = 10 AND option_a = 2"), 1);
    repeat.ordinal = 11;
    expect_result(store_add_trial(store, session.ids.session_id, &repeat, 2, 99, &id, &error), STORE_REFUSED,
                  &error);
    expect_sentence(&error, "FOREIGN KEY");
    fixture_close(store);
}

static void test_answers(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_error error;
    int64_t id = 0;
    struct store_choice choice = fixture_choice(&session, 0);
    struct store_staircase_step step = {.level = 0.5, .outcome = 1, .reversal = true, .estimate = NAN};
    choice.step = &step;
    choice.correct = STORE_WRONG;
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    assert_int_equal(query(path, "SELECT id FROM choice WHERE trial_id = 1 AND chosen = 'a' AND correct = 0"),
                     id);
    assert_int_equal(query(path, "SELECT ended_ns FROM trial WHERE id = 1 AND status = 'done'"), 9000000000);
    assert_int_equal(query(path, "SELECT count(*) FROM staircase_step WHERE trial_id = 1 AND reversal = 1 "
                                 "AND estimate IS NULL"),
                     1);
    // An acknowledged answer stays.
    choice.chosen = STORE_B;
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_REFUSED, &error);
    assert_int_equal(query(path, "SELECT count(*) FROM choice WHERE chosen = 'a'"), 1);
    assert_int_equal(query(path, "SELECT count(*) FROM staircase_step"), 1);
    choice = fixture_choice(&session, 1);
    choice.chosen = STORE_EQUAL;
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    assert_int_equal(query(path, "SELECT count(*) FROM choice WHERE chosen = 'equal' AND correct IS NULL"), 1);

    struct store_rating rating = {.session_id = session.ids.session_id,
                                  .segment_id = session.ids.segment_id,
                                  .question = "quality",
                                  .subject = "scene",
                                  .condition_id = 1,
                                  .value = 7,
                                  .scale_min = 1,
                                  .scale_max = 10,
                                  .answered_ns = 5};
    expect_result(store_answer_rating(store, &rating, &id, &error), STORE_OK, &error);
    expect_result(store_answer_rating(store, &rating, &id, &error), STORE_OK,
                  &error); // before and after the block
    rating.trial_id = 3;   // of both
    expect_result(store_answer_rating(store, &rating, &id, &error), STORE_REFUSED, &error);
    rating.session_id = 0;
    rating.ends_trial = true;
    expect_result(store_answer_rating(store, &rating, &id, &error), STORE_OK, &error);
    assert_int_equal(query(path, "SELECT count(*) FROM trial WHERE id = 3 AND status = 'done'"), 1);
    expect_result(store_answer_rating(store, &rating, &id, &error), STORE_REFUSED, &error);

    struct store_response response = {.trial_id = 4,
                                      .segment_id = session.ids.segment_id,
                                      .question = "spheres",
                                      .value = 12,
                                      .expected = NAN,
                                      .answered_ns = 6,
                                      .ends_trial = true};
    expect_result(store_answer_responses(store, &response, 1, &id, &error), STORE_OK, &error);
    expect_result(store_answer_responses(store, &response, 1, &id, &error), STORE_REFUSED, &error);
    assert_int_equal(query(path, "SELECT count(*) FROM response WHERE expected IS NULL AND device IS NULL"), 1);
    assert_int_equal(query(path, "SELECT count(*) FROM trial WHERE status = 'done'"), 4);
    fixture_close(store);
    expect_sound(path);
}

static void test_answers_refused(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_error error;
    int64_t id = 0;
    for (int fault = 0; fault < 8; fault++) {
        struct store_choice choice = fixture_choice(&session, 0);
        switch (fault) {
        case 0:
            choice.trial_id = 99;
            break;
        case 1:
            choice.trial_id = 0;
            break;
        case 2:
            choice.segment_id = 99;
            break;
        case 3:
            choice.chosen = STORE_NO_SLOT;
            break;
        case 4:
            choice.chosen = (enum store_slot)17;
            break;
        case 5:
            choice.toggles = -1;
            break;
        case 6:
            choice.answered_ns = STORE_UNKNOWN;
            break;
        case 7:
            choice.reaction_ns = -5;
            break;
        }
        expect_result(store_answer_choice(store, &choice, &id, &error), STORE_REFUSED, &error);
    }
    for (int fault = 0; fault < 6; fault++) {
        struct store_rating rating = {.trial_id = 1,
                                      .segment_id = 1,
                                      .question = "q",
                                      .subject = "a",
                                      .value = 3,
                                      .scale_min = -3,
                                      .scale_max = 3,
                                      .answered_ns = 5};
        switch (fault) {
        case 0:
            rating.value = 3.5;
            break;
        case 1:
            rating.value = NAN;
            break;
        case 2:
            rating.subject = "c";
            break;
        case 3:
            rating.scale_min = 3;
            break;
        case 4:
            rating.question = NULL;
            break;
        case 5:
            rating.condition_id = 99;
            break;
        }
        expect_result(store_answer_rating(store, &rating, &id, &error), STORE_REFUSED, &error);
    }
    assert_int_equal(query(path, "SELECT (SELECT count(*) FROM choice) + (SELECT count(*) FROM rating)"), 0);
    assert_int_equal(query(path, "SELECT count(*) FROM trial WHERE status <> 'planned'"), 0);
    // A refusal leaves the store usable.
    struct store_choice choice = fixture_choice(&session, 0);
    expect_result(store_answer_choice(store, &choice, &id, &error), STORE_OK, &error);
    fixture_close(store);
}

static void test_measured_error(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_error error;
    struct store_error_key key = {2, 1, "town", "mse"};
    double value = 0;
    expect_result(store_get_measured_error(store, &key, &value, &error), STORE_OK, &error);
    assert_true(isnan(value));
    expect_result(store_set_measured_error(store, &key, 0.1, &error), STORE_OK, &error);
    expect_result(store_set_measured_error(store, &key, 0.3, &error), STORE_OK, &error);
    expect_result(store_get_measured_error(store, &key, &value, &error), STORE_OK, &error);
    assert_true(value == 0.3);
    key.scene = "atrium";
    expect_result(store_get_measured_error(store, &key, &value, &error), STORE_OK, &error);
    assert_true(isnan(value));
    key.reference_id = 99;
    expect_result(store_set_measured_error(store, &key, 0.3, &error), STORE_REFUSED, &error);
    key.reference_id = 1;
    expect_result(store_set_measured_error(store, &key, NAN, &error), STORE_REFUSED, &error);
    assert_int_equal(query(path, "SELECT count(*) FROM measured_error"), 1);
    fixture_close(store);
    // A reader sees it too, and cannot write.
    store = fixture_open(path, STORE_READ);
    key.scene = "town";
    expect_result(store_get_measured_error(store, &key, &value, &error), STORE_OK, &error);
    assert_true(value == 0.3);
    expect_result(store_set_measured_error(store, &key, 0.3, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "for reading only");
    assert_int_equal(store_push_gaze(store, &(struct store_gaze){0}), 0);
    fixture_close(store);
}

static void test_gaze_check_and_steps(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct fixture_session session;
    struct store *store = begin(path, &session);
    struct store_error error;
    struct store_gaze_check check = {.session_id = 1,
                                     .segment_id = 1,
                                     .at_ns = 4,
                                     .block = "main",
                                     .x_deg = -10,
                                     .y_deg = 5,
                                     .eye = GAZE_LEFT,
                                     .accuracy_deg = NAN,
                                     .rms_s2s_deg = NAN,
                                     .sd_deg = NAN,
                                     .loss = 1};
    int64_t id = 0;
    expect_result(store_add_gaze_check(store, &check, &id, &error), STORE_OK, &error);
    check.loss = 1.5;
    expect_result(store_add_gaze_check(store, &check, &id, &error), STORE_REFUSED, &error);
    struct store_staircase_step step = {.level = 0.5, .outcome = -1};
    expect_result(store_add_staircase_step(store, 1, &step, &id, &error), STORE_REFUSED, &error);
    step.outcome = 0;
    expect_result(store_add_staircase_step(store, 1, &step, &id, &error), STORE_OK, &error);
    struct store_event event = {
        .session_id = 1, .segment_id = 1, .at_ns = 3, .kind = "note", .detail = "it's \"ok\"; DROP"};
    expect_result(store_add_event(store, &event, &id, &error), STORE_OK, &error);
    char *text = query_text(path, "SELECT detail FROM event");
    assert_string_equal(text, "it's \"ok\"; DROP\n");
    free(text);
    struct store_condition condition = {"regular", "{}"};
    expect_result(store_add_condition(store, &condition, &id, &error), STORE_OK, &error);
    assert_int_equal(id, 1);
    condition.mode = "vrs";
    expect_result(store_add_condition(store, &condition, &id, &error), STORE_OK, &error);
    assert_int_equal(id, 4);
    fixture_close(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_session, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_participants, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_one_kind_one_seed, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_whole_session_or_none, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_trials, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_answers, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_answers_refused, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_measured_error, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_gaze_check_and_steps, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store write", tests, NULL, NULL);
}
