// Power of what a rehearsal's study file has, as a command, against R (tests/reference/power_plan.R and
// power_simulation.R).
#include "power_row.h"
#include "program.h"
#include "said.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

static void says(const struct program_result *r, const char *part, bool whether)
{
    assert_int_equal(r->code, 0);
    if ((strstr(r->out, part) != NULL) != whether)
        fail_msg("\"%s\" is%s in %s", part, whether ? " not" : "", r->out);
}

// Nine choices of each person in the one cell, one in the other, where the trials of three are invalid.
static void cells_take_the_choices_of_people(void **state)
{
    (void)state;
    study_file_make("r.db", &(struct study_desc){.several = true, .simulated = true});
    struct program_result r = FOVSTATS("power", "r.db", "--simulated", "--share", "0.75", "--participants",
                                       "22", "--sd", "0.5", "--json");
    assert_int_equal(r.code, 0);
    double several = said_after(r.out, "epsilon 0.2\"", "power"),
           one = said_after(r.out, "epsilon 0.05 (the answers of 19 of 22 count)\"", "power");
    assert_true(several > 0.99 &&
                fabs(one - power_row_value("part", 22, 22, 19, 0.75, 0.05, (double)NAN)) < 1e-12);
    assert_non_null(strstr(r.out, "\"data_sha256\":\""));
    assert_true(said_after(r.out, "\"simulates\":true", "studies") == 2000);
    program_free(&r);
}

// What the command says of a cell that only some of the participants are in, against R.
static void compare_part(const char *db, const char *cell, int in, int of)
{
    static const int sizes[] = {1, 2, 11, 22, 23, 44, 100};
    char size[16];
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        snprintf(size, sizeof size, "%d", sizes[i]);
        struct program_result r = FOVSTATS("power", db, "--share", "0.75", "--participants", size, "--json");
        double power = said_after(r.out, cell, "power"),
               known = power_row_value("part", sizes[i], of, in, 0.75, 0.05, (double)NAN);
        if (!(fabs(power - known) < 1e-11))
            fail_msg("%s of %d: %.15g, R %.15g", cell, sizes[i], power, known);
        program_free(&r);
    }
    struct program_result r = FOVSTATS("power", db, "--share", "0.75", "--json"); // exact: needs no sizes
    int looked = 110 * of / in;
    assert_true(said_after(r.out, cell, "people_first") ==
                power_row_value("part_first", looked, of, in, 0.75, 0.05, 0.8));
    assert_true(said_after(r.out, cell, "people_stays") ==
                power_row_value("part_stays", looked, of, in, 0.75, 0.05, 0.8));
    program_free(&r);
}

// A cell of the even people alone, of whom some answer so that it does not count: a study's participants are in
// it as the rehearsal's. Who is excluded is none of them.
static void participants_are_of_the_whole_study(void **state)
{
    (void)state;
    for (int excluded = 0; excluded < 2; excluded++) { // the 22nd
        study_file_make("x.db", &(struct study_desc){.excluded = excluded});
        study_file_sql("x.db",
                       "DELETE FROM choice WHERE trial_id % 20 = 12; DELETE FROM trial WHERE id % 20 = 12");
        struct program_result r = FOVSTATS("power", "x.db", "--share", "0.75", "--participants", "22");
        says(&r, "epsilon 0.2; exact binomial\npeople   power\n", true); // everybody's
        says(&r,
             excluded
                 ? "epsilon 0.05 (10 of 21 participants get this cell) (the answers of 9 of 10 count); exact "
                   "binomial\nparticipants  in this cell   power\n          22             9  "
                 : "epsilon 0.05 (11 of 22 participants get this cell) (the answers of 9 of 11 count); exact "
                   "binomial\nparticipants  in this cell   power\n          22             9  ",
             true);
        says(&r, "participants of the whole study, 30 of them in this cell; from ", true); // 30 of counts.R
        program_free(&r);
        compare_part(
            "x.db",
            excluded ? "epsilon 0.05 (10 of 21 participants get this cell) (the answers of 9 of 10 count)\""
                     : "epsilon 0.05 (11 of 22 participants get this cell) (the answers of 9 of 11 count)\"",
            9, excluded ? 21 : 22);
    }
    study_file_make("whole.db", &(struct study_desc){0});
    compare_part("whole.db", "epsilon 0.05 (the answers of 19 of 22 count)\"", 19, 22);
}

