// fovstats as a user meets it: one sentence for each wrong use, what every subcommand does alike.
#include "program.h"
#include "said.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

static void wrong_use(void **state)
{
    (void)state;
    said_sentence(program_run((const char *const[]){fovstats, NULL}, NULL), 2, "which subcommand?");
    said_sentence(FOVSTATS("binomial"), 2, "no subcommand \"binomial\"");
    said_sentence(FOVSTATS("binom"), 2, "needs K and N");
    said_sentence(FOVSTATS("binom", "1", "2", "3"), 2, "needs K and N");
    said_sentence(FOVSTATS("binom", "-1", "22"), 2, "K is \"-1\"");
    said_sentence(FOVSTATS("binom", "x", "22"), 2, "K is \"x\"");
    said_sentence(FOVSTATS("binom", "6", "22.5"), 2, "N is \"22.5\"");
    said_sentence(FOVSTATS("binom", "0", "0"), 2, "N is \"0\"");
    said_sentence(FOVSTATS("binom", "99999999999999999999", "22"), 2, "K is \"99999999999999999999\"");
    said_sentence(FOVSTATS("binom", "1", "99999999999999999999"), 2, "N is \"99999999999999999999\"");
    said_sentence(FOVSTATS("binom", "1", "1000000001"), 2, "from 1 to 1000000000");
    said_sentence(FOVSTATS("binom", "1", "2", "--p", "nan"), 2, "--p is \"nan\" but must be a number");
    said_sentence(FOVSTATS("binom", "1", "2", "--p", "half"), 2, "--p is \"half\" but must be a number");
    said_sentence(FOVSTATS("binom", "1", "2", "--p", "1e999"), 2, "--p is \"1e999\" but must be a number");
    said_sentence(FOVSTATS("binom", "1", "2", "--conf"), 2, "--conf needs a value");
    said_sentence(FOVSTATS("binom", "1", "2", "--alternative", "both"), 2, "--alternative is \"both\"");
    said_sentence(FOVSTATS("binom", "1", "2", "--p0", "7"), 2, "--p is 7");
    said_sentence(FOVSTATS("binom", "1", "2", "--margin", "0.6"), 2, "--margin is 0.6 but must be above 0");
    said_sentence(FOVSTATS("binom", "1", "2", "--margin", "-0.1"), 2, "--margin is -0.1");
    said_sentence(FOVSTATS("binom", "1", "2", "--margin", "0.1", "--conf", "0.5"), 2,
                  "--margin needs more than 0.5");
    said_sentence(FOVSTATS("binom", "1", "2", "--prior", "1"), 2, "--prior is \"1\"");
    said_sentence(FOVSTATS("binom", "1", "2", "--prior", "1,0"), 2, "--prior is \"1,0\"");
    said_sentence(FOVSTATS("binom", "1", "2", "--prior", "1,2,3"), 2, "--prior is \"1,2,3\"");
    said_sentence(FOVSTATS("binom", "1", "2", "--share", "1.01"), 2, "--share is 1.01");
    said_sentence(FOVSTATS("binom", "1", "2", "--power", "1"), 2, "--power is 1 but must lie between 0 and 1");
    said_sentence(FOVSTATS("binom", "1", "2", "--quiet"), 2, "--quiet is not an option");
    said_sentence(FOVSTATS("choices"), 2, "needs at least one study file");
    said_sentence(FOVSTATS("report", "x.db"), 2, "needs -o FILE.html");
    said_sentence(FOVSTATS("report", "x.db", "-o"), 2, "-o needs a value");
}

static void help_everywhere(void **state)
{
    (void)state;
    static const char *const names[] = {"binom",  "choices", "ratings", "anova",  "thresholds", "jod",
                                        "frames", "power",   "gaze",    "report", "merge",      "export"};
    struct program_result all = FOVSTATS("--help");
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct program_result r = FOVSTATS(names[i], "--help");
        assert_int_equal(r.code, 0);
        assert_non_null(strstr(r.out, names[i]));
        assert_int_equal(strncmp(r.out, "usage: fovstats ", 16), 0);
        assert_non_null(strstr(all.out, names[i]));
        program_free(&r);
    }
    program_free(&all);
}

// What cannot be read alone is in test_bad_input.c.
static void files_that_do_not_go_together(void **state)
{
    (void)state;
    const char *commands[] = {"choices", "ratings", "frames"};
    study_file_make("simulated.db", &(struct study_desc){.simulated = true});
    study_file_make("real.db", &(struct study_desc){0});
    for (int i = 0; i < 3; i++) {
        const char *c = commands[i];
        said_sentence(FOVSTATS(c, "simulated.db"), 1,
                      "only simulated sessions (22) are in it; add --simulated");
        said_sentence(FOVSTATS(c, "simulated.db", "real.db", "--simulated"), 1,
                      "real.db: holds sessions of people");
        said_sentence(FOVSTATS(c, "real.db", "./real.db"), 1, "is given twice");
    }
    const char *cp[] = {"/bin/cp", "real.db", "copy.db", NULL};
    struct program_result r = program_run(cp, NULL);
    program_free(&r);
    said_sentence(FOVSTATS("choices", "real.db", "copy.db"), 1, "is also in real.db");
}

static void reading_changes_nothing(void **state)
{
    (void)state;
    study_file_make("same.db", &(struct study_desc){0});
    study_file_sql("same.db", "PRAGMA journal_mode = WAL");
    struct stat before, after;
    assert_int_equal(stat("same.db", &before), 0);
    chmod("same.db", 0444);
    struct program_result r = FOVSTATS("choices", "same.db");
    assert_int_equal(r.code, 0);
    program_free(&r);
    assert_int_equal(stat("same.db", &after), 0);
    assert_true(before.st_size == after.st_size && before.st_mtime == after.st_mtime);
}

static void simulated_is_said(void **state)
{
    (void)state;
    study_file_make("sim.db", &(struct study_desc){.simulated = true});
    const char *commands[] = {"choices", "ratings", "frames"};
    for (int i = 0; i < 3; i++) {
        struct program_result r = FOVSTATS(commands[i], "sim.db", "--simulated");
        assert_int_equal(r.code, 0);
        assert_int_equal(strncmp(r.out, "SIMULATED DATA. ", 16), 0);
        program_free(&r);
        r = FOVSTATS(commands[i], "sim.db", "--simulated", "--json");
        assert_non_null(strstr(r.out, "\"simulated\":true"));
        program_free(&r);
    }
}

// Two labs' files: people add up, cells join.
static void files_add_up(void **state)
{
    (void)state;
    study_file_make("a.db", &(struct study_desc){0});
    study_file_make("b.db", &(struct study_desc){0});
    study_file_sql("b.db", "UPDATE session SET started_at = '2027' || started_at");
    struct program_result r = FOVSTATS("choices", "a.db", "b.db", "--json");
    assert_int_equal(r.code, 0);
    assert_true(said_after(r.out, "{", "participants") == 44);
    assert_true(said_after(r.out, "\"epsilon\":0.2}", "k") == 12 &&
                said_after(r.out, "\"epsilon\":0.2}", "n") == 44);
    assert_null(strstr(r.out, "\"several_answers\":true"));
    program_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_use),
        cmocka_unit_test(help_everywhere),
        cmocka_unit_test(files_that_do_not_go_together),
        cmocka_unit_test(reading_changes_nothing),
        cmocka_unit_test(simulated_is_said),
        cmocka_unit_test(files_add_up),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
