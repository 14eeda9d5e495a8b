// Statistics of fovbench against values computed by hand, the Pareto front against brute force, CSV cells there
// and back, the box filter and the axis's ticks.
#include "app/chart/chart.h"
#include "app/command/walk.h"
#include "app/fovbench/csv.h"
#include "app/fovbench/pareto.h"
#include "app/fovbench/passes.h"
#include "app/fovbench/series.h"
#include "app/fovbench/supersample.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fmax(1, fabs(expected))))
        print_error("%.17g, expected %.17g\n", value, expected);
    assert_true(fabs(value - expected) <= 1e-9 * fmax(1, fabs(expected)));
}

static void fill(struct series *series, const double *gpu_ms, size_t count)
{
    assert_true(series_init(series, count));
    for (size_t i = 0; i < count; i++) {
        const struct frame_stats stats = {.gpu_ms = gpu_ms[i], .cpu_ms = gpu_ms[i] / 10, .shaded_px = 100 * i};
        series_add(series, &stats, i % 2 ? (double)NAN : 0.25 * (double)i);
    }
}

// 1..21 in another order: place (n - 1) p of the sorted values, so 11, 20 and 20.8.
static void quantiles_are_type_7(void **state)
{
    (void)state;
    struct series series;
    struct series_times times;
    double values[21];
    for (int i = 0; i < 21; i++)
        values[i] = 1 + (8 * i) % 21;
    fill(&series, values, 21);
    assert_true(series_times(&series, &times));
    near(times.gpu_ms_median, 11);
    near(times.gpu_ms_p95, 20);
    near(times.gpu_ms_p99, 20.8);
    near(times.cpu_ms_median, 1.1);
    series_finish(&series);
}

static void work_is_a_mean(void **state)
{
    (void)state;
    struct series series;
    struct series_work work;
    const double values[] = {1, 2, 3, 4, 5};
    fill(&series, values, 5);
    series.samples[2].redraw = FRAME_REDRAW_CUT;
    series_work(&series, &work);
    near(work.shaded_px, 200);
    near(work.moving_share, 0.5); // of 0, 0.5 and 1
    assert_int_equal(work.redraws[FRAME_REDRAW_CUT], 1);
    assert_int_equal(work.redraws[FRAME_REDRAW_NONE], 4);
    series_finish(&series);
}

// The ratio is the median of the frames' ratios, not the ratio of medians.
static void ratios_are_of_frames(void **state)
{
    (void)state;
    struct series reference, own;
    struct series_ratio ratio;
    const double a[] = {10, 20, 90}, b[] = {5, 20, 30};
    fill(&reference, a, 3);
    fill(&own, b, 3);
    assert_true(series_ratio(&reference, &own, &ratio));
    near(ratio.median, 2); // of 2, 1, 3
    assert_true(isnan(ratio.low) && isnan(ratio.high));
    series_finish(&reference);
    series_finish(&own);
}

// The ranks of the binomial distribution at 95 %: n = 6: 1 and 6 (coverage 0.969), n = 20: 6 and 15 (0.959), n
// = 100: 40 and 61 (0.965). qbinom(0.025, n, 0.5) of R is the lower rank where P(B < k) <= 0.025.
static void intervals_are_order_statistics(void **state)
{
    (void)state;
    static const struct {
        size_t count;
        double low, high;
    } cases[] = {{6, 1, 6}, {20, 6, 15}, {100, 40, 61}};
    double values[2000];
    for (int i = 0; i < 2000; i++)
        values[i] = i + 1;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct series_ratio ratio = series_median_interval(values, cases[i].count);
        near(ratio.low, cases[i].low);
        near(ratio.high, cases[i].high);
    }
    assert_true(isnan(series_median_interval(values, 5).low));
    struct series_ratio many = series_median_interval(values, 2000); // no underflow far out
    assert_true(many.low > 950 && many.low < 1000 && many.low + many.high == 2001);
}

