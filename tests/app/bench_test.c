// fovbench as a user runs it: wrong usage, a small real run, comparing crafted files, figures.
#include "tests/app/command.h"

#include "app/fovbench/csv.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char folder[512];

#define BENCH "'" BUILD_DIR "/bin/fovbench' "

// DESIGN section 6, to the letter; further columns only behind these.
static const char columns[] = "device,scene,mode,parameters,width,height,frames,gpu_ms_median,gpu_ms_p95,gpu_"
                              "ms_p99,cpu_ms_median,shaded_px,"
                              "triangles,memory_mb,psnr_db,ssim,flip,wpsnr_db,flicker_excess,flicker_still";

// One sentence on stderr that holds `about`.
static void expect(const struct command_result *result, int status, const char *about)
{
    const char *newline = strchr(result->err, '\n');
    if (result->status != status || !strstr(result->err, about) || !newline || newline[1])
        print_error("status %d (expected %d)\nstderr: %s\nexpected about: %s\n", result->status, status,
                    result->err, about);
    assert_int_equal(result->status, status);
    assert_int_equal(strncmp(result->err, "fovbench", 8), 0);
    assert_non_null(strstr(result->err, about));
    assert_true(newline && !newline[1]);
}

static void wrong_usage_is_exit_2(void **state)
{
    (void)state;
    static const struct {
        const char *line, *about;
    } cases[] = {
        {"--modes flying", "'flying'"},
        {"--modes time_warped:epsilon=2", "epsilon"},
        {"--modes time_warped time_warped:epsilon=0.2", "twice"},
        {"--modes regular:eyes=instanced regular:eyes=instanced", "twice"},
        {"--size 640", "'640'"},
        {"--sizes 64x72 8x8", "'8x8'"},
        {"--gaze up", "'up'"},
        {"--frames 0", "'0'"},
        {"--frames", "wants a value"},
        {"--still-frames 3", "'3'"},
        {"--error-every 0", "'0'"},
        {"--no-errors --supersampled 1", "--no-errors"},
        {"atrium", "'atrium'"},
        {"--ssao atrium", "'atrium'"},
        {"--speed", "'--speed'"},
        {"compare", "OLD.csv"},
        {"compare a.csv", "NEW.csv"},
        {"compare a b c", "'c'"},
        {"figures a.csv", "-o DIR"},
        {"figures -o out", "FILE.csv"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect(command(BENCH "%s", cases[i].line), 2, cases[i].about);
}

static void help_is_exit_0(void **state)
{
    (void)state;
    static const char *const lines[] = {"--help", "compare --help", "figures --help", "--version"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        const struct command_result *result = command(BENCH "%s", lines[i]);
        assert_int_equal(result->status, 0);
        assert_true(result->out[0] && !result->err[0]);
    }
}

// Nothing is measured and nothing is left where an output or a scene is not there.
static void failures_are_exit_1(void **state)
{
    (void)state;
    expect(command(BENCH "--scenes nowhere --csv '%s/none.csv'", folder), 1, "'nowhere'");
    expect(command(BENCH "--scenes /nowhere.glb"), 1, "/nowhere.glb");
    expect(command(BENCH "--csv /nowhere/x.csv"), 1, "/nowhere/x.csv");
    expect(command(BENCH "--json '%s'", folder), 1, folder);
    expect(command(BENCH "compare /nowhere.csv /nowhere.csv"), 1, "/nowhere.csv");
    expect(command(BENCH "figures /nowhere.csv -o '%s/figures'", folder), 1, "/nowhere.csv");
    assert_int_equal(command("ls '%s' | grep -q .", folder)->status, 1);
}

static void check_row(const struct csv_table *table, size_t row)
{
    static const char *const finite[] = {"gpu_ms_median",  "gpu_ms_p95",    "gpu_ms_p99",       "cpu_ms_median",
                                         "shaded_px",      "triangles",     "memory_mb",        "ssim",
                                         "flicker_excess", "flicker_still", "ratio_to_regular", "ratio_low",
                                         "ratio_high",     "moving_share",  "render_ms"};
    const bool regular = strcmp(csv_cell(table, row, csv_column(table, "mode")), "regular") == 0;
    for (size_t i = 0; i < sizeof finite / sizeof finite[0]; i++)
        assert_true(isfinite(csv_number(table, row, csv_column(table, finite[i]))));
    assert_true(csv_number(table, row, csv_column(table, "ratio_to_regular")) > 0);
    double psnr = csv_number(table, row, csv_column(table, "psnr_db"));
    double shaded = csv_number(table, row, csv_column(table, "shaded_px"));
    assert_int_equal(csv_number(table, row, csv_column(table, "frames")), 6);
    assert_true(csv_number(table, row, csv_column(table, "other_ms")) == 0); // every pass has its group
    if (regular) {
        assert_string_equal(csv_cell(table, row, csv_column(table, "psnr_db")), "inf");
        assert_string_equal(csv_cell(table, row, csv_column(table, "wpsnr_db")), "inf");
        assert_int_equal(shaded, 2 * 64 * 72);
        assert_true(csv_number(table, row, csv_column(table, "ssim")) == 1);
    } else {
        assert_true(psnr > 15 && psnr < 80 && shaded > 0 && shaded < 2 * 64 * 72);
    }
}

static void a_small_run_measures(void **state)
{
    (void)state;
    struct csv_table table;
    char path[600], error[512];
    const struct command_result *result = command(
        BENCH "--scenes town:triangles=20000 --modes time_warped time_warped:epsilon=0.05 --size 64x72 "
              "--frames 6 --ssao --taa "
              "--gaze centre 10,5 --pass-times --supersampled 1 --still-frames 4 --csv '%s/run.csv' --json "
              "'%s/run.json' --plot '%s/run.svg' --frames-csv '%s/frames.csv'",
        folder, folder, folder, folder);
    if (result->status == 1 && strstr(result->err, "device"))
        skip();
    assert_string_equal(result->err, ""); // no progress in a pipe
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "gaze 10,5"));
    snprintf(path, sizeof path, "%s/run.csv", folder);
    assert_true(csv_read(&table, path, error, sizeof error));
    assert_int_equal(table.row_count, 6); // three modes, two gazes
    for (size_t row = 0; row < table.row_count; row++)
        check_row(&table, row);
    csv_finish(&table);
    assert_int_equal(strncmp(command("head -n 1 '%s/run.csv'", folder)->out, columns, strlen(columns)), 0);
    assert_string_equal(command("wc -l < '%s/frames.csv'", folder)->out,
                        "37\n"); // 6 lines of 6 frames, a heading
    assert_int_equal(command("python3 -m json.tool '%s/run.json' '%s/run.pretty'", folder, folder)->status, 0);
    assert_string_equal(command("grep -c '\"samples_per_pixel\": 16' '%s/run.pretty'", folder)->out, "6\n");
    assert_int_equal(command("grep -q '\"psnr_db\": null' '%s/run.pretty'", folder)->status, 0);
    assert_string_equal(command("grep -o '</svg>' '%s/run.svg'", folder)->out, "</svg>\n");
    assert_int_equal(command("ls '%s' | grep -q part", folder)->status, 1);
    assert_int_equal(command(BENCH "compare '%s/run.csv' '%s/run.csv'", folder, folder)->status, 0);
}

