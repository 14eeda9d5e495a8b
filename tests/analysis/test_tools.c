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
    static const struct said_case cases[] = {
        {{NULL}, "which subcommand?"},
        {{"binomial"}, "no subcommand \"binomial\""},
        {{"binom"}, "needs K and N"},
        {{"binom", "1", "2", "3"}, "needs K and N"},
        {{"binom", "-1", "22"}, "K is \"-1\""},
        {{"binom", "x", "22"}, "K is \"x\""},
        {{"binom", "6", "22.5"}, "N is \"22.5\""},
        {{"binom", "0", "0"}, "N is \"0\""},
        {{"binom", "99999999999999999999", "22"}, "K is \"99999999999999999999\""},
        {{"binom", "1", "99999999999999999999"}, "N is \"99999999999999999999\""},
        {{"binom", "1", "1000000001"}, "from 1 to 1000000000"},
        {{"binom", "1", "2", "--p", "nan"}, "--p is \"nan\" but must be a number"},
        {{"binom", "1", "2", "--p", "half"}, "--p is \"half\" but must be a number"},
        {{"binom", "1", "2", "--p", "1e999"}, "--p is \"1e999\" but must be a number"},
        {{"binom", "1", "2", "--conf"}, "--conf needs a value"},
        {{"binom", "1", "2", "--alternative", "both"}, "--alternative is \"both\""},
        {{"binom", "1", "2", "--p0", "7"}, "--p is 7"},
        {{"binom", "1", "2", "--margin", "0.6"}, "--margin is 0.6 but must be above 0"},
        {{"binom", "1", "2", "--margin", "-0.1"}, "--margin is -0.1"},
        {{"binom", "1", "2", "--margin", "0.1", "--conf", "0.5"}, "--margin needs more than 0.5"},
        {{"binom", "1", "2", "--prior", "1"}, "--prior is \"1\""},
        {{"binom", "1", "2", "--prior", "1,0"}, "--prior is \"1,0\""},
        {{"binom", "1", "2", "--prior", "1,2,3"}, "--prior is \"1,2,3\""},
        {{"binom", "1", "2", "--share", "1.01"}, "--share is 1.01"},
        {{"binom", "1", "2", "--share", "0.7", "--power", "1"}, "--power is 1 but must lie between 0 and 1"},
        {{"binom", "6", "22", "--power", "0.9"}, "--power is 0.9 but needs --share S beside it"},
        {{"binom", "6", "22", "--share", "0.3", "--alternative", "less"}, "--alternative is less; ask for one"},
        {{"binom", "1", "2", "--quiet"}, "--quiet is not an option"},
        {{"choices"}, "needs at least one study file"},
        {{"report", "x.db"}, "needs -o FILE.html"},
        {{"report", "x.db", "-o"}, "-o needs a value"},
    };
    said_wrong_use(cases, sizeof cases / sizeof cases[0]);
}

static void help_everywhere(void **state)
{
    (void)state;
    const char *names[] = {"anova", "binom",   "choices", "export",  "frames", "gaze",      "jod",
                           "merge", "planned", "power",   "ratings", "report", "thresholds"};
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
