// The report: whole, self-contained, escaped, branded; and how a figure becomes part of a page.
#include "analysis/report/figure.h"
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

static char *slurp(const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file)
        return NULL;
    char *text = calloc(1, 4 << 20);
    assert_non_null(text);
    assert_true(fread(text, 1, (4 << 20) - 1, file) > 0);
    fclose(file);
    return text;
}

static size_t count(const char *text, const char *part)
{
    size_t n = 0;
    for (; (text = strstr(text, part)); text += strlen(part))
        n++;
    return n;
}

// The page of s.db.
static char *report_file(bool simulated)
{
    unlink("r.html");
    const char *argv[] = {fovstats, "report", "s.db", "-o", "r.html", simulated ? "--simulated" : NULL, NULL};
    struct program_result r = program_run(argv, NULL);
    if (r.code != 0 || r.err[0])
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char *page = slurp("r.html");
    assert_non_null(page);
    return page;
}

static char *report(const struct study_desc *desc)
{
    study_file_make("s.db", desc);
    return report_file(desc->simulated);
}

// Every tag that is opened is closed, in order. Void elements of HTML are known; SVG closes its own with "/>".
static void expect_balanced(const char *page)
{
    static const char *const empty[] = {"meta", "link", "br", "!DOCTYPE", NULL};
    char stack[64][24];
    size_t depth = 0;
    for (const char *at = strchr(page, '<'); at; at = strchr(at + 1, '<')) {
        char name[24] = "";
        bool closing = at[1] == '/';
        sscanf(at + 1 + closing, "%23[^ >\n/]", name);
        const char *end = strchr(at, '>');
        assert_non_null(end);
        bool alone = end[-1] == '/';
        for (int i = 0; empty[i]; i++)
            alone = alone || strcmp(name, empty[i]) == 0;
        if (alone)
            continue;
        if (closing) {
            if (depth == 0 || strcmp(stack[depth - 1], name) != 0)
                fail_msg("</%s> closes <%s>", name, depth ? stack[depth - 1] : "");
            depth--;
        } else {
            assert_true(depth < 64);
            strcpy(stack[depth++], name);
        }
    }
    assert_int_equal(depth, 0);
}

// No id twice, and every reference has its id.
static void expect_unique_ids(const char *page)
{
    for (const char *at = page; (at = strstr(at, " id=")); at++) {
        char mark[96];
        const char *value = at + 5, quote = at[4];
        size_t length = strcspn(value, quote == '"' ? "\"" : "'");
        assert_true(length < 64);
        snprintf(mark, sizeof mark, " id=%c%.*s%c", quote, (int)length, value, quote);
        if (count(page, mark) != 1)
            fail_msg("%s stands %zu times", mark, count(page, mark));
    }
    for (const char *at = page; (at = strstr(at, "href='#")); at++) {
        char mark[96];
        snprintf(mark, sizeof mark, " id='%.*s'", (int)strcspn(at + 7, "'"), at + 7);
        assert_int_equal(count(page, mark), 1);
    }
}

static void expect_self_contained(const char *page)
{
    assert_null(strstr(page, "<script"));
    assert_null(strstr(page, "<img"));
    assert_null(strstr(page, " src=\""));
    assert_null(strstr(page, "@import"));
    assert_null(strstr(page, "<?xml"));
    // Addresses are the names of SVG's own vocabularies only.
    assert_int_equal(count(page, "http://") + count(page, "https://"),
                     count(page, "xmlns=\"http://www.w3.org/2000/svg\"") +
                         count(page, "xmlns:xlink=\"http://www.w3.org/1999/xlink\""));
    expect_balanced(page);
    expect_unique_ids(page);
}

