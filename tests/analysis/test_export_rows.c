// fovstats export: `excluded` means the same in every table and leaves what the tools count; rows of
// interrupted attempts are told apart; everything that happened and every measured error is there.
#include "program.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";
static const char excluded[] = SOURCE_DIR "/tests/analysis/export_excluded.py";

#define RUN(...) program_run((const char *const[]){__VA_ARGS__, NULL}, NULL)
#define SHELL(text) RUN("/bin/sh", "-c", text)

static void expect_done(struct program_result r)
{
    if (r.code != 0)
        fail_msg("exit %d: %s%s", r.code, r.out, r.err);
    program_free(&r);
}

static void expect_prints(const char *command, const char *out)
{
    struct program_result r = SHELL(command);
    if (r.code != 0 || strcmp(r.out, out) != 0)
        fail_msg("%s: exit %d: %s%s", command, r.code, r.out, r.err);
    program_free(&r);
}

// Cells of the rows of a Psych-DS table that are of one trial, by column names.
static void expect_cells(const char *folder, const char *table, const char *trial, const char *columns,
                         const char *out)
{
    static const char script[] =
        "import csv, glob, sys; r = "
        "csv.DictReader(open(glob.glob(f'{sys.argv[1]}/data/*-{sys.argv[2]}_data.csv')"
        "[0], newline='')); print(*(','.join(row[c] for c in sys.argv[4].split()) for row in r if "
        "row['trial_id'] == sys.argv[3]))";
    struct program_result r = RUN("/usr/bin/env", "python3", "-c", script, folder, table, trial, columns);
    size_t size = strlen(out);
    if (r.code != 0 || strncmp(r.out, out, size) != 0 || strcmp(r.out + size, "\n") != 0)
        fail_msg("%s, trial %s: %s%s, not %s", table, trial, r.out, r.err, out);
    program_free(&r);
}

// The study of study_file.h with person 22 out as planned and person 1 by a stricter rule, and further:
// - a rule on rating pairs names trials 31 (a choice, with a rating of its own), 33 and 34 (person 3's pair)
// - trial 41 is out by a late rule and by a stricter one
// - trials 31, 41, 51 and 221 have a row in every table; person 5 rated the whole session
static const char more[] =
    "INSERT INTO exclusion VALUES(NULL, 31, NULL, NULL, 'gaze_loss:rating_pair', 'planned', 'r', 'f', '2026'),"
    "(NULL, 33, NULL, NULL, 'gaze_loss:rating_pair', 'planned', 'r', 'f', '2026'),"
    "(NULL, 34, NULL, NULL, 'gaze_loss:rating_pair', 'planned', 'its pair', 'f', '2026'),"
    "(NULL, 41, NULL, NULL, 'reaction', 'late', 'r', 'f', '2026'),"
    "(NULL, 41, NULL, NULL, 'toggles', 'stricter', 'r', 'f', '2026');"
    "CREATE TEMP TABLE some AS SELECT id, session_id, segment_id FROM trial WHERE id IN (31, 41, 51, 221);"
    "INSERT INTO rating SELECT NULL, id, NULL, segment_id, 'Sure?', 'scene', NULL, 4, 1, 5, 9 FROM some;"
    "INSERT INTO rating VALUES(NULL, NULL, 5, 5, 'Sick?', 'scene', NULL, 1, 1, 5, 9),"
    "(NULL, NULL, 22, 22, 'Sick?', 'scene', NULL, 1, 1, 5, 9);"
    "INSERT INTO response SELECT NULL, id, segment_id, 'count', 5, 6, 9, 'keyboard' FROM some;"
    "INSERT INTO adjust_step SELECT NULL, id, segment_id, 9, 'epsilon', 0.5 FROM some;"
    "INSERT INTO staircase_step SELECT NULL, id, 2, 1, 0, NULL FROM some;"
    "INSERT INTO exposure SELECT NULL, id, segment_id, 1, 'a', 0, 9, 1, 8 FROM some;"
    "INSERT INTO event SELECT NULL, session_id, segment_id, id, 9, 'toggle', '{\"slot\":\"b\"}' FROM some;"
    "INSERT INTO event VALUES(NULL, 22, 22, NULL, 9, 'note', 'tired, \"very\"'), (NULL, 5, 5, NULL, 9, 'note', "
    "NULL);"
    "INSERT INTO measured_error VALUES(2, 1, 'town', 'wrmse;ssao=on', 0.1), (3, 1, 'town', 'wrmse', 0.02)";

