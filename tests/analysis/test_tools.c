// fovstats as a user meets it: numbers against R, text against golden files, one sentence for each wrong use.
#include "program.h"
#include "reference.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

// A folder of the test's own; study files are named within it.
static int enter_folder(void **state)
{
    static char folder[] = "/tmp/fovstats-test-XXXXXX";
    *state = mkdtemp(folder);
    return *state && chdir(folder) == 0 ? 0 : -1;
}

static int leave_folder(void **state)
{
    const char *rm[] = {"/bin/rm", "-rf", *state, NULL};
    struct program_result r = program_run(rm, NULL);
    program_free(&r);
    return 0;
}

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

static double expected(const char *name)
{
    FILE *file = reference_open("small_study.csv");
    char line[256];
    double value = (double)NAN;
    while (fgets(line, sizeof line, file)) {
        char *rest = line;
        if (strcmp(reference_field(&rest, ','), name) == 0)
            value = strtod(rest, NULL);
    }
    fclose(file);
    assert_true(!isnan(value));
    return value;
}

// The number after the first "key": that follows the first `after` in a JSON text.
static double json_after(const char *json, const char *after, const char *key)
{
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr(json, after);
    if (!at || !(at = strstr(at, quoted)))
        fail_msg("no %s after %s in %s", key, after, json);
    return strtod(at + strlen(quoted), NULL);
}

static void expect_number(const char *json, const char *after, const char *key, const char *name)
{
    double got = json_after(json, after, key), want = expected(name);
    if (!reference_close(got, want, 1e-12))
        fail_msg("%s: %.17g, R %.17g", name, got, want);
}

static void expect_golden(const char *text, const char *name)
{
    char path[512];
    static char golden[65536];
    snprintf(path, sizeof path, "%s/tests/analysis/golden/%s", SOURCE_DIR, name);
    FILE *file = fopen(path, "r");
    if (!file)
        fail_msg("%s is missing; it should read:\n%s", path, text);
    golden[fread(golden, 1, sizeof golden - 1, file)] = '\0';
    fclose(file);
    // The golden files have HASH for the data's: provenance has its own test.
    char *copy = strdup(text), *hash = copy ? strstr(copy, "SHA-256 ") : NULL;
    assert_non_null(copy);
    if (hash) {
        assert_int_equal(strspn(hash + 8, "0123456789abcdef"), 64);
        memmove(hash + 8 + 4, hash + 8 + 64, strlen(hash + 8 + 64) + 1);
        memcpy(hash + 8, "HASH", 4);
    }
    assert_string_equal(copy, golden);
    free(copy);
}

// --- binom ---

static void binom_prints(void **state)
{
    (void)state;
    struct program_result r = FOVSTATS("binom", "6", "22");
    assert_int_equal(r.code, 0);
    expect_golden(r.out, "binom.txt");
    assert_string_equal(r.err, "");
    program_free(&r);
    r = FOVSTATS("binom", "4", "19", "--json");
    assert_int_equal(strncmp(r.out, "{\"k\":4,\"n\":19,\"p0\":0.5,\"p_value\":", 33), 0);
    expect_number(r.out, "{", "p_value", "cell2.p_value");
    expect_number(r.out, "{", "ci_low", "cell2.ci_low");
    expect_number(r.out, "{", "ci_high", "cell2.ci_high");
    assert_true(json_after(r.out, "{", "null_low") == 5 && json_after(r.out, "{", "null_high") == 14);
    assert_true(reference_close(json_after(r.out, "{", "estimate"), 4.0 / 19, 1e-15));
    program_free(&r);
    r = FOVSTATS("binom", "3", "10", "--p", "0.2", "--alternative", "greater", "--conf", "0.9", "--json");
    assert_int_equal(r.code, 0);
    // R: binom.test(3, 10, 0.2, "greater", 0.9)
    assert_true(reference_close(json_after(r.out, "{", "p_value"), 0.32220047360000004, 1e-12));
    assert_true(json_after(r.out, "{", "ci_high") == 1);
    program_free(&r);
}