// The first cell, nine choices each, is of every second person: 23 participants have 11 people there, who are
// simulated as a study of 11, which agrees with R (test_power_simulation.c).
static void simulated_people_are_those_in_the_cell(void **state)
{
    (void)state;
    study_file_make("half.db", &(struct study_desc){.several = true});
    study_file_sql(
        "half.db",
        "CREATE TEMP TABLE gone AS SELECT id FROM trial WHERE session_id % 2 = 0 AND factors = "
        "'{\"epsilon\":0.2}'; DELETE FROM choice WHERE trial_id IN (SELECT id FROM gone); DELETE FROM "
        "trial WHERE id IN (SELECT id FROM gone)");
    struct program_result half =
                              FOVSTATS("power", "half.db", "--share", "0.7", "--participants", "23", "--json"),
                          eleven = FOVSTATS("power", "--share", "0.7", "--choices", "9", "--participants", "11",
                                            "--json"),
                          all = FOVSTATS("power", "--share", "0.7", "--choices", "9", "--participants", "23",
                                         "--json"),
                          none = FOVSTATS("power", "half.db", "--share", "0.7", "--participants", "1");
    static const char cell[] = "epsilon 0.2 (11 of 22 participants get this cell)\"";
    double power = said_after(half.out, cell, "power");
    assert_true(said_after(half.out, cell, "in_cell") == 11);
    assert_true(power == said_after(eleven.out, "sizes", "power"));
    assert_true(power < said_after(all.out, "sizes", "power"));
    says(&none, "           1             0  0.0000", true); // nobody is there
    struct program_result *each[] = {&half, &eleven, &all, &none};
    for (size_t i = 0; i < 4; i++)
        program_free(each[i]);
    said_sentence(FOVSTATS("power", "half.db", "--share", "0.7"), 2,
                  "epsilon 0.2 people choose several times, whose power is simulated, size by size");
}

static void what_is_exact_is_not_called_simulated(void **state)
{
    (void)state;
    study_file_make("one.db", &(struct study_desc){0});
    study_file_make("nine.db", &(struct study_desc){.several = true});
    struct program_result one = FOVSTATS("power", "one.db", "--share", "0.75", "--participants", "22"),
                          json =
                              FOVSTATS("power", "one.db", "--share", "0.75", "--participants", "22", "--json"),
                          nine = FOVSTATS("power", "nine.db", "--share", "0.75", "--participants", "22",
                                          "--studies", "100"),
                          typed = FOVSTATS("power", "--share", "0.75", "--participants", "22");
    says(&one, "simulat", false);
    says(&one, "logits", false);
    says(&typed, "simulat", false);
    says(&json, "\"simulates\":false,\"sd\":null,\"studies\":null,\"seed\":null", true);
    says(&nine,
         "Cells in which somebody chooses several times are simulated: people differ by 0.5 logits; 100 "
         "studies a size, seed 1",
         true);
    says(&nine, "epsilon 0.2; simulated sign-flip\npeople   power  95 % of simulation", true);
    says(&nine, "; exact binomial\nparticipants  in this cell   power\n", true);
    struct program_result *all[] = {&one, &json, &nine, &typed};
    for (size_t i = 0; i < 4; i++)
        program_free(all[i]);
}