static void a_study_of_people(void **state)
{
    (void)state;
    char *page = report(&(struct study_desc){0});
    expect_self_contained(page);
    assert_int_equal(count(page, "<svg class=\"wide\""), 3);
    assert_int_equal(count(page, "<svg class=\"narrow\""), 3);
    assert_null(strstr(page, "SIMULATED"));
    static const char *const parts[] = {
        "<title>small: study report</title>",
        "test device",
        "driver 1",
        "90 Hz, real clock",
        "640 \u00d7 720 px per eye",
        ">6/22</text>",
        ">4/19</text>",
        ">0.0525<",
        ">0.0192<",
        "6 to 16",
        "5 to 14",
        "<td>0.0959</td>",
        "<td>0.0092</td>",
        "t(8) = -3.411",
        "often (11)",
        "never (11)",
        "201 frames, 20 of them late",
        "2 (50.0\u00a0%)",
        "answers to trials that are not done: 3",
        "Of 2 cells, 1 lies outside",
        "<h2>Definitions</h2>",
        "left no count of frames (a crash, or it still runs). What was shown",
    };
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        if (!strstr(page, parts[i]))
            fail_msg("the report lacks \"%s\"", parts[i]);
    assert_null(strstr(page, "cannot be drawn"));
    free(page);
}

static void the_same_twice(void **state)
{
    (void)state;
    char *a = report(&(struct study_desc){0}), *b = report(&(struct study_desc){0});
    assert_string_equal(a, b);
    free(a);
    free(b);
}

static void simulated_is_branded(void **state)
{
    (void)state;
    char *page = report(&(struct study_desc){.simulated = true});
    assert_non_null(strstr(page, "<title>SIMULATED DATA "));
    assert_non_null(strstr(page, "<h1>SIMULATED DATA "));
    assert_non_null(strstr(page, "<div class=\"brand\""));
    expect_self_contained(page);
    free(page);
}

// Frames that were submitted in sessions that are left out are nobody's missing ones.
static void simulated_sessions_beside_people_are_left_out(void **state)
{
    (void)state;
    study_file_make("people.db", &(struct study_desc){.simulated = false});
    study_file_make("sim.db", &(struct study_desc){.simulated = true});
    study_file_sql("sim.db",
                   "INSERT INTO event (session_id, segment_id, at_ns, kind, detail) SELECT session_id, id, 0, "
                   "'frames_submitted', '{\"frames\":900}' FROM segment");
    const char *argv[] = {fovstats, "report", "people.db", "sim.db", "-o", "both.html", NULL};
    struct program_result r = program_run(argv, NULL);
    if (r.code != 0 || r.err[0])
        fail_msg("exit %d: %s", r.code, r.err);
    program_free(&r);
    char *page = slurp("both.html");
    assert_non_null(strstr(page, "<li>simulated sessions: 22</li>"));
    free(page);
}

// What no section answers is not silently missing; what was planned for people left out is nobody's.
static void every_planned_analysis_is_named(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db",
                   "UPDATE session SET settings = json_set(settings, '$.planned', json('["
                   "{\"method\":\"paired_t\",\"of\":\"rating\",\"per\":\"order\"},"
                   "{\"method\":\"paired_t\",\"of\":\"choice\",\"per\":\"factor\"},"
                   "{\"method\":\"binomial\",\"of\":\"choice\",\"per\":\"study\"},"
                   "{\"method\":\"mean\",\"of\":\"reaction\",\"per\":\"-\"}]'), '$.title', 'Blocks & <b>')");
    const char *argv[] = {fovstats, "report", "s.db", "-o", "r.html", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    char *page = slurp("r.html");
    assert_int_equal(count(page, "class=\"word\">paired t of rating, per order</th>"), 1);
    assert_int_equal(count(page, "class=\"word\">mean of reaction</th>"), 1);
    assert_null(strstr(page, "not computed"));
    assert_non_null(strstr(page, "</h1>\n<p>Blocks &amp; &lt;b&gt;</p>\n<p class=\"source\">Data SHA-256 "));
    assert_int_equal(count(page, "class=\"word\">paired t of choice, per factor</th>"), 1);
    assert_int_equal(count(page, "class=\"word\">binomial of choice, per study</th>"), 1);
    assert_non_null(strstr(page, "Levels of factors, in cells that are otherwise the same"));
    assert_null(strstr(page, "Equivalence: is the share")); // no margin was planned
    free(page);
    page = report(&(struct study_desc){.simulated = false});
    assert_null(strstr(page, "Blocks"));
    assert_non_null(strstr(
        page, "None: the protocol planned no analysis, or the sessions were recorded by an early build"));
    free(page);
}