static void binom_prints_all(void **state)
{
    (void)state;
    struct program_result r =
        FOVSTATS("binom", "6", "22", "--mid-p", "--margin", "0.1", "--prior", "2,7", "--share", "0.75");
    assert_int_equal(r.code, 0);
    expect_golden(r.out, "binom_all.txt");
    program_free(&r);
    // row(6, 22, 0.5, 0.95, 0.1) of tests/reference/binomial_exact.py; 30 and 35 are counts.R's
    r = FOVSTATS("binom", "6", "22", "--margin", "0.1", "--prior", "2,7", "--share", "0.75", "--json");
    assert_true(reference_close(json_after(r.out, "{", "ln_p"), -2.94734618561802, 1e-12));
    assert_true(reference_close(log(json_after(r.out, "{", "mid_p")), -3.3613134796009644, 1e-12));
    assert_true(reference_close(json_after(r.out, "{", "wilson_low"), 0.13150760287989472, 1e-12));
    assert_true(reference_close(json_after(r.out, "{", "jeffreys_high"), 0.47823117669052994, 1e-12));
    assert_true(reference_close(json_after(r.out, "{", "ln_bf10"), 1.6126960271244198, 1e-12));
    assert_true(
        reference_close(log(json_after(r.out, "equivalence", "p_value")), -0.074967491637748123, 1e-12));
    assert_true(json_after(r.out, "power", "n_first") == 30 && json_after(r.out, "power", "n_stays") == 35);
    assert_non_null(strstr(r.out, "\"shown\":\"undecided\""));
    program_free(&r);
    r = FOVSTATS("binom", "0", "100000"); // 2^-99999
    assert_non_null(strstr(r.out, "p            2.002e-30103\n"));
    assert_null(strstr(r.out, "equality")); // a difference is shown
    program_free(&r);
}

// No difference is never said to be equality, and equality only where the margin's test shows it.
static void no_difference_is_not_equality(void **state)
{
    (void)state;
    const struct {
        const char *k, *n, *margin, *says;
    } cases[] = {{"11", "22", NULL, "equality     not shown"},
                 {"11", "22", "0.1", "neither a difference nor equality"},
                 {"500", "1000", "0.05", "so           equality within the margin is shown"},
                 {"540", "1000", "0.1", "a difference is shown, and that it is within the margin"},
                 {"600", "1000", "0.05", "a difference is shown, and not that it is within the margin"}};
    for (int i = 0; i < 5; i++) {
        struct program_result r = cases[i].margin
                                      ? FOVSTATS("binom", cases[i].k, cases[i].n, "--margin", cases[i].margin)
                                      : FOVSTATS("binom", cases[i].k, cases[i].n);
        if (r.code != 0 || !strstr(r.out, cases[i].says))
            fail_msg("%s of %s: no \"%s\" in %s", cases[i].k, cases[i].n, cases[i].says, r.out);
        program_free(&r);
    }
}

static void expect_sentence(struct program_result r, int code, const char *part)
{
    if (r.code != code || !strstr(r.err, part) || r.out[0])
        fail_msg("exit %d, \"%s\", out \"%s\"; expected exit %d and \"%s\"", r.code, r.err, r.out, code, part);
    const char *end = strchr(r.err, '\n');
    assert_true(end && end[1] == '\0'); // one line
    program_free(&r);
}

