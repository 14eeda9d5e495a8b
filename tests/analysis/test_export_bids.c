// fovstats export --format bids: the gaze keeps the published rules and every bit, events are those of `gaze
// --events`, planted faults are found, several files count a session once.
#include "program.h"
#include "staircase_file.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";
static const char rules[] = SOURCE_DIR "/tests/analysis/bids_rules.py";

#define RUN(...) program_run((const char *const[]){__VA_ARGS__, NULL}, NULL)
#define EXPORT(...) RUN(fovstats, "export", __VA_ARGS__)
#define SHELL(text) RUN("/bin/sh", "-c", text)

static int enter_folder(void **state)
{
    static char folder[] = "/tmp/fovstats-test-XXXXXX";
    *state = mkdtemp(folder);
    return *state && chdir(folder) == 0 ? 0 : -1;
}

static int leave_folder(void **state)
{
    struct program_result r = RUN("/bin/rm", "-rf", *state);
    program_free(&r);
    return 0;
}

static void expect_done(struct program_result r)
{
    if (r.code != 0)
        fail_msg("exit %d: %s%s", r.code, r.out, r.err);
    program_free(&r);
}

static void expect_says(struct program_result r, int code, const char *part)
{
    if (r.code != code || !strstr(r.out, part))
        fail_msg("exit %d, not %d with \"%s\": %s%s", r.code, code, part, r.out, r.err);
    program_free(&r);
}

// Two people, the left eye of one and both eyes of the other, four trials of 3 s at 120 Hz.
static void gaze_keeps_the_rules(void **state)
{
    (void)state;
    expect_done(RUN(BUILD_DIR "/tests/gaze_study", "g.db", "2", "4", "3", "120", "0"));
    study_file_sql("g.db", "UPDATE gaze SET eye = 'left' WHERE session_id = 1");
    study_file_sql("g.db", "UPDATE gaze SET valid = 0, x_deg = NULL, y_deg = NULL WHERE id % 50 = 3");
    study_file_sql("g.db", "UPDATE gaze SET x_deg = 1.0 / 3, pupil_mm = 3.14159265358979 WHERE id = 20");
    expect_done(EXPORT("g.db", "-o", "g", "--simulated", "--format", "bids"));
    expect_done(SHELL(
        BUILD_DIR
        "/bin/fovstats gaze --events --simulated g.db > events.csv && test $(wc -l < events.csv) -gt 20"));
    expect_done(RUN("/usr/bin/env", "python3", rules, "g", "g.db", "events.csv"));
    expect_done(EXPORT("g.db", "-o", "h", "--simulated", "--format", "bids"));
    expect_done(RUN("/usr/bin/diff", "-r", "g", "h"));
    expect_done(RUN("/bin/rm", "-r", "h"));
}

// Of saccades at 90 Hz there is a size and no peak, whose neighbours are 22 ms apart.
static void a_slow_tracker_has_no_peaks(void **state)
{
    (void)state;
    expect_done(RUN(BUILD_DIR "/tests/gaze_study", "slow.db", "1", "2", "10", "90", "0"));
    expect_done(EXPORT("slow.db", "-o", "slow", "--simulated", "--format", "bids"));
    expect_done(
        SHELL("zcat slow/*/*/beh/*_physioevents.tsv.gz | grep saccade > saccades && test $(wc -l < "
              "saccades) -gt 20 && ! cut -f 6 saccades | grep -q n/a && ! cut -f 7 saccades | grep -qv n/a"));
    expect_done(SHELL(BUILD_DIR "/bin/fovstats gaze --events --simulated slow.db > events.csv"));
    expect_done(RUN("/usr/bin/env", "python3", rules, "slow", "slow.db", "events.csv"));
}

