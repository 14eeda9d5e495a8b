// What a figure's data file gets: intervals that an axis cuts, words that are cut.
#include "analysis/report/figure.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void expect_interval(double low, double high, const char *columns)
{
    char *text = NULL;
    size_t size = 0;
    FILE *data = open_memstream(&text, &size);
    assert_non_null(data);
    figure_interval(data, low, high, -1, 1);
    fclose(data);
    assert_string_equal(text, columns);
    free(text);
}

// The interval as drawn; its own ends; where it goes on.
static void an_end_beyond_the_axis_is_no_end(void **state)
{
    (void)state;
    expect_interval(-0.5, 0.25, "-0.500000 0.250000 -0.500000 0.250000 NaN NaN ");
    expect_interval(-1, 1, "-1.000000 1.000000 -1.000000 1.000000 NaN NaN ");
    expect_interval(-1.01, 0.25, "-1.000000 0.250000 NaN 0.250000 -1.000000 NaN ");
    expect_interval(0.25, 1.01, "0.250000 1.000000 0.250000 NaN NaN 1.000000 ");
    expect_interval(-(double)INFINITY, (double)INFINITY, "-1.000000 1.000000 NaN NaN -1.000000 1.000000 ");
    expect_interval((double)NAN, (double)NAN, "NaN NaN NaN NaN NaN NaN ");
}

static void expect_cut(const char *text, size_t most, const char *cut)
{
    char room[64];
    strcpy(room, text);
    figure_cut(room, most);
    assert_string_equal(room, cut);
}

static void words_are_cut_between_letters(void **state)
{
    (void)state;
    expect_cut("town", 4, "town");
    expect_cut("town", 3, "tow\u2026");
    expect_cut("\u03b5\u03b5\u03b5", 6, "\u03b5\u03b5\u03b5");
    expect_cut("\u03b5\u03b5\u03b5", 5, "\u03b5\u03b5\u2026");
    expect_cut("\u03b5\u03b5\u03b5", 1, "\u2026");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(an_end_beyond_the_axis_is_no_end),
                                       cmocka_unit_test(words_are_cut_between_letters)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
