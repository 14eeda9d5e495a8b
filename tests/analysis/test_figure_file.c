// Figures as files: each opens alone, says where its numbers come from, and is a PDF too where that can be
// made.
#include "program.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";
static const char *const names[] = {"choices", "choices_narrow", "ratings_before_after_1", "frame_times"};

static struct program_result report(const char *folder, const char *path, bool simulated)
{
    study_file_make("s.db", &(struct study_desc){.simulated = simulated});
    return program_run((const char *const[]){fovstats, "report", "s.db", "-o", "s.html", "--figures", folder,
                                             simulated ? "--simulated" : NULL, NULL},
                       path);
}

// "" where there is no such file.
static const char *text_of(const char *folder, const char *name, const char *ending)
{
    static char text[400000];
    char path[256];
    snprintf(path, sizeof path, "%s/%s.%s", folder, name, ending);
    FILE *file = fopen(path, "rb");
    text[file ? fread(text, 1, sizeof text - 1, file) : 0] = '\0';
    if (file)
        fclose(file);
    return text;
}

static void both_kinds_open_alone(void **state)
{
    (void)state;
    struct program_result r = report("figures", NULL, true);
    assert_int_equal(r.code, 0);
    program_free(&r);
    r = program_run((const char *const[]){fovstats, "choices", "s.db", "--simulated", NULL}, NULL);
    char hash[17];
    snprintf(hash, sizeof hash, "%.16s", strstr(r.out, "SHA-256 ") + 8);
    program_free(&r);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const char *svg = text_of("figures", names[i], "svg");
        if (strncmp(svg, "<?xml", 5) != 0 || !strstr(svg, hash) || !strstr(svg, "SIMULATED DATA") ||
            strstr(svg, "href=\"http") || !strstr(svg, "</svg>"))
            fail_msg("%s.svg is not what it should be: %.300s", names[i], svg);
        char path[128];
        snprintf(path, sizeof path, "figures/%s.svg", names[i]);
        r = program_run((const char *const[]){"/usr/bin/python3", "-c",
                                              "import sys, xml.dom.minidom as m; m.parse(sys.argv[1])", path,
                                              NULL},
                        NULL);
        assert_int_equal(r.code, 0);
        program_free(&r);
    }
}

static void real_data_is_not_branded(void **state)
{
    (void)state;
    struct program_result r = report("real", NULL, false);
    assert_int_equal(r.code, 0);
    program_free(&r);
    const char *svg = text_of("real", "choices", "svg");
    assert_non_null(strstr(svg, "simulated: no"));
    assert_null(strstr(svg, "SIMULATED DATA"));
}

// A path that has gnuplot only, and one that has rsvg-convert too.
static void pdf_where_it_can_be_made(void **state)
{
    (void)state;
    assert_int_equal(system("mkdir bin && ln -s \"$(command -v gnuplot)\" bin/gnuplot"), 0);
    char path[256];
    snprintf(path, sizeof path, "%s/bin", (const char *)*state);
    struct program_result r = report("plain", path, false);
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.err, "are SVG only: rsvg-convert is not installed"));
    assert_int_equal(strncmp(text_of("plain", "choices", "svg"), "<?xml", 5), 0);
    assert_string_equal(text_of("plain", "choices", "pdf"), "");
    program_free(&r);
    if (system("command -v rsvg-convert >/dev/null") != 0)
        return;
    r = report("pdf", NULL, false);
    assert_int_equal(r.code, 0);
    assert_string_equal(r.err, "");
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_int_equal(strncmp(text_of("pdf", names[i], "pdf"), "%PDF-", 5), 0);
    program_free(&r);
}

static void a_file_is_no_folder(void **state)
{
    (void)state;
    fclose(fopen("taken", "w"));
    struct program_result r = report("taken", NULL, false);
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "taken: no folder for figures can be made: a file of that name is there"));
    program_free(&r);
}

// Where "equal" was an answer, the net preferences are drawn; else there is no such figure.
static void net_preferences_are_drawn_of_three_answers(void **state)
{
    (void)state;
    for (int equal = 0; equal < 2; equal++) {
        study_file_make("s.db", &(struct study_desc){.equal = equal == 1});
        struct program_result r = program_run(
            (const char *const[]){fovstats, "report", "s.db", "-o", "s.html", "--figures", "three", NULL},
            NULL);
        assert_int_equal(r.code, 0);
        program_free(&r);
        const char *svg = text_of("three", "net_preference", "svg");
        assert_true((strstr(svg, "reference preferred") != NULL) == (equal == 1));
        // 6 of 22 chose the test option, 15 the reference, one "equal": -9 / 22
        assert_true((strstr(svg, "\u22120.41") != NULL) == (equal == 1));
    }
}

static size_t count(const char *text, const char *part)
{
    size_t n = 0;
    for (; part[0] && (text = strstr(text, part)); text += strlen(part))
        n++;
    return n;
}