static void excluded_means_one_thing(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.excluded = true});
    study_file_sql("s.db", more);
    expect_done(RUN(fovstats, "export", "s.db", "-o", "s"));
    expect_done(
        RUN("/usr/bin/env", "python3", SOURCE_DIR "/tests/analysis/psych_ds_rules.py", "s/psych-ds", "s.db"));
    expect_done(RUN("/usr/bin/env", "python3", SOURCE_DIR "/tests/analysis/bids_rules.py", "s/bids", "s.db"));
    static const char flags[] = "excluded excluded_stricter excluded_rules";
    static const char *const alone[] = {"trials",     "choices",   "responses", "adjustments",
                                        "staircases", "exposures", "events"};
    for (size_t i = 0; i < sizeof alone / sizeof alone[0]; i++) {
        expect_cells("s/psych-ds", alone[i], "31", flags, "0,0,");
        expect_cells("s/psych-ds", alone[i], "41", flags, "1,1,reaction (late); toggles (stricter)");
        expect_cells("s/psych-ds", alone[i], "51", flags, "0,0,");
        expect_cells("s/psych-ds", alone[i], "221", flags, "1,0,gaze_loss (planned)");
    }
    expect_cells("s/psych-ds", "trials", "33", flags, "0,0,");
    expect_cells("s/psych-ds", "trials", "11", flags, "0,1,toggles (stricter)");
    expect_cells("s/psych-ds", "ratings", "31", flags, "1,0,gaze_loss:rating_pair (planned)");
    expect_cells("s/psych-ds", "ratings", "33", flags, "1,0,gaze_loss:rating_pair (planned)");
    expect_cells("s/psych-ds", "ratings", "41", flags, "1,1,reaction (late); toggles (stricter)");
    expect_cells("s/psych-ds", "ratings", "51", flags, "0,0,");
    expect_cells("s/psych-ds", "ratings", "", "participant_id excluded", "P05,0 P22,1"); // of the whole session
    // Every row of every table, and the numbers of the tools.
    expect_done(SHELL(BUILD_DIR "/bin/fovstats choices --json s.db > c.json && " BUILD_DIR
                                "/bin/fovstats ratings --json s.db > r.json"));
    expect_done(RUN("/usr/bin/env", "python3", excluded, "s", "s.db", "c.json", "r.json"));
    // By hand: of 6 in 22 person 22's answer is out, and person 4's, for the test option; person 3's stays.
    expect_prints("grep -o '\"k\":5,\"n\":20,' c.json", "\"k\":5,\"n\":20,\n");
    // 11 people began with the option under test and 9 with the other; one of the former is out.
    expect_prints("grep -o '\"n\":[0-9]*,\"first_mean' r.json",
                  "\"n\":9,\"first_mean\n\"n\":10,\"first_mean\n");
}

static void everything_that_happened_is_there(void **state)
{
    (void)state;
    expect_cells("s/psych-ds", "events", "", "participant_id at_ns event_kind event_detail attempt excluded",
                 "P22,9,note,tired, \"very\",,1 P05,9,note,,,0");
    expect_cells("s/psych-ds", "events", "51", "event_kind event_detail attempt", "toggle,{\"slot\":\"b\"},1");
    expect_prints("cat s/psych-ds/data/*measurederrors*",
                  "condition_id,reference_condition_id,scene,metric,image_error\r\n"
                  "2,1,town,wrmse;ssao=on,0.1\r\n3,1,town,wrmse,0.02\r\n");
    expect_prints("grep -c 'event_detail.*free text' s/psych-ds/dataset_description.json", "1\n");
}

