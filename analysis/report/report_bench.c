// Speed against error, as fovbench measured it; only where its file was given.
#include "analysis/report/figures.h"
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>
#include <string.h>

bool report_draw_bench(struct report *r, char *error, size_t error_size)
{
    for (size_t i = 0; i < r->bench.group_count && i < BENCH_FIGURES; i++)
        for (int narrow = 0; r->bench.groups[i].drawn && narrow < 2; narrow++) {
            char id[32], title[3 * BENCH_WORD];
            snprintf(id, sizeof id, "bench-%zu-%c", i, narrow ? 'n' : 'w');
            snprintf(title, sizeof title, "Speed against error: %s on %s", r->bench.groups[i].scene,
                     r->bench.groups[i].device);
            struct figure_text text = {id, title, "A point per mode; the table has every number.",
                                       narrow ? "narrow" : "wide"};
            struct figure_desc desc = {narrow, &text};
            char **svg = narrow ? &r->bench_figures[i].narrow : &r->bench_figures[i].wide;
            if (!figure_bench(&r->bench, i, &desc, svg, error, error_size))
                return false;
        }
    return true;
}

static void number_cell(FILE *out, const char *format, double value)
{
    if (isnan(value))
        fputs("<td>\u2013</td>", out);
    else if (isinf(value))
        fputs("<td>no error</td>", out);
    else
        html_cell(out, "td", format, value);
}

static void bench_row(FILE *out, const struct bench_row *row)
{
    fputs("<tr>", out);
    if (row->number)
        html_cell(out, "td", "%zu", row->number);
    else
        fputs("<td>\u2013</td>", out);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s %s", row->mode, row->parameters);
    number_cell(out, "%.2f\u00d7", row->speed);
    number_cell(out, "%.3f", row->gpu_ms);
    number_cell(out, "%.1f", row->wpsnr_db);
    number_cell(out, "%.1f", row->psnr_db);
    number_cell(out, "%.3f", row->flip);
    html_cell(out, "td", "%s", row->front ? "yes" : "");
    fputs("</tr>\n", out);
}

static void group_table(const struct report *r, size_t group)
{
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Speed against error\">"
          "<table class=\"wrap\">\n<thead><tr><th scope=\"col\">No.</th><th scope=\"col\" "
          "class=\"word\">mode</th>"
          "<th scope=\"col\">speed</th><th scope=\"col\">GPU time, ms</th><th scope=\"col\">weighted PSNR, "
          "dB</th>"
          "<th scope=\"col\">PSNR, dB</th><th scope=\"col\">FLIP</th><th scope=\"col\">front</th></tr></thead>"
          "<tbody>\n",
          r->out);
    for (size_t i = 0; i < r->bench.count; i++)
        if (r->bench.rows[i].group == group)
            bench_row(r->out, &r->bench.rows[i]);
    fputs("</tbody></table></div>\n", r->out);
}

// Why there is no speed, or no figure; "" where there are both.
static void write_lack(const struct report *r, size_t group, char out[256])
{
    const struct bench_group *g = &r->bench.groups[group];
    out[0] = '\0';
    if (g->regulars == 0)
        snprintf(out, 256,
                 "The file has no row of regular here, so there is nothing to compare with: no speed, no "
                 "figure.");
    else if (g->regulars > 1)
        snprintf(out, 256,
                 "The file has %zu rows of regular here, so it is not known which one to compare with: no "
                 "speed, no figure. Keep the rows of one run.",
                 g->regulars);
    else if (!g->drawn)
        snprintf(out, 256, "No mode here has both a GPU time and an error, so there is no figure.");
    else if (group >= BENCH_FIGURES)
        snprintf(out, 256, "Only the first %d are drawn.", (int)BENCH_FIGURES);
}

static void write_group(const struct report *r, size_t group)
{
    const struct bench_group *g = &r->bench.groups[group];
    char lack[256];
    fputs("<h3>", r->out);
    html_printf(r->out, "%s on %s", g->scene, g->device);
    fputs("</h3>\n", r->out);
    if (g->setting[0]) {
        fputs("<p class=\"lead\">", r->out);
        html_printf(r->out, "%s.", g->setting);
        fputs("</p>\n", r->out);
    }
    write_lack(r, group, lack);
    if (lack[0])
        fprintf(r->out, "<p class=\"note\">%s</p>\n", lack);
    if (group < BENCH_FIGURES)
        report_figure(r, &r->bench_figures[group],
                      "To the right is faster, above is nearer to <code>regular</code>. Blue: no other mode is "
                      "both as fast and as near. Numbers are the table\u2019s.");
    group_table(r, group);
}

static bool first_of_device(const struct bench *bench, size_t group)
{
    for (size_t i = 0; i < group; i++)
        if (strcmp(bench->groups[i].device, bench->groups[group].device) == 0)
            return false;
    return true;
}

void report_bench(const struct report *r)
{
    if (!r->bench.count)
        return;
    report_heading(r, "Speed against error");
    fputs("<p>Measured by fovbench on ", r->out);
    for (size_t i = 0, devices = 0; i < r->bench.group_count; i++)
        if (first_of_device(&r->bench, i))
            html_printf(r->out, "%s%s", devices++ ? "; " : "", r->bench.groups[i].device);
    fputs(". These numbers are no part of the data hash. Speed is the median GPU time of <code>regular</code> "
          "over the mode\u2019s, on the same device, scene, size and gaze; <code>regular</code> itself has no "
          "error and is not drawn. On the front are modes that no other one beats in speed and error.</p>\n",
          r->out);
    for (size_t i = 0; i < r->bench.group_count; i++)
        write_group(r, i);
}
