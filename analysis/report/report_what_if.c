// Thresholds and the scale of preferences under other exclusion rules: rows of the table "What if".
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>
#include <string.h>

static void mean_cells(FILE *out, const struct threshold_mean *mean)
{
    if (!mean || mean->of.n == 0)
        html_cell(out, "td", "not estimable");
    else
        html_cell(out, "td", "%.3g (n %zu)", mean->of.mean, mean->of.n);
    html_cell(out, "td", "\u2013");
}

static const struct threshold_cell *same_threshold(const struct thresholds *in,
                                                   const struct threshold_cell *cell)
{
    for (size_t i = 0; i < in->cell_count; i++)
        if (in->cells[i].source == cell->source && in->cells[i].preference == cell->preference &&
            strcmp(in->cells[i].block, cell->block) == 0 && strcmp(in->cells[i].label, cell->label) == 0)
            return &in->cells[i];
    return NULL;
}

static void score_cells(const struct report *r, const struct jod *in, const struct jod_block *block,
                        size_t option)
{
    const struct stat_jod *score = NULL;
    for (size_t i = 0; i < in->block_count; i++)
        for (size_t k = 0; strcmp(in->blocks[i].block, block->block) == 0 && k < in->blocks[i].option_count;
             k++)
            if (in->blocks[i].options[k] == option)
                score = &in->blocks[i].scores[k];
    if (!score || isnan(score->score))
        html_cell(r->out, "td", "not estimable");
    else
        html_cell(r->out, "td", "%.2f JOD", score->score);
    html_cell(r->out, "td", "\u2013");
}

void report_what_if_scales(const struct report *r)
{
    const struct thresholds *const thresholds[3] = {&r->all.thresholds, &r->thresholds,
                                                    &r->stricter.thresholds};
    const struct jod *const jods[3] = {&r->all.jod, &r->jod, &r->stricter.jod};
    for (size_t i = 0; i < r->all.thresholds.cell_count; i++) {
        const struct threshold_cell *cell = &r->all.thresholds.cells[i];
        fputs("<tr>", r->out);
        html_cell(r->out, "th scope=\"row\" class=\"word\"", "threshold of %s, %s: %s, mean over fits",
                  cell->parameter, cell->block, cell->words);
        for (int k = 0; k < 3; k++) {
            const struct threshold_cell *same = same_threshold(thresholds[k], cell);
            mean_cells(r->out, same ? &same->by_fit : NULL);
        }
        fputs("</tr>\n", r->out);
    }
    for (size_t i = 0; i < r->all.jod.block_count; i++)
        for (size_t k = 0; k < r->all.jod.blocks[i].option_count; k++) {
            const struct jod_block *block = &r->all.jod.blocks[i];
            if (k == block->reference)
                continue;
            fputs("<tr>", r->out);
            html_cell(r->out, "th scope=\"row\" class=\"word\"", "scale, %s: %s", block->block,
                      report_label(r, block->options[k]));
            for (int j = 0; j < 3; j++)
                score_cells(r, jods[j], block, block->options[k]);
            fputs("</tr>\n", r->out);
        }
}