// The section on choices has both one-sided tests of each cell; 6 and 4 show no equality within 30 to 70 %.
static void a_planned_margin_is_tested(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "UPDATE session SET settings = json_set(settings, '$.planned', json('[{\"method\":"
                           "\"binomial\",\"of\":\"choice\",\"per\":\"cell\",\"margin\":0.2}]'))");
    const char *argv[] = {fovstats, "report", "s.db", "-o", "r.html", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    char *page = slurp("r.html");
    assert_int_equal(count(page, "Equivalence: is the share of choices within 30 to 70&nbsp;%"), 1);
    assert_int_equal(count(page, "<td class=\"word\">exact binomial</td>"), 2);
    assert_null(strstr(page, "equality within the margin is shown"));
    free(page);
    study_file_even("s.db"); // p 0.0387 in a cell, which is not enough in two
    r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    page = slurp("r.html");
    assert_null(strstr(page, "equality within the margin is shown"));
    assert_null(strstr(page, "equality is shown"));
    // In the planned table a cell's difference and equality count once; the section on choices has equality
    // alone.
    assert_int_equal(count(page, "<td>0.0387</td><td>0.0775</td>"), 2);
    assert_int_equal(count(page, "neither equality nor a difference is shown"), 2);
    assert_int_equal(count(page, "The 4 planned tests are one family, with Holm\u2019s adjustment."), 1);
    assert_int_equal(count(page, "equality is claimed only where Holm\u2019s p is at most 0.05"), 1);
    free(page);
}

// Ten of the 22 sessions are of another protocol: its answers are in no cell of this one.
static void one_protocol_is_reported(void **state)
{
    (void)state;
    static const char *const wanted[] = {NULL, "other", "nothing"};
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "INSERT INTO protocol (id, name, sha256, text) SELECT 9, 'other', replace(sha256, "
                           "substr(sha256, 1, 1), "
                           "'e'), text FROM protocol; UPDATE session SET protocol_id = 9 WHERE id > 12");
    for (int i = 0; i < 3; i++) {
        const char *argv[] = {fovstats,  "report", "s.db", "-o", "r.html", wanted[i] ? "--protocol" : NULL,
                              wanted[i], NULL};
        struct program_result r = program_run(argv, NULL);
        assert_int_equal(r.code, i == 2);
        if (i == 2)
            assert_non_null(strstr(r.err, "no session is of the protocol 'nothing'"));
        program_free(&r);
        char *page = slurp("r.html");
        assert_non_null(strstr(page, i == 0 ? "<p class=\"note\">10 sessions of other protocols"
                                            : "<p class=\"note\">12 sessions of other protocols"));
        assert_non_null(strstr(page, i == 0 ? "<td>12 (12 sessions)</td>" : "<td>10 (10 sessions)</td>"));
        free(page);
    }
    study_file_sql("s.db", "UPDATE protocol SET name = (SELECT name FROM protocol WHERE id < 9)");
    const char *argv[] = {fovstats, "report", "s.db", "-o", "r.html", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    char *page = slurp("r.html");
    assert_non_null(strstr(page, "<p class=\"note\">The sessions differ in: protocol text."));
    free(page);
    const char *const tools[] = {"choices", "ratings", "frames"};
    for (size_t i = 0; i < sizeof tools / sizeof tools[0]; i++) {
        const char *tool[] = {fovstats, tools[i], "s.db", NULL};
        r = program_run(tool, NULL);
        assert_non_null(strstr(r.out, "The sessions differ in: protocol text. The numbers pool them.\n"));
        program_free(&r);
    }
}

static void nothing_is_switched_in_sequential_trials(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.simulated = false});
    study_file_sql("s.db", "UPDATE trial SET kind = 'sequential' WHERE kind = 'toggle'");
    const char *argv[] = {fovstats, "report", "s.db", "-o", "r.html", NULL};
    struct program_result r = program_run(argv, NULL);
    assert_int_equal(r.code, 0);
    program_free(&r);
    char *page = slurp("r.html");
    assert_null(strstr(page, "switches before a decision"));
    assert_non_null(strstr(page, "the one shown first was chosen in"));
    free(page);
    const char *choices[] = {fovstats, "choices", "s.db", NULL};
    r = program_run(choices, NULL);
    assert_null(strstr(r.out, "Toggles over all answers"));
    assert_null(strstr(r.out, "nan"));
    program_free(&r);
}

