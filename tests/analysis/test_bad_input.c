// Every subcommand that reads a study, on what is no study, on damaged ones and on ones with too little in
// them: one sentence and nothing on stdout where nothing can be done, the rest of the report where something
// can, and never a number that is none.
#include "damaged_file.h"
#include "said.h"
#include "study_file.h"
#include "subcommand.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define countof(array) (sizeof(array) / sizeof(array)[0])

static void what_is_no_study(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"missing.db", "missing.db: there is no such file"},
        {".", ".: is not a file"},
        {"nothing.db", "nothing.db: is not a study file (the file is empty)"},
        {"zeros.db", "zeros.db: is not a study file (not an SQLite database)"},
        {"text.db", "text.db: is not a study file (not an SQLite database)"},
        {"other.db", "other.db: is another program's database"},
        {"newer.db", "newer.db: was written by a newer program (version 999"},
        {"older.db", "older.db: the study file is damaged (its version is 0, but the first was 1)"},
    };
    damaged_file_bytes("nothing.db", 0, 0);
    damaged_file_bytes("zeros.db", 0, 20000);
    damaged_file_bytes("text.db", 'x', 20000);
    study_file_sql("other.db", "CREATE TABLE t(x); INSERT INTO t VALUES(1)");
    study_file_make("newer.db", &(struct study_desc){0});
    study_file_sql("newer.db", "PRAGMA user_version = 999");
    study_file_make("older.db", &(struct study_desc){0});
    study_file_sql("older.db", "PRAGMA user_version = 0");
    for (enum subcommand c = 0; c < SUBCOMMANDS; c++)
        for (size_t i = 0; i < countof(cases); i++)
            subcommand_fails(c, cases[i][0], cases[i][1]);
}

static void damaged_studies(void **state)
{
    (void)state;
    static const char *const names[] = {"half.db", "middle.db", "index.db", "dangling.db"};
    for (size_t i = 0; i < countof(names); i++)
        study_file_make(names[i], &(struct study_desc){0});
    damaged_file_cut("half.db");
    damaged_file_middle("middle.db");
    damaged_file_index("index.db", "sqlite_autoindex_choice_1"); // the last choice is not found by its trial
    study_file_sql("dangling.db", "PRAGMA foreign_keys = OFF; DELETE FROM trial WHERE id = 11");
    for (enum subcommand c = 0; c < SUBCOMMANDS; c++)
        for (size_t i = 0; i < countof(names); i++) {
            char sentence[64];
            snprintf(sentence, sizeof sentence, "%s: the study file is damaged", names[i]);
            subcommand_fails(c, names[i], sentence);
        }
}

// Samples and frames that are there twice, in place of others; that refer to a condition or a trial that is
// not there, and so are no gray frames and no samples between trials.
static void damaged_logs(void **state)
{
    (void)state;
    static const enum subcommand of_frames[] = {FRAMES, AUDIT, GAZE, EVENTS, REPORT, EXPORT, MERGE},
                                 of_gaze[] = {GAZE, EVENTS, REPORT, EXPORT, MERGE};
    const char *names[] = {"frames.db", "gaze.db", "noframes.db", "nogaze.db"};
    for (int i = 0; i < 4; i++) {
        struct program_result r = program_run(
            (const char *const[]){BUILD_DIR "/tests/gaze_study", names[i], "2", "2", "3", "120", "90", NULL},
            NULL);
        assert_int_equal(r.code, 0);
        program_free(&r);
        study_file_sql(names[i], "UPDATE participant SET kind = 'person'");
    }
    subcommand_works(GAZE, "gaze.db");
    damaged_file_twice("frames.db", "frame");
    damaged_file_twice("gaze.db", "gaze");
    study_file_sql("noframes.db",
                   "PRAGMA foreign_keys = OFF; UPDATE frame SET condition_id = 999 WHERE id = 70");
    study_file_sql("nogaze.db", "PRAGMA foreign_keys = OFF; UPDATE gaze SET trial_id = 999 WHERE id = 70");
    for (size_t i = 0; i < countof(of_frames); i++) {
        subcommand_fails(of_frames[i], "frames.db", "frames.db: the study file is damaged");
        subcommand_fails(of_frames[i], "noframes.db", "noframes.db: the study file is damaged (table frame");
    }
    for (size_t i = 0; i < countof(of_gaze); i++) {
        subcommand_fails(of_gaze[i], "gaze.db", "gaze.db: the study file is damaged");
        subcommand_fails(of_gaze[i], "nogaze.db", "nogaze.db: the study file is damaged (table gaze");
    }
}

