// Thresholds and the scale of preferences under other exclusion rules: rows of the table "What if".
#include "analysis/report/html.h"
#include "analysis/report/level.h"
#include "analysis/report/sections.h"

#include <math.h>
#include <string.h>

static void estimate_cells(FILE *out, const struct threshold_cell *cell, bool fits)
{
    const struct threshold_mean *mean = !cell ? NULL : fits ? &cell->by_fit : &cell->by_staircase;
    if (!mean || mean->of.n == 0)
        html_cell(out, "td", "not estimable");
    else if (cell->pooled)
        html_cell(out, "td", "%.3g (%zu together)", mean->of.mean, cell->pooled);
    else
        html_cell(out, "td", "%.3g (%zu of %zu)", mean->of.mean, mean->of.n, cell->person_count);
    html_cell(out, "td", "\u2013");
}

// What a staircase's levels are of is guessed from its answers, and may be guessed otherwise from fewer: there
// is one staircase of these words in the block. Constant levels of one block may be of several parameters.
static const struct threshold_cell *same_threshold(const struct thresholds *in,
                                                   const struct threshold_cell *cell)
{
    for (size_t i = 0; i < in->cell_count; i++) {
        const struct threshold_cell *other = &in->cells[i];
        if (other->source == cell->source && other->preference == cell->preference &&
            strcmp(other->block, cell->block) == 0 && strcmp(other->label, cell->label) == 0 &&
            (cell->source == THRESHOLD_STAIRCASES || strcmp(other->parameter, cell->parameter) == 0))
            return other;
    }
    return NULL;
}

static void threshold_row(const struct report *r, const struct threshold_cell *cell, bool fits)
{
    const struct thresholds *const in[3] = {&r->all.thresholds, &r->thresholds, &r->stricter.thresholds};
    char parameter[96];
    level_name(cell->parameter, parameter);
    fputs("<tr>", r->out);
    html_cell(r->out, "th scope=\"row\" class=\"word\"", "threshold of %s, %s: %s, %s", parameter, cell->block,
              cell->words,
              !fits          ? "mean of people by the staircase"
              : cell->pooled ? "one function of all people"
                             : "mean of people by the fit");
    for (int k = 0; k < 3; k++)
        estimate_cells(r->out, same_threshold(in[k], cell), fits);
    fputs("</tr>\n", r->out);
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
    for (size_t i = 0; i < r->all.thresholds.cell_count; i++) {
        const struct threshold_cell *cell = &r->all.thresholds.cells[i];
        if (cell->source == THRESHOLD_STAIRCASES)
            threshold_row(r, cell, false);
        if (!cell->graded) // to answers on a scale nothing is fitted
            threshold_row(r, cell, true);
    }
    const struct jod *const jods[3] = {&r->all.jod, &r->jod, &r->stricter.jod};
    for (size_t i = 0; i < r->all.jod.block_count; i++)
        for (size_t k = 0; k < r->all.jod.blocks[i].option_count; k++) {
            const struct jod_block *block = &r->all.jod.blocks[i];
            if (k == block->reference)
                continue;
            fputs("<tr>", r->out);
            html_cell(r->out, "th scope=\"row\" class=\"word\"", "scale, %s: %s less %s", block->block,
                      report_label(r, block->options[k]), report_label(r, block->options[block->reference]));
            for (int j = 0; j < 3; j++)
                score_cells(r, jods[j], block, block->options[k]);
            fputs("</tr>\n", r->out);
        }
}

void report_what_if_notes(const struct report *r)
{
    bool staircases = false;
    for (size_t i = 0; i < r->all.thresholds.cell_count; i++)
        staircases = staircases || r->all.thresholds.cells[i].source == THRESHOLD_STAIRCASES;
    if (staircases)
        fputs("<p>A staircase\u2019s own estimate has seen each of its trials: where trials are left out it "
              "stays, "
              "where people or sessions are left out the mean does not.</p>\n",
              r->out);
}