// A fault that is planted in the good dataset must be named.
static void planted_faults_are_found(void **state)
{
    (void)state;
    static const struct {
        const char *plant, *finding;
    } faults[] = {
        {"sed -i 's/\"SamplingFrequency\":[0-9.]*,//' $(ls */*/beh/*_physio.json | head -1)",
         "SamplingFrequency is missing"},
        {"sed -i 's/\"StartTime\":[0-9.]*,//' $(ls */*/beh/*_physio.json | head -1)", "StartTime is missing"},
        {"sed -i 's/\"RecordedEye\":\"[a-z]*\"/\"RecordedEye\":\"both\"/' $(ls */*/beh/*_physio.json | head "
         "-1)",
         "RecordedEye"},
        {"sed -i 's/eyetrack/generic/' $(ls */*/beh/*_physio.json | head -1)", "PhysioType is not eyetrack"},
        {"f=$(ls */*/beh/*_physio.tsv.gz | head -1); (printf "
         "'timestamp\\tx_coordinate\\ty_coordinate\\tpupil_size\\t"
         "arrival\\tvalid\\tconfidence\\ttrial_id\\n'; zcat $f) | gzip -n > new && mv new $f",
         "a header"},
        {"f=$(ls */*/beh/*_physio.tsv.gz | head -1); zcat $f | sed 1d | gzip -n > new && mv new $f",
         "are in no recording"},
        {"f=$(ls */*/beh/*_physio.tsv.gz | head -1); zcat $f > new && gzip new && mv new.gz $f",
         "its header holds a time"},
        {"f=$(ls */*/beh/*eye1_physio.json | head -1); mv $f ${f%eye1_physio.json}left.eye_physio.json",
         "no name of BIDS"},
        {"f=$(ls */*/beh/*_physio.tsv.gz | head -1); mv $f $(dirname $f)/gaze.tsv.gz", "no name of BIDS"},
        {"f=$(ls */*/beh/*eye1_physio.tsv.gz | head -1); rm $f", "there is no recording of that name"},
        {"sed -i '2s/[0-9]/\\t&/' $(ls */*/beh/*_beh.tsv | head -1)", "rows of another length"},
        {"sed -i 2d participants.tsv", "lists others than the folders"},
        {"sed -i 's/1.11.1/1.0/' dataset_description.json", "BIDSVersion"},
    };
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        char plant[1024];
        snprintf(plant, sizeof plant, "rm -rf f && cp -r g f && cd f && %s", faults[i].plant);
        expect_done(SHELL(plant));
        struct program_result r = RUN("/usr/bin/env", "python3", rules, "f", "g.db");
        if (r.code == 0 || !strstr(r.out, faults[i].finding))
            fail_msg("not found: %s: %s%s", faults[i].plant, r.out, r.err);
        program_free(&r);
    }
}

static void what_has_no_rate_is_said(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.pooled = false});
    study_file_sql("s.db",
                   "INSERT INTO gaze (session_id, segment_id, device_ns, host_ns, eye, x_deg, y_deg, valid) "
                   "VALUES (2, 2, 5, 5, 'both', 0.1, 0.2, 1)");
    expect_says(EXPORT("s.db", "-o", "s", "--format", "bids"), 0,
                "Left out of BIDS, which demands a sampling frequency: 3 samples");
    expect_done(RUN("/usr/bin/env", "python3", rules, "s", "s.db"));
    expect_done(SHELL("grep -q 'samples of gaze are in the Psych-DS export alone' s/README.md && "
                      "test -z \"$(find s -name '*_physio*')\""));
    expect_says(EXPORT("s.db", "-o", "t", "--json"), 0, "\"gaze_samples_without_rate\":3");
}

// Codes that differ in what a file name cannot hold, or in capitals alone, stay two people.
static void people_keep_apart(void **state)
{
    (void)state;
    study_file_make("c.db", &(struct study_desc){.pooled = false});
    study_file_sql("c.db", "UPDATE participant SET code = 'A-1' WHERE id = 1");
    study_file_sql("c.db", "UPDATE participant SET code = 'a1' WHERE id = 2");
    study_file_sql("c.db", "UPDATE participant SET code = '../\xc3\xa4' WHERE id = 3");
    study_file_sql("c.db", "UPDATE participant SET code = 'A_1' WHERE id = 4");
    expect_done(EXPORT("c.db", "-o", "c", "--format", "bids"));
    expect_done(RUN("/usr/bin/env", "python3", rules, "c", "c.db"));
    expect_done(SHELL(
        "test $(ls -d c/sub-* | wc -l) = 22 && test $(ls c | tr A-Z a-z | sort -u | wc -l) = $(ls c | wc -l)"));
}