// One person, one trial that was started three times: in the first run of the program at 1 s, in the second at
// 0.5 s and again at 2 s. Both eyes at 250 Hz from 0 to 2 s and from 0 to 4 s; samples lie 1 ms after.
static const char attempts[] =
    "INSERT INTO segment VALUES(50, 1, '2026-02-01T11:00:00Z', 0, 'monotonic', NULL, '0.1.0', 'resume');"
    "UPDATE trial SET attempt = 3, segment_id = 50, started_ns = 2000000000, ended_ns = 4000000000 WHERE id = "
    "11;"
    "DELETE FROM frame; DELETE FROM gaze;"
    "INSERT INTO frame (session_id, segment_id, trial_id, attempt, number, phase, fade_level, start_ns, "
    "present_estimated) VALUES (1, 1, 11, 1, 1, 'stimulus', 0, 1000000000, 1),"
    "(1, 50, 11, 2, 1, 'stimulus', 0, 600000000, 1), (1, 50, 11, 3, 2, 'stimulus', 0, 2000000000, 1);"
    "INSERT INTO exposure VALUES(NULL, 11, 50, 2, 'a', 500000000, 1900000000, NULL, NULL);"
    "INSERT INTO adjust_step VALUES(NULL, 11, 1, 1500000000, 'epsilon', 0.1),"
    "(NULL, 11, 50, 700000000, 'epsilon', 0.2), (NULL, 11, 50, 400000000, 'epsilon', 0.3),"
    "(NULL, 11, 50, 2000000000, 'epsilon', 0.4);"
    "UPDATE choice SET segment_id = 50, answered_ns = 3900000000 WHERE trial_id = 11;"
    "WITH n(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM n WHERE i < 1499), e(eye, x) AS (VALUES ('left', "
    "-0.3), "
    "('right', 0.3)) INSERT INTO gaze (session_id, segment_id, trial_id, device_ns, host_ns, eye, x_deg, "
    "y_deg, "
    "valid) SELECT 1, iif(i < 500, 1, 50), 11, 1000000000000 + i * 4000000 + 1000000, "
    "iif(i < 500, i, i - 500) * 4000000 + 1000000, eye, x, 0, 1 FROM n, e ORDER BY i";

static void attempts_are_told_apart(void **state)
{
    (void)state;
    study_file_make("t.db", &(struct study_desc){.pooled = false});
    study_file_sql("t.db", attempts);
    expect_done(RUN(fovstats, "export", "t.db", "-o", "t"));
    expect_cells("t/psych-ds", "trials", "11", "attempt", "3");
    expect_cells("t/psych-ds", "choices", "11", "attempt", "3");
    expect_cells("t/psych-ds", "exposures", "11", "attempt", "2");
    expect_cells("t/psych-ds", "adjustments", "11", "parameter_value attempt", "0.1,1 0.2,2 0.3, 0.4,3");
    // 250 samples from before the first attempt and 125 from before the second are of none; 250, 375 and 500 of
    // the three; each of two eyes.
    expect_prints(
        "python3 -c \"import csv, glob, collections; print(sorted(collections.Counter(r['attempt'] for r "
        "in csv.DictReader(open(glob.glob('t/psych-ds/data/*-gaze_data.csv')[0]))).items()))\"",
        "[('', 750), ('1', 500), ('2', 750), ('3', 1000)]\n");
    expect_prints(
        "zcat t/bids/sub-P01/ses-1/beh/*run-2_recording-eye1_physio.tsv.gz | cut -f 9 | sort | uniq -c | "
        "tr -s ' '",
        " 375 2\n 500 3\n 125 n/a\n");
}

// Fixations and saccades of the last attempt alone, as `gaze --events` lists them.
static void events_are_of_the_last_attempt(void **state)
{
    (void)state;
    expect_done(SHELL(BUILD_DIR "/bin/fovstats gaze --events t.db > events.csv"));
    expect_prints("cut -d , -f 3-7 events.csv",
                  "trial,eye,kind,start_ns,duration_ms\n11,left,fixation,1004001000000,1996\n"
                  "11,right,fixation,1004001000000,1996\n");
    expect_prints("zcat t/bids/sub-P01/ses-1/beh/*_physioevents.tsv.gz | cut -f 1-3",
                  "1004001000000\t1.996000000\tfixation\n1004001000000\t1.996000000\tfixation\n");
    expect_done(RUN("/usr/bin/env", "python3", SOURCE_DIR "/tests/analysis/bids_rules.py", "t/bids", "t.db",
                    "events.csv"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(excluded_means_one_thing),
        cmocka_unit_test(everything_that_happened_is_there),
        cmocka_unit_test(attempts_are_told_apart),
        cmocka_unit_test(events_are_of_the_last_attempt),
    };
    return cmocka_run_group_tests_name("export_rows", tests, program_enter_folder, program_leave_folder);
}