// Of the run before.
static void figures_are_drawn(void **state)
{
    (void)state;
    const struct command_result *result =
        command(BENCH "figures '%s/run.csv' '%s/frames.csv' -o '%s/figures'", folder, folder, folder);
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->err, "no figure10-resolution: it wants one scene at two sizes"));
    static const char *const names[] = {"figure06-epsilon", "figure12-triangles", "figure13-shaded"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_string_equal(command("grep -o '</svg>' '%s/figures/%s.svg'", folder, names[i])->out, "</svg>\n");
    assert_string_equal(
        command("grep -c 'time_warped epsilon=0.05' '%s/figures/figure13-shaded.svg'", folder)->out, "2\n");
    expect(command("echo a,b > '%s/other.csv'; " BENCH "figures '%s/other.csv' -o '%s/figures'", folder, folder,
                   folder),
           1, "other.csv");
}

#define HEAD                                                                                                   \
    "device,scene,mode,parameters,width,height,gpu_ms_median,shaded_px,psnr_db,ratio_to_regular,ratio_low,"    \
    "ratio_high\\n"
#define REGULAR "D,town,regular,{},64,72,%s,9216,inf,1,1,1\\n"
#define WARPED "%s,town,time_warped,\"{\"\"epsilon\"\":0.2}\",64,72,5,%s,%s,%s\\n"

