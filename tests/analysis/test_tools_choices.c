// fovstats choices: numbers against R (tests/reference/small_study.R, people.R), text against golden files.
#include "program.h"
#include "reference.h"
#include "said.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

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
            said_number(r.out, cells[cell], keys[i], name);
        }
    assert_true(said_after(r.out, cells[0], "k") == 6 && said_after(r.out, cells[0], "n") == 22);
    assert_true(said_after(r.out, cells[0], "null_low") == 6 && said_after(r.out, cells[0], "null_high") == 16);
    assert_true(said_after(r.out, cells[1], "k") == 4 && said_after(r.out, cells[1], "n") == 19);
    assert_true(said_after(r.out, cells[1], "null_low") == 5 && said_after(r.out, cells[1], "null_high") == 14);
    // Holm: the smaller p twice, and no less for the other
    double p[] = {said_after(r.out, cells[0], "p_value"), said_after(r.out, cells[1], "p_value")};
    assert_true(said_after(r.out, cells[1], "p_holm") == 2 * p[1] &&
                said_after(r.out, cells[0], "p_holm") == p[0]);
    assert_true(said_after(r.out, "left_out", "not_done") == 3);
    assert_null(strstr(r.out, "\"several_answers\":true"));
    assert_non_null(strstr(r.out, "\"overdispersion\":null"));
    assert_null(strstr(r.out, "\"pooled\""));
    program_free(&r);
    r = FOVSTATS("choices", "s.db");
    said_golden(r.out, "choices.txt");
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
    assert_true(said_after(r.out, "\"epsilon\":0.2}", "k") == 7 &&
                said_after(r.out, "\"epsilon\":0.2}", "n") == 22);
    assert_true(said_after(r.out, "\"epsilon\":0.2}", "participants") == 21);
    assert_true(said_after(r.out, "{", "sessions_excluded") == 1);
    program_free(&r);
    study_file_make("e.db", &(struct study_desc){.equal = true});
    r = FOVSTATS("choices", "e.db", "--json");
    assert_true(said_after(r.out, "\"epsilon\":0.2}", "n") == 21 &&
                said_after(r.out, "\"epsilon\":0.2}", "equal") == 1);
    assert_true(said_after(r.out, "\"epsilon\":0.2}", "participants") ==
                21); // who answered nothing but "equal"
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
    double value = said_after(json, place, key), known = of_people(column);
    if (!(fabs(value - known) <= most))
        fail_msg("%s: %.17g, R %.17g", key, value, known);
}

static void several_answers_agree_with_r(void **state)
{
    (void)state;
    study_file_make("v.db", &(struct study_desc){.several = true});
    struct program_result r = FOVSTATS("choices", "v.db", "--json");
    assert_int_equal(r.code, 0);
    const char *cell = "\"epsilon\":0.2}";
    assert_true(said_after(r.out, cell, "k") == 92 && said_after(r.out, cell, "n") == 198);
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
    assert_true(said_after(r.out, "\"sign_flip\"", "least_p") == ldexp(1, 1 - 22));
    assert_non_null(strstr(r.out, "\"method\":\"sign-flip\""));
    assert_non_null(strstr(r.out, "\"method\":\"binomial\"")); // the other cell
    const char *keys[] = {"estimate", "t", "df", "p_value", "ci_low", "ci_high"};
    for (int i = 0; i < 6; i++) {
        char name[64];
        snprintf(name, sizeof name, "contrast.%s", keys[i]);
        said_number(strstr(r.out, "\"contrasts\""), "\"estimate\":", keys[i], name);
    }
    assert_true(said_after(r.out, "\"contrasts\"", "people") == 19);
    double pooled = said_after(r.out, "\"pooled\"", "p_value");
    assert_true(fabs(pooled - 0.3556) < 5e-5); // binom.test(92, 198)
    program_free(&r);
    r = FOVSTATS("choices", "v.db");
    said_golden(r.out, "choices_several.txt");
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

static void the_protocols_margin_is_the_default(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){0});
    study_file_sql("s.db", "UPDATE session SET settings = json_set(settings, '$.planned', json('[{\"method\":"
                           "\"binomial\",\"of\":\"choice\",\"per\":\"cell\",\"margin\":0.2}]'))");
    struct program_result r = FOVSTATS("choices", "s.db", "--json");
    assert_int_equal(r.code, 0);
    assert_true(said_after(r.out, "equivalence", "margin") == 0.2);
    assert_true(reference_close(said_after(r.out, "equivalence", "p_value"),
                                reference_value("planned.csv", "margin cell 0.2"), 1e-12));
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(choices_agree_with_r),
        cmocka_unit_test(choices_say_what_they_left_out),
        cmocka_unit_test(several_answers_agree_with_r),
        cmocka_unit_test(right_answers_are_no_preferences),
        cmocka_unit_test(labels_tell_cells_apart),
        cmocka_unit_test(equivalence_needs_a_margin),
        cmocka_unit_test(the_protocols_margin_is_the_default),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