static void passes_fall_into_groups(void **state)
{
    (void)state;
    static const struct row_pass passes[] = {
        {"reproject", 1}, {"g-buffer", 2}, {"cull", 4}, {"tone map", 8}, {"xyz", 16}};
    double ms[PASS_GROUPS];
    pass_groups(passes, 5, ms);
    near(ms[PASS_REPROJECT], 1);
    near(ms[PASS_RENDER], 6);
    near(ms[PASS_TONEMAP], 8);
    near(ms[PASS_OTHER], 16);
    near(ms[PASS_SSAO], 0);
    pass_groups(passes, 0, ms);
    assert_true(isnan(ms[PASS_RENDER]));
}

static void pass_times_sum_by_name(void **state)
{
    (void)state;
    struct pass_series passes;
    const struct frame_stats first = {.timer_count = 3, .timers = {{"a", 1}, {"b", 5}, {"a", 2}}};
    const struct frame_stats second = {.timer_count = 1, .timers = {{"a", 7}}};
    assert_true(pass_series_init(&passes, 2));
    pass_series_add(&passes, &first);
    pass_series_add(&passes, &second);
    assert_int_equal(passes.pass_count, 2);
    near(pass_series_median_ms(&passes, 0), 5);   // of 3 and 7
    near(pass_series_median_ms(&passes, 1), 2.5); // of 5 and none
    pass_series_finish(&passes);
}

static bool beaten(const double *a, const double *b, size_t count, size_t i)
{
    for (size_t j = 0; j < count; j++)
        if (a[j] <= a[i] && b[j] <= b[i] && (a[j] < a[i] || b[j] < b[i]))
            return true;
    return false;
}

static void front_agrees_with_brute_force(void **state)
{
    (void)state;
    uint32_t random = 1;
    for (int trial = 0; trial < 500; trial++) {
        double a[40], b[40];
        bool on_front[40];
        size_t count = (size_t)trial % 40 + 1;
        for (size_t i = 0; i < count; i++) {
            random = random * 1664525u + 1013904223u;
            a[i] = random >> 28; // few values: ties
            b[i] = random >> 24 & 15;
            if (trial % 7 == 0 && i == 0)
                a[i] = (double)NAN;
            if (trial % 5 == 0 && i == 1)
                b[i] = trial % 2 ? (double)INFINITY : -(double)INFINITY;
        }
        assert_true(pareto_front(a, b, count, on_front));
        for (size_t i = 0; i < count; i++)
            assert_int_equal(on_front[i], !isnan(a[i]) && !isnan(b[i]) && !beaten(a, b, count, i));
    }
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void cells_come_back(void **state)
{
    (void)state;
    const char *path = BUILD_DIR "/tests/bench_cells.csv";
    struct csv_table table;
    char error[512];
    write_text(path, "name,value,more\n\"a, \"\"b\"\"\r\nc\",inf,\r\nplain,-2.5e3,\"\"\n");
    assert_true(csv_read(&table, path, error, sizeof error));
    assert_int_equal(table.row_count, 2);
    assert_int_equal(table.column_count, 3);
    assert_string_equal(csv_cell(&table, 0, csv_column(&table, "name")), "a, \"b\"\r\nc");
    assert_true(isinf(csv_number(&table, 0, csv_column(&table, "value"))));
    near(csv_number(&table, 1, csv_column(&table, "value")), -2500);
    assert_true(isnan(csv_number(&table, 1, csv_column(&table, "more"))));
    assert_int_equal(csv_column(&table, "nothing"), -1);
    assert_string_equal(csv_cell(&table, 0, -1), "");
    csv_finish(&table);
    static const char *const bad[] = {"", "a,b\n1\n", "a,b\n1,2,3\n", "a\n\"open", "a\n\"x\"y\n"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        write_text(path, bad[i]);
        assert_false(csv_read(&table, path, error, sizeof error));
        assert_non_null(strstr(error, "bench_cells.csv"));
    }
    remove(path);
    assert_false(csv_read(&table, path, error, sizeof error));
}

// A row of text with quotes, as it is written, reads back the same.
static void rows_read_back(void **state)
{
    (void)state;
    const char *path = BUILD_DIR "/tests/bench_rows.csv";
    struct row row = {.device = "Card, \"big\"",
                      .scene = "s",
                      .mode = "m",
                      .parameters = "{\"a\":1,\"b\":\"c\"}",
                      .gaze = "1,2",
                      .width = 64,
                      .height = 72,
                      .frames = 6,
                      .error = {.psnr_db = (double)INFINITY, .ssim = (double)NAN}};
    struct csv_table table;
    char error[512];
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    csv_write_header(file);
    csv_write_row(file, &row);
    fclose(file);
    assert_true(csv_read(&table, path, error, sizeof error));
    assert_string_equal(csv_cell(&table, 0, csv_column(&table, "device")), row.device);
    assert_string_equal(csv_cell(&table, 0, csv_column(&table, "parameters")), row.parameters);
    assert_string_equal(csv_cell(&table, 0, csv_column(&table, "gaze")), row.gaze);
    assert_string_equal(csv_cell(&table, 0, csv_column(&table, "psnr_db")), "inf");
    assert_string_equal(csv_cell(&table, 0, csv_column(&table, "ssim")), "");
    csv_finish(&table);
    remove(path);
}

// Black and white average to half of the light: level 188 of sRGB, not 128.
static void box_averages_light(void **state)
{
    (void)state;
    uint8_t in[4 * 4 * 4], out[2 * 2 * 4];
    for (int i = 0; i < 16; i++) {
        uint8_t level = (i % 4 + i / 4) % 2 ? 255 : 0;
        memcpy(in + 4 * i, (uint8_t[]){level, 77, 0, 0}, 4);
    }
    supersample_box(in, 2, 2, 2, out);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(out[4 * i], 188);
        assert_int_equal(out[4 * i + 1], 77);
        assert_int_equal(out[4 * i + 2], 0);
        assert_int_equal(out[4 * i + 3], 255);
    }
}

