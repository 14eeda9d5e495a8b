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

static void ratios_and_front(void **state)
{
    (void)state;
    struct bench b;
    char error[512], text[2048];
    snprintf(text, sizeof text,
             "%s\"card, one\",town,fast,\"{\"\"epsilon\"\":0.2}\",5,30,0.1,31\n"
             "\"card, one\",town,regular,{},10,inf,0,inf\n"
             "\"card, one\",town,near,{},8,40,0.1,41\n"
             "\"card, one\",town,beaten,{},8,40,0.1,40.5\n"
             "\"card, one\",hall,regular,{},20,inf,0,inf\n"
             "\"card, one\",hall,slow,{},40,20,0.2,21\n",
             heading);
    if (!load(&b, text, error))
        fail_msg("%s", error);
    assert_int_equal(b.count, 6);
    assert_int_equal(b.scene_count, 2);
    assert_string_equal(b.rows[0].device, "card, one");
    assert_string_equal(b.rows[0].parameters, "epsilon 0.2");
    const double speed[] = {2, 1, 1.25, 1.25, 1, 0.5};
    const size_t number[] = {1, 0, 2, 3, 0, 1};
    const bool front[] = {true, false, true, false, false, true};
    for (int i = 0; i < 6; i++) {
        assert_true(fabs(b.rows[i].speed - speed[i]) < 1e-15);
        assert_int_equal(b.rows[i].number, number[i]);
        assert_int_equal(b.rows[i].front, front[i]);
    }
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
        {"d,town,m,{},10,1,0,1\n", ":2: the scene town has no row of 'regular'"},
        {"d,town,regular,{},10,inf,0,inf\ne,town,m,{},10,1,0,1\n", ":3: the scene town has no row"}};
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(ratios_and_front), cmocka_unit_test(bad_files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
