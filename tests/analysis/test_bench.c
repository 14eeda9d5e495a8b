// Measurements of speed and error: ratios and front by hand, one sentence with file and line for what cannot be
// read.
#include "analysis/report/bench.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char heading[] = "device,scene,mode,parameters,gpu_ms_median,psnr_db,flip,wpsnr_db\n";

static bool load(struct bench *bench, const char *text, char error[512])
{
    char path[] = "/tmp/fovstats-bench-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    FILE *out = fdopen(file, "w");
    fputs(text, out);
    fclose(out);
    error[0] = '\0';
    bool ok = bench_load(bench, path, error, 512);
    unlink(path);
    return ok;
}

// What a row must be; a speed of 0: not known.
struct expected {
    size_t group, number;
    double speed;
    bool front;
};

static void expect_rows(const struct bench *b, const struct expected *rows, size_t count)
{
    assert_int_equal(b->count, count);
    for (size_t i = 0; i < count; i++) {
        const struct bench_row *row = &b->rows[i];
        bool speed = rows[i].speed == 0 ? isnan(row->speed) : fabs(row->speed - rows[i].speed) < 1e-15;
        if (row->group != rows[i].group || row->number != rows[i].number || !speed ||
            row->front != rows[i].front)
            fail_msg("row %zu: group %zu, number %zu, speed %g, front %d", i, row->group, row->number,
                     row->speed, row->front);
    }
}

static void load_rows(struct bench *b, const char *first_line, const char *rows)
{
    char error[512], text[4096];
    snprintf(text, sizeof text, "%s%s", first_line, rows);
    if (!load(b, text, error))
        fail_msg("%s", error);
}

static void ratios_and_front(void **state)
{
    (void)state;
    struct bench b;
    load_rows(&b, heading,
              "\"card, one\",town,fast,\"{\"\"epsilon\"\":0.2}\",5,30,0.1,31\n"
              "\"card, one\",town,regular,{},10,inf,0,inf\n"
              "\"card, one\",town,near,{},8,40,0.1,41\n"
              "\"card, one\",town,beaten,{},8,40,0.1,40.5\n"
              "\"card, one\",hall,regular,{},20,inf,0,inf\n"
              "\"card, one\",hall,slow,{},40,20,0.2,21\n"); // regular is faster and has no error
    const struct expected rows[] = {{0, 1, 2, true},     {0, 0, 1, true}, {0, 2, 1.25, true},
                                    {0, 3, 1.25, false}, {1, 0, 1, true}, {1, 1, 0.5, false}};
    expect_rows(&b, rows, 6);
    assert_int_equal(b.group_count, 2);
    assert_string_equal(b.groups[1].device, "card, one");
    assert_string_equal(b.groups[1].scene, "hall");
    assert_string_equal(b.groups[1].setting, "");
    assert_string_equal(b.rows[0].parameters, "epsilon 0.2");
    bench_free(&b);
}

// Two files put together, with both headings. Card B's `b` is faster and nearer than anything of card A and
// would beat it all; A's regular would halve B's speeds. Rows of a third card have nothing to compare with.
static void devices_are_compared_with_themselves(void **state)
{
    (void)state;
    struct bench b;
    char text[2048];
    snprintf(text, sizeof text,
             "A,town,regular,{},10,inf,0,inf\nA,town,a,{},5,29,0.1,30\nA,town,b,{},4,24,0.1,25\n%s"
             "B,town,regular,{},20,inf,0,inf\nB,town,a,{},16,39,0.1,40\nB,town,b,{},5,30,0.1,31\n\n"
             "C,town,a,{},2,50,0.1,51\nA,hall,regular,{},3,inf,,inf\nA,hall,a,{},,20,,21\nA,hall,b,{},1,,,\n",
             heading);
    load_rows(&b, heading, text);
    const struct expected rows[] = {{0, 0, 1, true},    {0, 1, 2, true}, {0, 2, 2.5, true}, {1, 0, 1, true},
                                    {1, 1, 1.25, true}, {1, 2, 4, true}, {2, 0, 0, false},  {3, 0, 1, true},
                                    {3, 0, 0, false},   {3, 0, 3, false}};
    expect_rows(&b, rows, 10);
    assert_int_equal(b.group_count, 4);
    const size_t regulars[] = {1, 1, 0, 1}, drawn[] = {2, 2, 0, 0};
    const char *const devices[] = {"A", "B", "C", "A"};
    for (size_t i = 0; i < 4; i++) {
        assert_string_equal(b.groups[i].device, devices[i]);
        assert_int_equal(b.groups[i].regulars, regulars[i]);
        assert_int_equal(b.groups[i].drawn, drawn[i]);
    }
    assert_true(isnan(b.rows[7].flip));
    bench_free(&b);
}