// The 3rd and the 22nd answer "equal": nobody chooses more than once, so that the test is exact.
static void people_without_a_choice_leave_the_test_exact(void **state)
{
    (void)state;
    static const char cell[] = "epsilon 0.2 (2 of 22 people choose neither)\"";
    static const int sizes[] = {2, 3, 20, 22, 25, 44, 50};
    study_file_make("none.db", &(struct study_desc){0});
    study_file_sql("none.db", "UPDATE choice SET chosen = 'equal' WHERE trial_id IN (31, 221)");
    for (int margin = 0; margin < 2; margin++) {
        const char *what = margin ? "none_margin" : "none", *option = margin ? "--margin" : "--share",
                   *value = margin ? "0.2" : "0.75";
        double share = margin ? 0.5 : 0.75;
        for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
            char people[16], name[48];
            snprintf(people, sizeof people, "%d", sizes[i]);
            struct program_result r =
                FOVSTATS("power", "none.db", option, value, "--participants", people, "--json");
            double power = said_after(r.out, cell, "power"),
                   known = power_row_value(what, sizes[i], 1, 0, share, 0.05, (double)NAN);
            if (!(fabs(power - known) < 1e-11))
                fail_msg("%s of %d: %.15g, R %.15g", what, sizes[i], power, known);
            const char *const ends[] = {"first", "stays"};
            for (int k = 0; k < 2; k++) {
                char key[32];
                snprintf(name, sizeof name, "%s_%s", what, ends[k]);
                snprintf(key, sizeof key, "people_%s", ends[k]);
                assert_true(said_after(r.out, cell, key) == power_row_value(name, 120, 1, 0, share, 0.05, 0.8));
            }
            assert_null(strstr(r.out, "simulated"));
            program_free(&r);
        }
    }
}

// A cell where everybody answers "equal" has nothing to plan; the others have.
static void cells_without_a_choice_are_said(void **state)
{
    (void)state;
    study_file_make("equal.db", &(struct study_desc){0});
    study_file_sql("equal.db", "UPDATE choice SET chosen = 'equal' WHERE trial_id % 10 = 1");
    struct program_result r = FOVSTATS("power", "equal.db", "--share", "0.75", "--participants", "22"),
                          json = FOVSTATS("power", "equal.db", "--share", "0.75", "--participants", "22",
                                          "--json");
    says(&r, "epsilon 0.2; not planned: everybody chose neither", true);
    says(&r, "epsilon 0.05 (the answers of 19 of 22 count); exact binomial", true);
    says(&json, "\"method\":\"not planned: everybody chose neither\",\"sizes\":[]", true);
    program_free(&r);
    program_free(&json);
    study_file_sql("equal.db", "UPDATE choice SET chosen = 'equal'");
    said_sentence(FOVSTATS("power", "equal.db", "--share", "0.75", "--participants", "22"), 1,
                  "equal.db: no choice was recorded");
    said_sentence(FOVSTATS("power", "none.db.db", "--share", "0.7", "--participants", "5"), 1,
                  "none.db.db: there is no such file");
}

// Of a block 'rated' with factors a and b of 3 and 2 levels, by everybody up to `people`; `factors` is their
// JSON.
static void add_rated(const char *path, int people, const char *factors)
{
    char sql[1024];
    snprintf(
        sql, sizeof sql,
        "INSERT INTO trial SELECT 5000 + 100 * s.id + 10 * a.value + b.value, s.id, s.id, 20 + 10 * a.value + "
        "b.value, 'rated', 'rate', 'town', '{}', %s, 1, NULL, NULL, NULL, NULL, 1, NULL, 'done', 1, 0, 1 FROM "
        "session s, json_each('[1,2,3]') a, json_each('[1,2]') b WHERE s.id <= %d; INSERT INTO rating SELECT "
        "NULL, id, NULL, session_id, 'Sharp?', 'a', 1, 1 + id * 7 %% 9, 1, 10, 5 FROM trial WHERE block = "
        "'rated'",
        factors, people);
    study_file_make(path, &(struct study_desc){0});
    study_file_sql(path, sql);
}

static const char two_factors[] = "json_object('a', a.value, 'b', b.value)";

static void designs_come_from_the_file(void **state)
{
    (void)state;
    const double nan = (double)NAN;
    for (int people = 1; people <= 22; people += 21) { // one person shows a design
        add_rated("rated.db", people, two_factors);
        struct program_result r = FOVSTATS("power", "rated.db", "--f", "0.25", "--participants", "22"),
                              json = FOVSTATS("power", "rated.db", "--f", "0.25", "--participants", "22",
                                              "--json");
        says(&r, "Sharp?, rated: levels from the file: a 3 x b 2 (6 cells)\n", true);
        says(&r, "People rate", false);
        says(&json,
             "\"levels_from\":\"file\",\"factors\":[{\"name\":\"a\",\"levels\":3},{\"name\":\"b\",\"levels\":2}"
             "],"
             "\"cells\":6",
             true);
        static const struct {
            const char *cell;
            int df;
        } effects[] = {{"\"a (3)\"", 2}, {"\"b (2)\"", 1}, {"\"a (3) x b (2)\"", 2}};
        for (size_t i = 0; i < 3; i++) {
            double power = power_row_value("anova", 22, 6, effects[i].df, 0.25, 0.05, nan),
                   size = power_row_value("anova_size", 0, 6, effects[i].df, 0.25, 0.05, 0.8);
            assert_true(fabs(said_after(json.out, effects[i].cell, "power") - power) < 1e-11);
            assert_true(said_after(json.out, effects[i].cell, "people_first") == size);
        }
        program_free(&r);
        program_free(&json);
    }
}