static void nobody_and_nobody_real(void **state)
{
    (void)state;
    study_file_make("empty.db", &(struct study_desc){.empty = true});
    study_file_make("simulated.db", &(struct study_desc){.simulated = true});
    study_file_make("real.db", &(struct study_desc){0});
    for (enum subcommand c = 0; c < SUBCOMMANDS; c++) {
        if (c == MERGE)
            continue; // joins what there is, and keeps the kinds apart
        subcommand_fails(c, "empty.db", "empty.db: the study is empty");
        subcommand_fails(c, "simulated.db", "simulated.db: only simulated sessions");
        said_sentence(subcommand_run(c, "real.db", "--simulated", NULL), 1,
                      c == EXPORT ? "there is no simulated session in it" : "holds sessions of people");
    }
}

static void confidence_of_none_or_all(void **state)
{
    (void)state;
    static const char *const wrong[] = {"0", "1", "-1", "2", "1e-20", "0.99999999999999999"},
                             *const no_number[] = {"nan", "inf", "x", ""};
    static const enum subcommand with[] = {CHOICES, RATINGS, ANOVA, THRESHOLDS, JOD,
                                           FRAMES,  AUDIT,   GAZE,  PLANNED,    REPORT};
    study_file_make("c.db", &(struct study_desc){0});
    for (size_t i = 0; i < countof(with); i++) {
        for (size_t k = 0; k < countof(wrong); k++)
            said_sentence(subcommand_run(with[i], "c.db", "--conf", wrong[k]), 2,
                          "but must lie between 0 and 1");
        for (size_t k = 0; k < countof(no_number); k++)
            said_sentence(subcommand_run(with[i], "c.db", "--conf", no_number[k]), 2, "but must be a number");
    }
    for (size_t k = 0; k < countof(wrong); k++)
        said_sentence(FOVSTATS("binom", "1", "2", "--conf", wrong[k]), 2, "--conf is ");
}

static void impossible_counts_and_shares(void **state)
{
    (void)state;
    study_file_make("p.db", &(struct study_desc){0});
    said_sentence(FOVSTATS("binom", "23", "22"), 2, "K is 23 but cannot exceed N, which is 22");
    static const char *const wrong[] = {"-0.1", "1.1", "1e300"};
    for (size_t i = 0; i < countof(wrong); i++) {
        said_sentence(FOVSTATS("binom", "1", "2", "--p", wrong[i]), 2, "but must be from 0 to 1");
        said_sentence(FOVSTATS("choices", "p.db", "--p", wrong[i]), 2, "but must lie between 0 and 1");
        said_sentence(FOVSTATS("power", "p.db", "--participants", "5", "--share", wrong[i]), 2,
                      "but must lie between 0 and 1");
    }
}

static void a_report_never_overwrites_a_study(void **state)
{
    (void)state;
    study_file_make("a.db", &(struct study_desc){0});
    study_file_make("b.db", &(struct study_desc){0});
    said_sentence(FOVSTATS("report", "a.db", "-o", "./a.db"), 2, "-o ./a.db is a study file");
    said_sentence(FOVSTATS("report", "a.db", "-o", "b.db"), 2, "-o b.db is a study file");
    subcommand_works(CHOICES, "a.db");
    subcommand_works(CHOICES, "b.db");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_study),
        cmocka_unit_test(damaged_studies),
        cmocka_unit_test(damaged_logs),
        cmocka_unit_test(nobody_and_nobody_real),
        cmocka_unit_test(confidence_of_none_or_all),
        cmocka_unit_test(impossible_counts_and_shares),
        cmocka_unit_test(a_report_never_overwrites_a_study),
    };
    return cmocka_run_group_tests_name("bad_input", tests, program_enter_folder, program_leave_folder);
}
