// What is said about a disk in trouble, and a clock that goes back. trouble_test.sh has the whole program.
#include "app/session/trouble.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int heard;
static char last_sentence[TROUBLE_SENTENCE + 64];

static void hear(void *user, const char *sentence)
{
    (void)user;
    heard++;
    snprintf(last_sentence, sizeof last_sentence, "%s", sentence);
}

static void trouble_is_said_once(void **state)
{
    (void)state;
    struct trouble trouble = {.say = hear};
    heard = 0;
    trouble_over(&trouble, 5);
    assert_int_equal(heard, 0);
    for (int64_t now = 0; now < 10; now++)
        trouble_tell(&trouble, now, "the disk is full");
    assert_int_equal(heard, 1);
    assert_string_equal(last_sentence, "please wait: the disk is full");
    assert_false(trouble_due(&trouble, 9 + TROUBLE_RETRY_NS - 1));
    assert_true(trouble_due(&trouble, 9 + TROUBLE_RETRY_NS));
    trouble_tell(&trouble, 20, "the file is gone");
    assert_int_equal(heard, 2);
    trouble_over(&trouble, 2500000000);
    assert_int_equal(heard, 3);
    assert_non_null(strstr(last_sentence, "2.5 s"));
    assert_false(trouble_due(&trouble, INT64_MAX));
}

static void a_clock_that_goes_back_stands_still(void **state)
{
    (void)state;
    struct steady_clock clock = {0};
    int64_t back = -1;
    assert_int_equal(steady_clock_take(&clock, -50, &back), -50);
    assert_int_equal(steady_clock_take(&clock, 100, &back), 100);
    assert_int_equal(back, 0);
    assert_int_equal(steady_clock_take(&clock, -900, &back), 100);
    assert_int_equal(back, 1000);
    assert_int_equal(steady_clock_take(&clock, -890, &back), 110); // and goes on from there
    assert_int_equal(back, 0);
    assert_int_equal(steady_clock_take(&clock, -891, &back), 110);
    assert_int_equal(back, 1);
    assert_int_equal(steady_clock_take(&clock, 0, &back), 1001);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trouble_is_said_once),
        cmocka_unit_test(a_clock_that_goes_back_stands_still),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
