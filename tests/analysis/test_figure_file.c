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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_kinds_open_alone),
        cmocka_unit_test(net_preferences_are_drawn_of_three_answers),
        cmocka_unit_test(real_data_is_not_branded),
        cmocka_unit_test(pdf_where_it_can_be_made),
        cmocka_unit_test(a_file_is_no_folder),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