// How often `part` stands in the figure `name` of s.db as it is.
static size_t drawn(const char *name, const char *part)
{
    struct program_result r = program_run(
        (const char *const[]){fovstats, "report", "s.db", "-o", "s.html", "--figures", "drawn", NULL}, NULL);
    if (r.code != 0)
        fail_msg("%s", r.err);
    program_free(&r);
    return count(text_of("drawn", name, "svg"), part);
}

// A t interval that goes on beyond the axis ends in an arrow: of 22 people one "equal" and else the reference
// (-0.95 +- 0.095), and of
// shares of which one is under 100 % (98.0 +- 4.2).
static void an_interval_beyond_the_axis_has_an_arrow(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.equal = true});
    size_t whole = drawn("net_preference", "<polygon");
    study_file_sql("s.db", "UPDATE choice SET chosen = CASE (SELECT test_slot FROM trial WHERE id = trial_id) "
                           "WHEN 'a' THEN 'b' ELSE 'a' END WHERE chosen != 'equal'");
    assert_int_equal(drawn("net_preference", "<polygon"), whole + 1);
    study_file_make("s.db", &(struct study_desc){.several = true});
    whole = drawn("choices", "<polygon");
    study_file_sql("s.db", "UPDATE choice SET chosen = (SELECT test_slot FROM trial WHERE id = trial_id) "
                           "WHERE trial_id NOT BETWEEN 1020 AND 1024");
    assert_int_equal(drawn("choices", "<polygon"), whole + 1);
}

// The means' dots of both panels.
static void keep_dots(char out[20000])
{
    drawn("ratings_before_after_1", "");
    const char *svg = text_of("drawn", "ratings_before_after_1", "svg"), *from = strstr(svg, "gnuplot_plot_3"),
               *to = strstr(svg, "gnuplot_plot_4");
    assert_true(from && to && to - from < 20000);
    snprintf(out, 20000, "%.*s", (int)(to - from), from);
}

// Orange is the option under test, also where `regular` has parameters.
static void the_reference_keeps_its_colour(void **state)
{
    (void)state;
    static char plain[20000], resolved[20000];
    study_file_make("s.db", &(struct study_desc){0});
    keep_dots(plain);
    study_file_sql("s.db",
                   "UPDATE condition SET parameters = '{\"eyes\":\"separate\"}' WHERE mode = 'regular'");
    keep_dots(resolved);
    // first panel: regular first, so blue comes before orange
    const char *blue = strstr(plain, "color='rgb( 47, 109, 168)'"),
               *orange = strstr(plain, "color='rgb(232, 145,  45)'");
    assert_true(blue && orange && blue < orange);
    assert_string_equal(resolved, plain);
}

// Two cards in one file of fovbench: a heading, a figure and a speed of its own for each.
static void every_device_of_a_bench_has_its_figure(void **state)
{
    (void)state;
    FILE *file = fopen("b.csv", "w");
    fputs("device,scene,mode,parameters,gpu_ms_median,psnr_db,flip,wpsnr_db\n"
          "A,town,regular,{},10,inf,,inf\nA,town,vrs,{},5,29,,30\n"
          "B,town,regular,{},20,inf,,inf\nB,town,vrs,{},8,29,,31\nC,town,vrs,{},1,29,,32\n",
          file);
    fclose(file);
    study_file_make("s.db", &(struct study_desc){0});
    struct program_result r = program_run((const char *const[]){fovstats, "report", "s.db", "-o", "s.html",
                                                                "--figures", "bench", "--bench", "b.csv", NULL},
                                          NULL);
    if (r.code != 0)
        fail_msg("%s", r.err);
    program_free(&r);
    static const struct {
        const char *part;
        size_t times;
    } parts[] = {{"Measured by fovbench on A; B; C.", 1},
                 {"<h3>town on A</h3>", 1},
                 {"<h3>town on B</h3>", 1},
                 {"<td>2.00\u00d7</td><td>5.000</td>", 1},
                 {"<td>2.50\u00d7</td><td>8.000</td>", 1},
                 {"<td>\u2013</td><td>1.000</td>", 1},
                 {"no row of regular here", 1},
                 {"Speed against error: town on A</title>", 2},
                 {"Speed against error: town on C</title>", 0}};
    rename("s.html", "bench/page.svg");
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        if (count(text_of("bench", "page", "svg"), parts[i].part) != parts[i].times)
            fail_msg("\"%s\" stands %zu times", parts[i].part,
                     count(text_of("bench", "page", "svg"), parts[i].part));
    assert_non_null(strstr(text_of("bench", "speed_error_1", "svg"), "town on A"));
    assert_non_null(strstr(text_of("bench", "speed_error_2_narrow", "svg"), "town on B"));
    assert_string_equal(text_of("bench", "speed_error_3", "svg"), "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_kinds_open_alone),
        cmocka_unit_test(net_preferences_are_drawn_of_three_answers),
        cmocka_unit_test(real_data_is_not_branded),
        cmocka_unit_test(pdf_where_it_can_be_made),
        cmocka_unit_test(a_file_is_no_folder),
        cmocka_unit_test(an_interval_beyond_the_axis_has_an_arrow),
        cmocka_unit_test(the_reference_keeps_its_colour),
        cmocka_unit_test(every_device_of_a_bench_has_its_figure),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
