// The methods of thresholds, adjusted values and preferences on one scale: those that gave a number here.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <math.h>

// What of the thresholds there is.
struct used {
    bool reversals, quest;                 // staircases' own estimates
    bool alone, pooled, right, preference; // fitted functions: of a person, of all together; of what
    bool profile, bayes, mean;             // intervals; means over people
};

static void look(const struct threshold_cell *cell, struct used *u)
{
    for (size_t i = 0; i < cell->person_count; i++) {
        const struct threshold_person *p = &cell->people[i];
        bool staircase = cell->source == THRESHOLD_STAIRCASES && !isnan(p->estimate);
        u->reversals = u->reversals || (staircase && !cell->quest);
        u->quest = u->quest || (staircase && cell->quest);
        u->bayes = u->bayes || !isnan(p->bayes.threshold.mean);
        if (p->fit.status != STAT_FIT_OK)
            continue;
        u->alone = u->alone || !cell->pooled;
        u->pooled = u->pooled || cell->pooled;
        u->right = u->right || !cell->preference;
        u->preference = u->preference || cell->preference;
        u->profile = u->profile || !isnan(p->fit.threshold.low);
    }
    u->mean = u->mean || !isnan(cell->by_staircase.t.ci_low) || !isnan(cell->by_fit.t.ci_low) ||
              !isnan(cell->by_bayes.t.ci_low);
}

static void fit_methods(FILE *out, const struct used *u)
{
    html_printf(out, "Psychometric functions (logistic, maximum likelihood) were fitted to %s, with %s%s%s. ",
                !u->pooled  ? "each person\u2019s answers"
                : !u->alone ? "the answers of all people together, who answered once each at a level"
                            : "each person\u2019s answers, and to those of all people together where they "
                              "answered once each at a level",
                u->right ? "the guess fixed at one half and a lapse of at most 0.06" : "",
                u->right && u->preference ? "; of preferences " : "",
                u->preference ? "both asymptotes free" : "");
    if (u->profile)
        fputs("Intervals of a person\u2019s threshold are from profiles of the likelihood. ", out);
}

static void threshold_methods(const struct report *r)
{
    struct used u = {false};
    for (size_t i = 0; i < r->thresholds.cell_count; i++)
        look(&r->thresholds.cells[i], &u);
    if (u.reversals)
        fputs("A staircase\u2019s threshold is the mean of its last reversals. ", r->out);
    if (u.quest)
        fputs("The threshold of QUEST+ is the mean of its posterior. ", r->out);
    if (u.alone || u.pooled)
        fit_methods(r->out, &u);
    if (u.bayes)
        html_printf(
            r->out,
            "Psychometric functions were %sfitted by Bayes\u2019 rule, with the priors of Sch\u00fctt et "
            "al. (2016) and overdispersed answers. ",
            u.alone || u.pooled ? "also " : "");
    if (u.mean)
        fputs("Means of thresholds and their t intervals are over people. ", r->out);
}

static void adjusted_methods(const struct report *r)
{
    size_t means = 0;
    for (size_t i = 0; i < r->adjusted.cell_count; i++)
        means += isnan(r->adjusted.cells[i].over_people.t.ci_low) ? 0 : 1;
    if (r->adjusted.cell_count)
        html_printf(r->out, "What people set a parameter to was averaged per person%s. ",
                    means ? ", then over people, with a t interval" : "");
}

static void jod_methods(const struct report *r)
{
    bool scaled = false, interval = false;
    for (size_t i = 0; i < r->jod.block_count; i++)
        for (size_t k = 0; k < r->jod.blocks[i].option_count; k++) {
            const struct stat_jod *s = &r->jod.blocks[i].scores[k];
            scaled = scaled || s->status == STAT_JOD_OK;
            interval = interval || (s->status == STAT_JOD_OK && !isnan(s->interval.low));
        }
    if (scaled)
        fputs("Preferences were scaled in just-objectionable differences from the reference by "
              "Thurstone\u2019s case V (maximum likelihood), scenes put together",
              r->out);
    if (interval)
        html_printf(r->out, ", with intervals by a bootstrap over people (%zu replicates)", r->jod.replicates);
    fputs(scaled ? ". " : "", r->out);
}

void report_scale_methods(const struct report *r)
{
    threshold_methods(r);
    adjusted_methods(r);
    jod_methods(r);
}