static void wrong_use(void **state)
{
    (void)state;
    expect_sentence(program_run((const char *const[]){fovstats, NULL}, NULL), 2, "which subcommand?");
    expect_sentence(FOVSTATS("binomial"), 2, "no subcommand \"binomial\"");
    expect_sentence(FOVSTATS("binom"), 2, "needs K and N");
    expect_sentence(FOVSTATS("binom", "1", "2", "3"), 2, "needs K and N");
    expect_sentence(FOVSTATS("binom", "23", "22"), 2, "K is 23 but cannot exceed N, which is 22");
    expect_sentence(FOVSTATS("binom", "-1", "22"), 2, "K is \"-1\"");
    expect_sentence(FOVSTATS("binom", "x", "22"), 2, "K is \"x\"");
    expect_sentence(FOVSTATS("binom", "6", "22.5"), 2, "N is \"22.5\"");
    expect_sentence(FOVSTATS("binom", "0", "0"), 2, "N is \"0\"");
    expect_sentence(FOVSTATS("binom", "99999999999999999999", "22"), 2, "K is \"99999999999999999999\"");
    expect_sentence(FOVSTATS("binom", "1", "99999999999999999999"), 2, "N is \"99999999999999999999\"");
    expect_sentence(FOVSTATS("binom", "1", "1000000001"), 2, "from 1 to 1000000000");
    expect_sentence(FOVSTATS("binom", "1", "2", "--p", "1.5"), 2, "--p is 1.5 but must be from 0 to 1");
    expect_sentence(FOVSTATS("binom", "1", "2", "--p", "-0.1"), 2, "--p is -0.1");
    expect_sentence(FOVSTATS("binom", "1", "2", "--p", "nan"), 2, "--p is \"nan\" but must be a number");
    expect_sentence(FOVSTATS("binom", "1", "2", "--p", "half"), 2, "--p is \"half\" but must be a number");
    expect_sentence(FOVSTATS("binom", "1", "2", "--p", "1e999"), 2, "--p is \"1e999\" but must be a number");
    expect_sentence(FOVSTATS("binom", "1", "2", "--conf", "0"), 2, "--conf is 0 but must lie between 0 and 1");
    expect_sentence(FOVSTATS("binom", "1", "2", "--conf", "1"), 2, "--conf is 1 but must lie between 0 and 1");
    expect_sentence(FOVSTATS("binom", "1", "2", "--conf"), 2, "--conf needs a value");
    expect_sentence(FOVSTATS("binom", "1", "2", "--alternative", "both"), 2, "--alternative is \"both\"");
    expect_sentence(FOVSTATS("binom", "1", "2", "--p0", "7"), 2, "--p is 7");
    expect_sentence(FOVSTATS("binom", "1", "2", "--margin", "0.6"), 2, "--margin is 0.6 but must be above 0");
    expect_sentence(FOVSTATS("binom", "1", "2", "--margin", "-0.1"), 2, "--margin is -0.1");
    expect_sentence(FOVSTATS("binom", "1", "2", "--margin", "0.1", "--conf", "0.5"), 2,
                    "--margin needs more than 0.5");
    expect_sentence(FOVSTATS("binom", "1", "2", "--prior", "1"), 2, "--prior is \"1\"");
    expect_sentence(FOVSTATS("binom", "1", "2", "--prior", "1,0"), 2, "--prior is \"1,0\"");
    expect_sentence(FOVSTATS("binom", "1", "2", "--prior", "1,2,3"), 2, "--prior is \"1,2,3\"");
    expect_sentence(FOVSTATS("binom", "1", "2", "--share", "1.01"), 2, "--share is 1.01");
    expect_sentence(FOVSTATS("binom", "1", "2", "--power", "1"), 2,
                    "--power is 1 but must lie between 0 and 1");
    expect_sentence(FOVSTATS("binom", "1", "2", "--quiet"), 2, "--quiet is not an option");
    expect_sentence(FOVSTATS("choices"), 2, "needs at least one study file");
    expect_sentence(FOVSTATS("choices", "x.db", "--conf", "1"), 2, "--conf is 1");
    expect_sentence(FOVSTATS("report", "x.db"), 2, "needs -o FILE.html");
    expect_sentence(FOVSTATS("report", "x.db", "-o"), 2, "-o needs a value");
}

static void help_everywhere(void **state)
{
    (void)state;
    const char *names[] = {"binom", "choices", "ratings", "frames", "power", "report"};
    struct program_result all = FOVSTATS("--help");
    for (int i = 0; i < 6; i++) {
        struct program_result r = FOVSTATS(names[i], "--help");
        assert_int_equal(r.code, 0);
        assert_non_null(strstr(r.out, names[i]));
        assert_int_equal(strncmp(r.out, "usage: fovstats ", 16), 0);
        assert_non_null(strstr(all.out, names[i]));
        program_free(&r);
    }
    program_free(&all);
}

// --- study files that cannot be read ---