// Writes NAME.csv: regular's ms; time_warped's device, pixels, PSNR, "ratio,low,high".
static void craft(const char *name, const char *regular_ms, const char *device, const char *shaded,
                  const char *psnr, const char *ratio)
{
    assert_int_equal(command("printf '" HEAD REGULAR WARPED "' > '%s/%s.csv'", regular_ms, device, shaded, psnr,
                             ratio, folder, name)
                         ->status,
                     0);
}

static const struct command_result *compare(const char *a, const char *b)
{
    return command(BENCH "compare '%s/%s.csv' '%s/%s.csv'", folder, a, folder, b);
}

static void compare_names_what_changed(void **state)
{
    (void)state;
    craft("old", "10", "D", "600", "30", "2,1.9,2.1");
    craft("slower", "10", "D", "600", "30", "1.6,1.5,1.7");
    craft("unsure", "10", "D", "600", "30", "1.6,1.2,2");
    craft("worse", "10", "D", "600", "29", "2,1.9,2.1");
    craft("more", "10", "D", "700", "30", "2,1.9,2.1");
    craft("better", "10", "D", "600", "inf", "2.5,2.4,2.6");
    craft("all_slower", "14", "D", "600", "30", "2,1.9,2.1");
    craft("other_card", "40", "E", "600", "30", "2,1.9,2.1");
    static const struct {
        const char *name;
        int status;
        const char *about;
    } cases[] = {
        {"old", 0, "0 figures worse, 0 better"},
        {"slower", 1, "worse: town time_warped{\"epsilon\":0.2}, 64x72: ratio_to_regular 2 -> 1.6 (-20.0 %)"},
        {"unsure", 0, "0 figures worse"},
        {"worse", 1, "psnr_db 30 -> 29 dB"},
        {"more", 1, "shaded_px 600 -> 700 px"},
        {"better", 0, "0 figures worse, 2 better"},
        {"all_slower", 1, "regular, 64x72: gpu_ms_median 10 -> 14 ms"},
        {"other_card", 1, "gpu_ms_median"}, // the row of regular is still of device D
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct command_result *result = compare("old", cases[i].name);
        if (result->status != cases[i].status || !strstr(result->out, cases[i].about))
            print_error("%s: status %d\n%s%s", cases[i].name, result->status, result->out, result->err);
        assert_int_equal(result->status, cases[i].status);
        assert_non_null(strstr(result->out, cases[i].about));
        assert_non_null(strstr(result->out, "tolerances: ratio_to_regular 5 %"));
    }
}

static void compare_needs_one_device_for_milliseconds(void **state)
{
    (void)state;
    command("sed 's/^D,/E,/' '%s/all_slower.csv' > '%s/elsewhere.csv'", folder, folder);
    assert_int_equal(compare("old", "elsewhere")->status, 0);
}

static void compare_names_missing_lines(void **state)
{
    (void)state;
    command("grep -v time_warped '%s/old.csv' > '%s/short.csv'; sed 's/town/atrium/' '%s/old.csv' > "
            "'%s/atrium.csv'; "
            "sed s/gpu_ms/cpu/ '%s/old.csv' > '%s/strange.csv'",
            folder, folder, folder, folder, folder, folder);
    const struct command_result *result = compare("old", "short");
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "short.csv: town time_warped"));
    result = compare("short", "old");
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "short.csv: town time_warped"));
    result = compare("old", "atrium");
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "no line in common"));
    expect(compare("old", "strange"), 1, "gpu_ms_median");
}

static int set_up(void **state)
{
    (void)state;
    command_folder("bench", folder, sizeof folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_usage_is_exit_2),
        cmocka_unit_test(help_is_exit_0),
        cmocka_unit_test(failures_are_exit_1),
        cmocka_unit_test(a_small_run_measures),
        cmocka_unit_test(figures_are_drawn),
        cmocka_unit_test(compare_names_what_changed),
        cmocka_unit_test(compare_needs_one_device_for_milliseconds),
        cmocka_unit_test(compare_names_missing_lines),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