static void levels_typed_override_the_file(void **state)
{
    (void)state;
    add_rated("typed.db", 3, two_factors);
    struct program_result r = FOVSTATS("power", "typed.db", "--f", "0.25", "--levels", "2x2"),
                          plain = FOVSTATS("power", "--f", "0.25", "--levels", "2x2"),
                          json = FOVSTATS("power", "typed.db", "--f", "0.25", "--levels", "2x2", "--json"),
                          same = FOVSTATS("power", "--f", "0.25", "--levels", "2x2", "--json");
    says(&r, "Sharp?, rated: the file has a 3 x b 2 (6 cells), which --levels overrides\n", true);
    says(&r, "Levels as typed: A 2 x B 2 (4 cells)\n", true);
    assert_string_equal(strstr(r.out, "Levels as typed"), strstr(plain.out, "Levels as typed"));
    assert_string_equal(json.out, same.out);
    struct program_result *all[] = {&r, &plain, &json, &same};
    for (size_t i = 0; i < 4; i++)
        program_free(all[i]);
}

static void what_is_averaged_or_left_out_is_said(void **state)
{
    (void)state;
    add_rated("twice.db", 3, "json_object('a', a.value, 'c', 1)"); // each level of a twice
    struct program_result r = FOVSTATS("power", "twice.db", "--f", "0.25");
    says(&r,
         "levels from the file: a 3 (3 cells)\nNot analysed: c (one level only).\nPeople rate up to 2 times",
         true);
    program_free(&r);
}

static void files_without_a_design_are_refused(void **state)
{
    (void)state;
    study_file_make("choices.db", &(struct study_desc){0});
    said_sentence(FOVSTATS("power", "choices.db", "--f", "0.25"), 1,
                  "choices.db: no ratings over factors were recorded");
    add_rated("between.db", 22, "json_object('a', a.value, 'b', b.value, 'group', s.id % 2)");
    said_sentence(FOVSTATS("power", "between.db", "--f", "0.25"), 1,
                  "nobody rated two levels of group, and factors between people are not analysed");
    add_rated("partial.db", 3, two_factors);
    study_file_sql("partial.db", "DELETE FROM rating WHERE trial_id % 100 = 11");
    study_file_sql("partial.db",
                   "INSERT INTO rating SELECT NULL, id, NULL, session_id, 'Sharp?', 'a', 1, 3, 1, 10, 5 FROM "
                   "trial WHERE id = 5111; DELETE FROM rating WHERE trial_id = 5112");
    said_sentence(FOVSTATS("power", "partial.db", "--f", "0.25"), 1,
                  "a rating in each of the 6 cells, and there are 0");
    add_rated("large.db", 3, two_factors);
    said_sentence(FOVSTATS("power", "large.db", "--f", "5"), 1,
                  "--f is 5 but F^2 times its 6 cells must be 100 at most");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_take_the_choices_of_people),
        cmocka_unit_test(participants_are_of_the_whole_study),
        cmocka_unit_test(simulated_people_are_those_in_the_cell),
        cmocka_unit_test(what_is_exact_is_not_called_simulated),
        cmocka_unit_test(people_without_a_choice_leave_the_test_exact),
        cmocka_unit_test(cells_without_a_choice_are_said),
        cmocka_unit_test(designs_come_from_the_file),
        cmocka_unit_test(levels_typed_override_the_file),
        cmocka_unit_test(what_is_averaged_or_left_out_is_said),
        cmocka_unit_test(files_without_a_design_are_refused),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