static void unreadable_files(void **state)
{
    (void)state;
    const char *commands[] = {"choices", "ratings", "frames"};
    study_file_sql("other.db", "CREATE TABLE t(x); INSERT INTO t VALUES(1)");
    study_file_make("newer.db", &(struct study_desc){0});
    study_file_sql("newer.db", "PRAGMA user_version = 999");
    study_file_make("older.db", &(struct study_desc){0});
    study_file_sql("older.db", "PRAGMA user_version = 0");
    study_file_make("empty.db", &(struct study_desc){.empty = true});
    study_file_make("bare.db", &(struct study_desc){.bare = true});
    study_file_make("simulated.db", &(struct study_desc){.simulated = true});
    study_file_make("real.db", &(struct study_desc){0});
    study_file_make("torn.db", &(struct study_desc){0});
    assert_int_equal(truncate("torn.db", 6000), 0);
    FILE *file = fopen("text.db", "w");
    fputs("this is not a database, but a text of more than a hundred bytes, so that SQLite looks at its head, "
          "and sees none",
          file);
    fclose(file);
    fclose(fopen("nothing.db", "w"));
    for (int i = 0; i < 3; i++) {
        const char *c = commands[i];
        expect_sentence(FOVSTATS(c, "missing.db"), 1, "missing.db: there is no such file");
        expect_sentence(FOVSTATS(c, "."), 1, ".: is not a file");
        expect_sentence(FOVSTATS(c, "text.db"), 1, "text.db: is not a study file (not an SQLite database)");
        expect_sentence(FOVSTATS(c, "nothing.db"), 1, "nothing.db: is not a study file (the file is empty)");
        expect_sentence(FOVSTATS(c, "other.db"), 1, "other.db: is another program's database");
        expect_sentence(FOVSTATS(c, "newer.db"), 1, "newer.db: was written by a newer program (version 999");
        expect_sentence(FOVSTATS(c, "older.db"), 1, "older.db: is of an older version");
        expect_sentence(FOVSTATS(c, "torn.db"), 1, "torn.db: the study file is damaged");
        expect_sentence(FOVSTATS(c, "empty.db"), 1, "empty.db: the study is empty");
        expect_sentence(FOVSTATS(c, "simulated.db"), 1,
                        "only simulated sessions (22) are in it; add --simulated");
        expect_sentence(FOVSTATS(c, "real.db", "--simulated"), 1, "holds sessions of people");
        expect_sentence(FOVSTATS(c, "simulated.db", "real.db", "--simulated"), 1,
                        "real.db: holds sessions of people");
        expect_sentence(FOVSTATS(c, "real.db", "./real.db"), 1, "is given twice");
    }
    expect_sentence(FOVSTATS("choices", "bare.db"), 1, "bare.db: no choice was recorded");
    expect_sentence(FOVSTATS("ratings", "bare.db"), 1, "bare.db: no rating of an option was recorded");
    expect_sentence(FOVSTATS("frames", "bare.db"), 1, "bare.db: no frame was recorded");
    const char *cp[] = {"/bin/cp", "real.db", "copy.db", NULL};
    struct program_result r = program_run(cp, NULL);
    program_free(&r);
    expect_sentence(FOVSTATS("choices", "real.db", "copy.db"), 1, "is also in real.db");
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

// --- numbers ---

static void choices_agree_with_r(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    struct program_result r = FOVSTATS("choices", "s.db", "--json");
    assert_int_equal(r.code, 0);
    const char *cells[] = {"\"epsilon\":0.2}", "\"epsilon\":0.05}"};
    const char *keys[] = {"p_value", "ci_low", "ci_high", "toggles_mean", "toggles_sd", "reaction_s_median"};
    for (int cell = 0; cell < 2; cell++)
        for (int i = 0; i < 6; i++) {
            char name[64];
            snprintf(name, sizeof name, "cell%d.%s", cell + 1, keys[i]);
            expect_number(r.out, cells[cell], keys[i], name);
        }
    assert_true(json_after(r.out, cells[0], "k") == 6 && json_after(r.out, cells[0], "n") == 22);
    assert_true(json_after(r.out, cells[0], "null_low") == 6 && json_after(r.out, cells[0], "null_high") == 16);
    assert_true(json_after(r.out, cells[1], "k") == 4 && json_after(r.out, cells[1], "n") == 19);
    assert_true(json_after(r.out, cells[1], "null_low") == 5 && json_after(r.out, cells[1], "null_high") == 14);
    // Holm: the smaller p twice, and no less for the other
    double p[] = {json_after(r.out, cells[0], "p_value"), json_after(r.out, cells[1], "p_value")};
    assert_true(json_after(r.out, cells[1], "p_holm") == 2 * p[1] &&
                json_after(r.out, cells[0], "p_holm") == p[0]);
    assert_true(json_after(r.out, "left_out", "not_done") == 3);
    assert_null(strstr(r.out, "\"several_answers\":true"));
    assert_non_null(strstr(r.out, "\"overdispersion\":null"));
    assert_null(strstr(r.out, "\"pooled\""));
    program_free(&r);
    r = FOVSTATS("choices", "s.db");
    expect_golden(r.out, "choices.txt");
    program_free(&r);
}

static void choices_say_what_they_left_out(void **state)
{
    (void)state;
    study_file_make("x.db", &(struct study_desc){.excluded = true, .pooled = true});
    struct program_result r = FOVSTATS("choices", "x.db");
    assert_non_null(strstr(r.out, "Several answers per person: people are tested, not answers"));
    assert_non_null(strstr(r.out, "Warning: pooled"));
    assert_non_null(strstr(r.out, "session 22 of participant P22 (excluded)"));
    assert_null(strstr(r.out, "participant P01")); // the stricter rule is not applied
    program_free(&r);
    r = FOVSTATS("choices", "x.db", "--json");
    assert_true(json_after(r.out, "\"epsilon\":0.2}", "k") == 7 &&
                json_after(r.out, "\"epsilon\":0.2}", "n") == 22);
    assert_true(json_after(r.out, "\"epsilon\":0.2}", "participants") == 21);
    assert_true(json_after(r.out, "{", "sessions_excluded") == 1);
    program_free(&r);
    study_file_make("e.db", &(struct study_desc){.equal = true});
    r = FOVSTATS("choices", "e.db", "--json");
    assert_true(json_after(r.out, "\"epsilon\":0.2}", "n") == 21 &&
                json_after(r.out, "\"epsilon\":0.2}", "equal") == 1);
    program_free(&r);
}

// A column of people.csv's row of this study.
static double of_people(const char *column)
{
    FILE *file = reference_open("people.csv");
    char heading[1024], line[4096];
    double value = (double)NAN;
    assert_non_null(fgets(heading, sizeof heading, file));
    heading[strcspn(heading, "\n")] = '\0';
    while (fgets(line, sizeof line, file)) {
        if (strncmp(line, "small study,", 12) != 0)
            continue;
        line[strcspn(line, "\n")] = '\0';
        char *names = heading, *rest = line;
        const char *name, *field;
        while ((name = reference_field(&names, ',')) && (field = reference_field(&rest, ',')))
            if (strcmp(name, column) == 0)
                value = reference_number(field);
        break;
    }
    fclose(file);
    assert_true(!isnan(value));
    return value;
}

static void expect_of_people(const char *json, const char *place, const char *key, const char *column,
                             double most)
{
    double value = json_after(json, place, key), known = of_people(column);
    if (!(fabs(value - known) <= most))
        fail_msg("%s: %.17g, R %.17g", key, value, known);
}

// planned.csv has two one-sided tests by R, a line per cell.
static double planned_margin_p(const char *cell)
{
    char line[256], name[64];
    double p = (double)NAN;
    FILE *file = reference_open("planned.csv");
    snprintf(name, sizeof name, "margin cell %s,", cell);
    while (fgets(line, sizeof line, file))
        if (strncmp(line, name, strlen(name)) == 0)
            p = strtod(line + strlen(name), NULL);
    fclose(file);
    assert_true(p >= 0);
    return p;
}

static void the_protocols_margin_is_the_default(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    study_file_sql("s.db", "UPDATE session SET settings = json_set(settings, '$.planned', json('[{\"method\":"
                           "\"binomial\",\"of\":\"choice\",\"per\":\"cell\",\"margin\":0.2}]'))");
    struct program_result r = FOVSTATS("choices", "s.db", "--json");
    assert_int_equal(r.code, 0);
    assert_true(json_after(r.out, "equivalence", "margin") == 0.2);
    assert_true(reference_close(json_after(r.out, "equivalence", "p_value"), planned_margin_p("0.2"), 1e-12));
    program_free(&r);
    r = FOVSTATS("choices", "s.db");
    assert_non_null(strstr(r.out, "Equivalence: is the preference within 0.3 to 0.7?"));
    assert_non_null(strstr(r.out, "The margin is the protocol's."));
    program_free(&r);
    r = FOVSTATS("choices", "s.db", "--margin", "0.1");
    assert_non_null(strstr(r.out, "Equivalence: is the preference within 0.4 to 0.6?"));
    assert_null(strstr(r.out, "The margin is the protocol's."));
    program_free(&r);
    r = FOVSTATS("choices", "s.db", "--p", "0.6");
    assert_null(strstr(r.out, "Equivalence:"));
    assert_non_null(strstr(r.out, "The protocol's margin of equivalence is about one half"));
    program_free(&r);
}

static void several_answers_agree_with_r(void **state)
{
    (void)state;
    study_file_make("v.db", &(struct study_desc){.several = true});
    struct program_result r = FOVSTATS("choices", "v.db", "--json");
    assert_int_equal(r.code, 0);
    const char *cell = "\"epsilon\":0.2}";
    assert_true(json_after(r.out, cell, "k") == 92 && json_after(r.out, cell, "n") == 198);
    expect_of_people(r.out, cell, "p_value", "flip_two", 1e-13);
    expect_of_people(r.out, cell, "estimate", "share", 1e-13);
    expect_of_people(r.out, cell, "ci_low", "t_low", 1e-12);
    expect_of_people(r.out, cell, "ci_high", "t_high", 1e-12);
    expect_of_people(r.out, cell, "overdispersion", "dispersion", 1e-10);
    expect_of_people(r.out, "\"sign_flip\"", "p_value", "flip_two", 1e-13);
    expect_of_people(r.out, "\"t\":{", "p_value", "t_p", 1e-12);
    expect_of_people(r.out, "\"mixed_model\"", "intercept", "glmer_intercept", 1e-3);
    expect_of_people(r.out, "\"mixed_model\"", "std_error", "glmer_error", 1e-3);
    expect_of_people(r.out, "\"mixed_model\"", "sd", "glmer_sd", 1e-3);
    expect_of_people(r.out, "\"mixed_model\"", "log_likelihood", "loglik", 1e-6);
    expect_of_people(r.out, "\"mixed_model\"", "population", "population", 1e-5);
    assert_true(json_after(r.out, "\"sign_flip\"", "least_p") == ldexp(1, 1 - 22));
    assert_non_null(strstr(r.out, "\"method\":\"sign-flip\""));
    assert_non_null(strstr(r.out, "\"method\":\"binomial\"")); // the other cell
    const char *keys[] = {"estimate", "t", "df", "p_value", "ci_low", "ci_high"};
    for (int i = 0; i < 6; i++) {
        char name[64];
        snprintf(name, sizeof name, "contrast.%s", keys[i]);
        expect_number(strstr(r.out, "\"contrasts\""), "\"estimate\":", keys[i], name);
    }
    assert_true(json_after(r.out, "\"contrasts\"", "people") == 19);
    double pooled = json_after(r.out, "\"pooled\"", "p_value");
    assert_true(fabs(pooled - 0.3556) < 5e-5); // binom.test(92, 198)
    program_free(&r);
    r = FOVSTATS("choices", "v.db");
    expect_golden(r.out, "choices_several.txt");
    program_free(&r);
    r = FOVSTATS("choices", "v.db", "--p", "0.6", "--alternative", "greater", "--json");
    assert_non_null(strstr(r.out, "\"method\":\"t\""));
    assert_null(strstr(r.out, "\"sign_flip\""));
    expect_of_people(r.out, cell, "p_value", "t_p6", 1e-12);
    program_free(&r);
    study_file_sql("v.db", "DELETE FROM choice WHERE trial_id IN (SELECT id FROM trial WHERE session_id > 5)");
    r = FOVSTATS("choices", "v.db");
    assert_non_null(strstr(
        r.out,
        "5 of 5 people did not choose both equally often; with so many the sign-flip p is never below 0.062 "
        "and cannot reach 0.05"));
    program_free(&r);
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

static void ratings_agree_with_r(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    struct program_result r = FOVSTATS("ratings", "s.db", "--json");
    assert_int_equal(r.code, 0);
    const char *places[] = {"\"first\":\"regular\"", "\"first\":\"time_warped", "first_between_groups"};
    const char *names[] = {"regular_first", "test_first", "between"};
    const char *keys[] = {"estimate", "t", "df", "p_value", "ci_low", "ci_high"};
    for (int place = 0; place < 3; place++)
        for (int i = 0; i < 6; i++) {
            char name[64];
            snprintf(name, sizeof name, "%s.%s", names[place], keys[i]);
            expect_number(r.out, places[place], keys[i], name);
        }
    assert_true(json_after(r.out, places[0], "n") == 9 && json_after(r.out, places[1], "n") == 11);
    assert_true(fabs(json_after(r.out, places[0], "p_value") - 0.0092) < 5e-5);
    assert_true(fabs(json_after(r.out, places[1], "p_value") - 0.0959) < 5e-5);
    assert_true(json_after(r.out, "{", "unpaired_sessions") == 2);
    program_free(&r);
    r = FOVSTATS("ratings", "s.db");
    expect_golden(r.out, "ratings.txt");
    program_free(&r);
}

static void frames_agree_with_r(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    struct program_result r = FOVSTATS("frames", "s.db", "--json");
    assert_int_equal(r.code, 0);
    const char *places[] = {"\"option\":\"regular\"", "\"option\":\"time_warped"},
               *names[] = {"regular", "test"};
    const char *keys[] = {"median", "p95", "p99"};
    for (int place = 0; place < 2; place++)
        for (int i = 0; i < 3; i++) {
            char name[64];
            snprintf(name, sizeof name, "%s.%s", names[place], keys[i]);
            expect_number(r.out, places[place], keys[i], name);
        }
    assert_true(json_after(r.out, places[0], "frames") == 100 && json_after(r.out, places[0], "late") == 20);
    assert_true(json_after(r.out, places[1], "late") == 0);
    assert_true(json_after(r.out, "{", "frames") == 201);
    program_free(&r);
    r = FOVSTATS("frames", "s.db");
    expect_golden(r.out, "frames.txt");
    program_free(&r);
}

// One person in two sessions: two answers in one cell are that person's, and ratings say how they count.
static void repeated_people_are_said(void **state)
{
    (void)state;
    study_file_make("p.db", &(struct study_desc){0});
    study_file_sql("p.db", "UPDATE session SET participant_id = 1 WHERE id = 2");
    struct program_result r = FOVSTATS("choices", "p.db");
    assert_non_null(strstr(r.out, "Several answers per person"));
    assert_non_null(strstr(r.out, "People with several sessions: 1."));
    program_free(&r);
    r = FOVSTATS("ratings", "p.db");
    assert_non_null(strstr(r.out, "People with several sessions: 1."));
    assert_null(strstr(r.out, "somebody rated in both orders"));
    program_free(&r);
    // The two sittings of one order are one person's; of 11 and 9 people 10 and 9 are left.
    r = FOVSTATS("ratings", "p.db", "--json");
    assert_non_null(strstr(r.out, "\"n\":10,"));
    assert_null(strstr(r.out, "\"n\":11,"));
    program_free(&r);
    // Somebody in both groups makes them dependent: no Welch test.
    study_file_sql("p.db", "UPDATE session SET participant_id = 1 WHERE id = 12");
    r = FOVSTATS("ratings", "p.db");
    assert_non_null(strstr(r.out, "First ratings are not compared: somebody rated in both orders."));
    program_free(&r);
}

// Of a question with a right answer the right ones are counted, whichever option that was.
static void right_answers_are_no_preferences(void **state)
{
    (void)state;
    study_file_make("r.db", &(struct study_desc){0});
    study_file_sql("r.db", "UPDATE choice SET correct = id % 11 > 0");
    struct program_result r = FOVSTATS("choices", "r.db");
    assert_non_null(strstr(r.out, "epsilon 0.2, right answers"));
    assert_null(strstr(r.out, "  6  22"));
    program_free(&r);
    r = FOVSTATS("choices", "r.db", "--json");
    assert_null(strstr(r.out, "\"right_answers\":false"));
    program_free(&r);
    r = FOVSTATS("report", "r.db", "-o", "r.html");
    assert_int_equal(r.code, 0);
    program_free(&r);
    char page[400000] = "";
    FILE *file = fopen("r.html", "r");
    assert_non_null(file);
    assert_true(fread(page, 1, sizeof page - 1, file) > 0);
    fclose(file);
    assert_non_null(strstr(page, "answers were right more often than by guessing for"));
    assert_non_null(strstr(page, "right more often</td>"));
    assert_null(strstr(page, "the reference was preferred"));
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
    assert_true(json_after(r.out, "{", "participants") == 44);
    assert_true(json_after(r.out, "\"epsilon\":0.2}", "k") == 12 &&
                json_after(r.out, "\"epsilon\":0.2}", "n") == 44);
    assert_null(strstr(r.out, "\"several_answers\":true"));
    program_free(&r);
}

// Cells of one level that differ in a parameter that is no factor are told apart by their options.
static void labels_tell_cells_apart(void **state)
{
    (void)state;
    study_file_make("h.db", &(struct study_desc){0});
    study_file_sql("h.db",
                   "INSERT INTO condition VALUES(4, 'time_warped', '{\"epsilon\":0.2,\"fovea_deg\":20}');"
                   "UPDATE trial SET option_a = 4 WHERE option_a = 2 AND kind = 'toggle'");
    struct program_result r = FOVSTATS("choices", "h.db"), page = FOVSTATS("report", "h.db", "-o", "h.html");
    assert_int_equal(r.code, 0);
    assert_int_equal(page.code, 0);
    assert_non_null(strstr(r.out, "fovea_deg 10 or regular"));
    assert_non_null(strstr(r.out, "fovea_deg 20 or regular"));
    program_free(&r);
    program_free(&page);
}

static void equivalence_needs_a_margin(void **state)
{
    (void)state;
    study_file_make("q.db", &(struct study_desc){.several = true});
    struct program_result none = FOVSTATS("choices", "q.db"),
                          some = FOVSTATS("choices", "q.db", "--margin", "0.2"),
                          wide = FOVSTATS("choices", "q.db", "--margin", "0.6"),
                          low = FOVSTATS("choices", "q.db", "--margin", "0.1", "--conf", "0.4");
    assert_null(strstr(none.out, "Equivalence"));
    assert_non_null(strstr(some.out, "within 0.3 to 0.7"));
    assert_non_null(strstr(some.out, "equality within the margin is shown"));
    assert_non_null(strstr(some.out, "exact binomial"));
    assert_true(wide.code == 2 && strstr(wide.err, "--margin is 0.6"));
    assert_true(low.code == 2 && strstr(low.err, "more than 0.5"));
    struct program_result *all[] = {&none, &some, &wide, &low};
    for (size_t i = 0; i < 4; i++)
        program_free(all[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(binom_prints),
        cmocka_unit_test(binom_prints_all),
        cmocka_unit_test(no_difference_is_not_equality),
        cmocka_unit_test(wrong_use),
        cmocka_unit_test(help_everywhere),
        cmocka_unit_test(unreadable_files),
        cmocka_unit_test(reading_changes_nothing),
        cmocka_unit_test(choices_agree_with_r),
        cmocka_unit_test(the_protocols_margin_is_the_default),
        cmocka_unit_test(several_answers_agree_with_r),
        cmocka_unit_test(choices_say_what_they_left_out),
        cmocka_unit_test(simulated_is_said),
        cmocka_unit_test(ratings_agree_with_r),
        cmocka_unit_test(frames_agree_with_r),
        cmocka_unit_test(repeated_people_are_said),
        cmocka_unit_test(right_answers_are_no_preferences),
        cmocka_unit_test(labels_tell_cells_apart),
        cmocka_unit_test(equivalence_needs_a_margin),
        cmocka_unit_test(files_add_up),
    };
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