// Sizes, gazes and effects apart, as fovbench's own figures have them; two runs of one place are not mixed, but
// `regular` with other parameters is a mode like others.
static void settings_and_runs_are_not_mixed(void **state)
{
    (void)state;
    static const char whole[] =
        "device,scene,mode,parameters,width,height,gpu_ms_median,psnr_db,flip,wpsnr_db,gaze,ssao,taa,rest\n";
    struct bench b;
    load_rows(
        &b, whole,
        "A,town,regular,x,64,72,10,inf,,inf,script,1,1,0\nA,town,m,{},64,72,5,30,,31,script,1,1,0\n"
        "A,town,regular,x,128,144,30,inf,,inf,script,1,1,0\nA,town,m,{},128,144,10,30,,31,script,1,1,0\n"
        "A,town,regular,x,64,72,8,inf,,inf,\"3,-4\",0,0,1\nA,town,regular,y,64,72,4,inf,,inf,\"3,-4\",0,0,1\n"
        "A,hall,regular,x,64,72,10,inf,,inf,script,0,0,0\nA,hall,m,{},64,72,5,30,,31,script,0,0,0\n"
        "A,hall,regular,x,64,72,9,inf,,inf,script,0,0,0\nA,hall,m,{},64,72,4,30,,31,script,0,0,0\n");
    const struct expected rows[] = {{0, 0, 1, true},  {0, 1, 2, true}, {1, 0, 1, true},  {1, 1, 3, true},
                                    {2, 0, 1, false}, {2, 0, 2, true}, {3, 0, 0, false}, {3, 0, 0, false},
                                    {3, 0, 0, false}, {3, 0, 0, false}};
    expect_rows(&b, rows, 10);
    assert_string_equal(b.groups[0].setting, "64 \u00d7 72 px per eye, gaze script, SSAO, TAA");
    assert_string_equal(b.groups[2].setting, "64 \u00d7 72 px per eye, gaze 3,-4, moving objects at rest");
    assert_int_equal(b.groups[2].regulars, 1);
    assert_int_equal(b.groups[3].regulars, 2);
    bench_free(&b);
}

static void bad_files(void **state)
{
    (void)state;
    const struct {
        const char *rows, *says;
    } cases[] = {
        {"", ": holds no measurement"},
        {"d,town,regular,{},10,inf,0\n", ":2: has 7 fields where the heading has 8"},
        {"d,town,regular,{},10,inf,0,inf\nd,town,m,{},nan,1,0,1\n", ":3: gpu_ms_median is not a number"},
        {"d,town,regular,{},0,inf,0,inf\n", ":2: gpu_ms_median is not a number"},
        {"d,town,regular,{},10,inf,0,x\n", ":2: wpsnr_db is not a number"},
        {"\"d,town,regular,{},10,inf,0,inf\n", ":2: has 0 fields"},
        {"d,town,regular,{},10,inf,-1,inf\n", ":2: flip is not a number"},
        {"d,town,regular,{},10,-inf,0,inf\n", ":2: psnr_db is not a number"},
        {"d,town,regular,{},10,inf,0,inf\ndevice,scene,mode\n", ":3: begins other columns"}};
    struct bench b;
    char error[512], text[2048];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        snprintf(text, sizeof text, "%s%s", heading, cases[i].rows);
        assert_false(load(&b, text, error));
        if (!strstr(error, cases[i].says))
            fail_msg("\"%s\", expected \"%s\"", error, cases[i].says);
    }
    assert_false(load(&b, "a,b\n1,2\n", error));
    assert_non_null(strstr(error, ":1: has no column 'device'"));
    assert_false(load(&b, "", error));
    assert_false(bench_load(&b, "/nowhere/x.csv", error, sizeof error));
    assert_non_null(strstr(error, "/nowhere/x.csv: cannot be read"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ratios_and_front), cmocka_unit_test(devices_are_compared_with_themselves),
        cmocka_unit_test(settings_and_runs_are_not_mixed), cmocka_unit_test(bad_files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