static void ticks_are_round(void **state)
{
    (void)state;
    double ticks[8];
    assert_int_equal(chart_ticks(0, 10, 6, ticks), 6);
    near(ticks[5], 10);
    assert_int_equal(chart_ticks(-0.03, 0.11, 6, ticks), 3);
    near(ticks[0], 0);
    near(ticks[1], 0.05);
    assert_int_equal(chart_ticks(1, 1, 6, ticks), 0);
    assert_int_equal(chart_ticks(0, (double)INFINITY, 6, ticks), 0);
    for (int i = -8; i < 9; i++) {
        size_t count = chart_ticks(0, 3.7 * pow(10, i), 6, ticks);
        assert_in_range(count, 3, 6);
    }
}

static void gazes_are_read(void **state)
{
    (void)state;
    struct walk_gaze gaze;
    assert_true(walk_gaze_read("script", &gaze) && gaze.script);
    assert_true(walk_gaze_read("centre", &gaze) && !gaze.script && gaze.x_deg == 0 && gaze.y_deg == 0);
    assert_true(walk_gaze_read("-20,15.5", &gaze) && gaze.x_deg == -20 && gaze.y_deg == 15.5);
    static const char *const bad[] = {"", "1", "1,", "a,b", "1,2,3", "nan,0", "0,91", "181,0"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_false(walk_gaze_read(bad[i], &gaze));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantiles_are_type_7),
        cmocka_unit_test(work_is_a_mean),
        cmocka_unit_test(ratios_are_of_frames),
        cmocka_unit_test(intervals_are_order_statistics),
        cmocka_unit_test(passes_fall_into_groups),
        cmocka_unit_test(pass_times_sum_by_name),
        cmocka_unit_test(front_agrees_with_brute_force),
        cmocka_unit_test(cells_come_back),
        cmocka_unit_test(rows_read_back),
        cmocka_unit_test(box_averages_light),
        cmocka_unit_test(ticks_are_round),
        cmocka_unit_test(gazes_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