static void hostile_texts_stay_texts(void **state)
{
    (void)state;
    char *page = report(&(struct study_desc){.hostile = true});
    expect_self_contained(page);
    assert_null(strstr(page, "<svg onload"));
    assert_null(strstr(page, "<i>How"));
    assert_null(strstr(page, "<b>"));
    assert_non_null(strstr(page, "&lt;/title&gt;&lt;script&gt;alert(3)&lt;/script&gt;"));
    assert_int_not_equal(access("hacked", F_OK), 0);
    free(page);
}

static void exclusions_and_pooling_are_said(void **state)
{
    (void)state;
    char *page = report(&(struct study_desc){.excluded = true, .pooled = true, .equal = true});
    expect_self_contained(page);
    assert_non_null(strstr(page, "<strong>Pooled:</strong>"));
    assert_non_null(strstr(page, "half of the gaze was lost"));
    assert_non_null(strstr(page, "stricter (not applied)"));
    assert_non_null(strstr(page, "excluded sessions: 1"));
    free(page);
}

// One cell of nine answers each, one of one answer each: each is tested and drawn in its way.
static void several_answers_are_people(void **state)
{
    (void)state;
    char *page = report(&(struct study_desc){.several = true});
    expect_self_contained(page);
    static const char *const parts[] = {"exact two-sided binomial or sign-flip test",
                                        "Choices in cells with one answer per person were",
                                        "In cells with several answers of a person the people",
                                        "t interval as a line instead of a region",
                                        "smallest attainable p",
                                        "<td>4.8e-07</td>",
                                        "of a person in the middle",
                                        "Of 2 cells, 1 has p \u2264 0.05",
                                        "<td>5 to 14</td>"};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        if (!strstr(page, parts[i]))
            fail_msg("the report lacks \"%s\"", parts[i]);
    assert_null(strstr(page, "<td>6 to 16</td>")); // no null region of the other
    free(page);
    page = report(&(struct study_desc){0});
    assert_null(strstr(page, "Several answers per person"));
    free(page);
}

// Everybody always chose the same: there is a test, and neither a t interval nor a model.
static void separation_is_said(void **state)
{
    (void)state;
    study_file_make("s.db", &(struct study_desc){.several = true});
    study_file_sql("s.db", "DELETE FROM choice WHERE trial_id < 1000; UPDATE choice SET chosen = 'a'");
    char *page = report_file(false);
    expect_self_contained(page);
    assert_non_null(strstr(page, "separation: all answers are the same"));
    assert_non_null(strstr(page, "As people answered several times per cell, the people"));
    assert_non_null(strstr(page, "Each person answered several times in a cell; the bar is"));
    assert_null(strstr(page, "overdispersion is not estimable there"));
    free(page);
    study_file_sql("s.db",
                   "DELETE FROM choice WHERE segment_id > 4; UPDATE choice SET chosen = 'b' WHERE id % 8 = 0");
    page = report_file(false);
    assert_non_null(strstr(page, "4 of 4 people did not choose both equally often; with so many the sign-flip "
                                 "p is never below 0.12 and cannot reach 0.05"));
    free(page);
}

static void what_is_missing_is_said(void **state)
{
    (void)state;
    char *page = report(&(struct study_desc){.bare = true});
    expect_self_contained(page);
    assert_int_equal(count(page, "<svg"), 0);
    assert_non_null(strstr(page, "No choice was recorded"));
    assert_non_null(strstr(page, "No rating of an option was recorded"));
    assert_non_null(strstr(page, "No frame was recorded"));
    free(page);
}

static void fails(const char *path, const char *db, const char *out, const char *part)
{
    const char *argv[] = {fovstats, "report", db, "-o", out, NULL};
    struct program_result r = program_run(argv, path);
    if (r.code != 1 || !strstr(r.err, part))
        fail_msg("exit %d, \"%s\"; expected \"%s\"", r.code, r.err, part);
    program_free(&r);
}

