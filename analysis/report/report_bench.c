// Speed against error, as fovbench measured it; only where its file was given.
#include "analysis/report/figures.h"
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>
#include <string.h>

bool report_draw_bench(struct report *r, char *error, size_t error_size)
{
    for (size_t i = 0; i < r->bench.scene_count; i++)
        for (int narrow = 0; narrow < 2; narrow++) {
            char id[32];
            snprintf(id, sizeof id, "bench-%zu-%c", i, narrow ? 'n' : 'w');
            struct figure_text text = {id, "Speed against error",
                                       "A point per mode; the table has every number.",
                                       narrow ? "narrow" : "wide"};
            struct figure_desc desc = {narrow, &text};
            char **svg = narrow ? &r->bench_figures[i].narrow : &r->bench_figures[i].wide;
            if (!figure_bench(&r->bench, r->bench.scenes[i], &desc, svg, error, error_size))
                return false;
        }
    return true;
}

static void decibel_cell(const struct report *r, double value)
{
    if (isinf(value))
        fputs("<td>no error</td>", r->out);
    else
        html_cell(r->out, "td", "%.1f", value);
}

static void scene_table(const struct report *r, const char *scene)
{
    fputs("<div class=\"table\"><table><thead><tr><th>No.</th><th>Mode</th><th>Speed</th><th>GPU ms</th>"
          "<th>Ecc.-weighted PSNR dB</th><th>PSNR dB</th><th>FLIP</th><th>Front</th></tr></thead><tbody>\n",
          r->out);
    for (size_t i = 0; i < r->bench.count; i++) {
        const struct bench_row *row = &r->bench.rows[i];
        if (strcmp(row->scene, scene) != 0)
            continue;
        fputs("<tr>", r->out);
        if (row->number)
            html_cell(r->out, "td", "%zu", row->number);
        else
            fputs("<td>\u2013</td>", r->out);
        html_cell(r->out, "td", "%s %s", row->mode, row->parameters);
        html_cell(r->out, "td", "%.2f", row->speed);
        html_cell(r->out, "td", "%.3f", row->gpu_ms);
        decibel_cell(r, row->wpsnr_db);
        decibel_cell(r, row->psnr_db);
        html_cell(r->out, "td", "%.3f", row->flip);
        html_cell(r->out, "td", "%s", row->front ? "yes" : "");
        fputs("</tr>\n", r->out);
    }
    fputs("</tbody></table></div>\n", r->out);
}

void report_bench(const struct report *r)
{
    if (!r->bench.count)
        return;
    report_heading(r, "Speed against error");
    html_printf(r->out, "Measured by fovbench on %s, and no part of the data hash.", r->bench.rows[0].device);
    for (size_t i = 0; i < r->bench.scene_count; i++) {
        fputs("<h3>", r->out);
        html_text(r->out, r->bench.scenes[i]);
        fputs("</h3>\n", r->out);
        report_figure(
            r, &r->bench_figures[i],
            "Speed is <code>regular</code>\u2019s median GPU time over the mode\u2019s; above is nearer to "
            "<code>regular</code>, whose own error is none and is not drawn. Blue: no other mode is both as "
            "fast and as near.");
        scene_table(r, r->bench.scenes[i]);
    }
}