static void several_files_count_a_session_once(void **state)
{
    (void)state;
    study_file_make("one.db", &(struct study_desc){.pooled = false});
    expect_done(SHELL("cp one.db copy.db"));
    expect_done(EXPORT("one.db", "-o", "alone"));
    expect_says(EXPORT("one.db", "copy.db", "-o", "joined"), 0, "22 sessions");
    expect_done(RUN("/usr/bin/diff", "-r", "alone/bids", "joined/bids"));
    expect_done(RUN("/usr/bin/env", "python3", SOURCE_DIR "/tests/analysis/psych_ds_rules.py",
                    "joined/psych-ds", "one.db"));
    expect_done(SHELL("test \"$(ls joined | tr '\\n' ' ')\" = 'bids psych-ds ' && test ! -e joined.part"));
}

static void staircases_are_answers(void **state)
{
    (void)state;
    staircase_file_make("t.db");
    expect_done(EXPORT("t.db", "-o", "stairs", "--format", "bids"));
    expect_done(RUN("/usr/bin/env", "python3", rules, "stairs", "t.db"));
    expect_done(SHELL("cat stairs/sub-*/ses-*/beh/*_beh.tsv | grep -q staircase_step"));
}

// A session that was resumed has two runs, each with its own time 0; their samples may even alternate in the
// file.
static void a_resumed_session_has_two_runs(void **state)
{
    (void)state;
    expect_done(RUN(BUILD_DIR "/tests/gaze_study", "u.db", "1", "2", "3", "120", "0"));
    study_file_sql("u.db",
                   "INSERT INTO segment SELECT 99, session_id, started_at, 0, clock, boot_id, app_version, "
                   "'resume' FROM segment WHERE id = 1");
    study_file_sql("u.db", "UPDATE gaze SET segment_id = 99 WHERE id / 100 % 2 = 1");
    expect_done(EXPORT("u.db", "-o", "u", "--simulated", "--format", "bids"));
    expect_done(RUN("/usr/bin/env", "python3", rules, "u", "u.db"));
    expect_done(SHELL("test $(ls u/sub-*/ses-1/beh/*run-2_recording-eye3_physio.tsv.gz | wc -l) = 1"));
}

static void laboratories_keep_their_people(void **state)
{
    (void)state;
    study_file_make("l.db", &(struct study_desc){.pooled = false});
    study_file_make("m.db", &(struct study_desc){.pooled = false});
    study_file_sql("m.db", "UPDATE session SET started_at = replace(started_at, '2026-02', '2026-03')");
    struct program_result r = EXPORT("l.db", "m.db", "-o", "lm");
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "tell the files apart with --lab"));
    program_free(&r);
    expect_says(EXPORT("l.db", "--lab", "Ulm=m.db", "-o", "lm"), 0, "44 sessions");
    expect_done(RUN("/usr/bin/env", "python3", rules, "lm/bids"));
    expect_done(SHELL("test -d lm/bids/sub-UlmP01 && test ! -e lm.part"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gaze_keeps_the_rules),
        cmocka_unit_test(a_slow_tracker_has_no_peaks),
        cmocka_unit_test(planted_faults_are_found),
        cmocka_unit_test(what_has_no_rate_is_said),
        cmocka_unit_test(people_keep_apart),
        cmocka_unit_test(several_files_count_a_session_once),
        cmocka_unit_test(staircases_are_answers),
        cmocka_unit_test(a_resumed_session_has_two_runs),
        cmocka_unit_test(laboratories_keep_their_people),
    };
    return cmocka_run_group_tests_name("export_bids", tests, enter_folder, leave_folder);
}
