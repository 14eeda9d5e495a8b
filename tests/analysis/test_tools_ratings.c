// fovstats ratings and frames: numbers against R (tests/reference/small_study.R), text against golden files.
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
            said_number(r.out, places[place], keys[i], name);
        }
    assert_true(said_after(r.out, places[0], "n") == 9 && said_after(r.out, places[1], "n") == 11);
    assert_true(fabs(said_after(r.out, places[0], "p_value") - 0.0092) < 5e-5);
    assert_true(fabs(said_after(r.out, places[1], "p_value") - 0.0959) < 5e-5);
    assert_true(said_after(r.out, "{", "unpaired_sessions") == 2);
    assert_non_null(strstr(r.out, "\"first_between_groups_is\":\"regular minus time_warped epsilon 0.2\""));
    program_free(&r);
    r = FOVSTATS("ratings", "s.db");
    said_golden(r.out, "ratings.txt");
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
            said_number(r.out, places[place], keys[i], name);
        }
    assert_true(said_after(r.out, places[0], "frames") == 100 && said_after(r.out, places[0], "late") == 20);
    assert_true(said_after(r.out, places[1], "late") == 0);
    assert_true(said_after(r.out, "{", "frames") == 201);
    program_free(&r);
    r = FOVSTATS("frames", "s.db");
    said_golden(r.out, "frames.txt");
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ratings_agree_with_r),
        cmocka_unit_test(frames_agree_with_r),
        cmocka_unit_test(repeated_people_are_said),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