static void failures_write_nothing(void **state)
{
    (void)state;
    unlink("f.html");
    study_file_make("s.db", &(struct study_desc){0});
    fails("/nonexistent", "s.db", "f.html", "gnuplot is not installed");
    fails(NULL, "missing.db", "f.html", "missing.db: there is no such file");
    assert_int_not_equal(access("f.html", F_OK), 0);
    fails(NULL, "s.db", "no/such/folder/f.html", "no/such/folder/f.html: cannot be written");
    study_file_make("e.db", &(struct study_desc){.empty = true});
    fails(NULL, "e.db", "f.html", "e.db: the study is empty");
    assert_int_not_equal(access("f.html", F_OK), 0);
    // A report that cannot be written whole leaves an older one.
    FILE *file = fopen("f.html", "w");
    fputs("older", file);
    fclose(file);
    fails("/nonexistent", "s.db", "f.html", "gnuplot is not installed");
    char *older = slurp("f.html");
    assert_string_equal(older, "older");
    free(older);
}

// The rest of the report is written, with gnuplot's words in the figure's place.
static void figures_that_gnuplot_refuses(void **state)
{
    (void)state;
    char folder[256];
    study_file_make("s.db", &(struct study_desc){0});
    FILE *file = fopen("gnuplot", "w");
    fputs("#!/bin/sh\necho '<out> of ink'\nexit 3\n", file);
    fclose(file);
    const char *chmod[] = {"/bin/chmod", "+x", "gnuplot", NULL};
    struct program_result r = program_run(chmod, NULL);
    program_free(&r);
    assert_non_null(getcwd(folder, sizeof folder));
    const char *argv[] = {fovstats, "report", "s.db", "-o", "f.html", NULL};
    r = program_run(argv, folder);
    assert_int_equal(r.code, 0);
    program_free(&r);
    unlink("gnuplot");
    char *page = slurp("f.html");
    static const char *const parts[] = {"This figure cannot be drawn from its numbers.",
                                        "gnuplot (status 3): &lt;out&gt; of ink", "</html>"};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        if (!strstr(page, parts[i]))
            fail_msg("the report lacks \"%s\"", parts[i]);
    free(page);
}

static void a_figure_becomes_part_of_a_page(void **state)
{
    (void)state;
    struct figure_text text = {"f1", "A <title>", "Words & more", "wide"};
    char *svg = figure_embeddable(
        "<?xml version=\"1.0\"?>\n<!DOCTYPE svg>\n<svg \n width=\"5\" viewBox=\"0 0 1 2\"\n>\n"
        "<title>Gnuplot</title><desc>by</desc>\n<g id=\"a\"><use xlink:href='#b'/>"
        "<rect id='b' fill=\"url(#a)\"/><text> id='x' url(#y)</text></g></svg>\n",
        &text);
    assert_non_null(svg);
    assert_string_equal(
        svg, "<svg class=\"wide\" xmlns=\"http://www.w3.org/2000/svg\" "
             "xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 1 2\" role=\"img\" "
             "aria-labelledby=\"f1-title f1-desc\">\n<title id=\"f1-title\">A &lt;title&gt;</title>\n"
             "<desc id=\"f1-desc\">Words &amp; more</desc>\n\n<g id=\"f1-a\"><use "
             "xlink:href='#f1-b'/><rect id='f1-b' fill=\"url(#f1-a)\"/><text> id='x' "
             "url(#y)</text></g></svg>\n");
    free(svg);
    assert_null(figure_embeddable("no picture", &text));
    assert_null(figure_embeddable("<svg>", &text));
    assert_null(figure_embeddable("<svg></svg>", &text));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_study_of_people),
        cmocka_unit_test(the_same_twice),
        cmocka_unit_test(simulated_is_branded),
        cmocka_unit_test(every_planned_analysis_is_named),
        cmocka_unit_test(a_planned_margin_is_tested),
        cmocka_unit_test(one_protocol_is_reported),
        cmocka_unit_test(nothing_is_switched_in_sequential_trials),
        cmocka_unit_test(simulated_sessions_beside_people_are_left_out),
        cmocka_unit_test(hostile_texts_stay_texts),
        cmocka_unit_test(exclusions_and_pooling_are_said),
        cmocka_unit_test(several_answers_are_people),
        cmocka_unit_test(separation_is_said),
        cmocka_unit_test(what_is_missing_is_said),
        cmocka_unit_test(failures_write_nothing),
        cmocka_unit_test(figures_that_gnuplot_refuses),
        cmocka_unit_test(a_figure_becomes_part_of_a_page),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
