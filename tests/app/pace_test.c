// At which rate an option counts as held, which frames repeat a picture, and which count as late.
#include "app/session/pace.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static double times[2000];

static void fill(double ms)
{
    for (size_t i = 0; i < 2000; i++)
        times[i] = ms;
}

static void the_largest_held_part_of_the_rate_is_found(void **state)
{
    (void)state;
    static const struct {
        double ms;
        uint32_t divisor;
    } cases[] = {{0.1, 1},  {11.0, 1}, {11.2, 2},   {22.2, 2}, {22.3, 3},
                 {33.3, 3}, {44.0, 4}, {199.0, 18}, {201.0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        fill(cases[i].ms);
        assert_int_equal(pace_held(times, 2000, 90.0, 0.0), cases[i].divisor);
    }
    fill(15.0); // waiting for the screen: one refresh, with its jitter
    assert_int_equal(pace_held(times, 2000, 90.0, 0.5), 1);
    fill(22.2);
    assert_int_equal(pace_held(times, 2000, 90.0, 0.5), 2);
}

// 0.1 % and no more.
static void two_in_two_thousand_may_be_late(void **state)
{
    (void)state;
    fill(5.0);
    times[17] = times[1900] = 40.0;
    assert_int_equal(pace_held(times, 2000, 90.0, 0.0), 1);
    times[3] = 12.0;
    assert_int_equal(pace_held(times, 2000, 90.0, 0.0), 2);
    assert_true(pace_late_share(times, 2000, 90.0, 1, 0.0) > 0.00149);
}

// A rate below the least counts where it is the screen's own.
static void a_slow_screen_can_be_held(void **state)
{
    (void)state;
    fill(700.0);
    assert_int_equal(pace_held(times, 2000, 1.0, 0.0), 1);
    assert_int_equal(pace_held(times, 2000, 2.0, 0.0), 0);
}

static const int64_t refresh_ns = 10000000; // 100 Hz

static void pictures_are_repeated_at_the_common_rate(void **state)
{
    (void)state;
    for (uint32_t divisor = 1; divisor < 6; divisor++) {
        struct pace pace;
        uint32_t drawn = 0;
        pace_init(&pace, 100.0);
        pace.divisor = divisor;
        for (int64_t i = 0; i < 60; i++) {
            bool due = pace_due(&pace, PLAN_SLOT_A, i == 0, i * refresh_ns);
            assert_int_equal(due, i % divisor == 0);
            assert_false(pace_late(&pace, true, !due, (i + 1) * refresh_ns));
            drawn += due;
        }
        assert_int_equal(drawn, 60 / divisor);
        assert_int_equal(pace.number, drawn);
        // Another option, and a new showing, are drawn at once.
        assert_true(pace_due(&pace, PLAN_SLOT_B, false, 60 * refresh_ns + 1));
        assert_true(pace_due(&pace, PLAN_SLOT_B, true, 61 * refresh_ns));
    }
}

// A picture that takes both refreshes of its period is followed by the next, not by its repetition.
static void a_slow_picture_and_a_quick_one_have_the_same_rate(void **state)
{
    (void)state;
    struct pace pace;
    pace_init(&pace, 100.0);
    pace.divisor = 2;
    for (int64_t i = 0; i < 10; i++) {
        assert_true(pace_due(&pace, PLAN_SLOT_A, i == 0, 2 * i * refresh_ns));
        assert_false(pace_late(&pace, true, false, 2 * (i + 1) * refresh_ns));
    }
}

static void late_is_judged_against_the_common_rate(void **state)
{
    (void)state;
    struct pace pace;
    pace_init(&pace, 100.0);
    assert_false(pace_late(&pace, false, false, 0));
    assert_false(pace_late(&pace, false, false, refresh_ns));
    assert_true(pace_late(&pace, false, false, 3 * refresh_ns)); // a refresh was missed
    pace.divisor = 3;
    assert_false(pace_late(&pace, true, false, 6 * refresh_ns)); // in time for a third of the rate
    assert_false(pace_late(&pace, true, true, 7 * refresh_ns));
    assert_false(pace_late(&pace, true, true, 8 * refresh_ns));
    assert_false(pace_late(&pace, true, false, 9 * refresh_ns));
    assert_false(pace_late(&pace, true, true, 10 * refresh_ns));
    assert_true(pace_late(&pace, true, false, 13 * refresh_ns)); // the fourth refresh
    assert_false(pace_late(&pace, false, false, 14 * refresh_ns));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_largest_held_part_of_the_rate_is_found),
        cmocka_unit_test(two_in_two_thousand_may_be_late),
        cmocka_unit_test(a_slow_screen_can_be_held),
        cmocka_unit_test(pictures_are_repeated_at_the_common_rate),
        cmocka_unit_test(a_slow_picture_and_a_quick_one_have_the_same_rate),
        cmocka_unit_test(late_is_judged_against_the_common_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
