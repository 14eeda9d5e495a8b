#include "analysis/report/plans.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool plan_is(const struct plan *plan, const char *method, const char *of, const char *per)
{
    return (!method || strcmp(plan->method, method) == 0) && (!of || strcmp(plan->of, of) == 0) &&
           (!per || strcmp(plan->per, per) == 0);
}

static bool same_margin(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static bool add(struct plans *plans, struct sample *sample, const char *line)
{
    char method[32] = "", of[32] = "", per[32] = "";
    double margin = (double)NAN;
    if (sscanf(line, "%31s %31s %31s %lf", method, of, per, &margin) < 3)
        return true; // no plan of ours has fewer words
    if (!(margin > 0 && margin < 0.5))
        margin = (double)NAN;
    for (size_t i = 0; i < plans->count; i++)
        if (plan_is(&plans->items[i], method, of, per) && same_margin(plans->items[i].margin, margin))
            return true;
    struct plan plan = {sample_keep(sample, method), sample_keep(sample, of), sample_keep(sample, per), margin};
    if (!plan.method || !plan.of || !plan.per ||
        !sample_grow(&plans->items, plans->count, sizeof plans->items[0]))
        return false;
    plans->items[plans->count++] = plan;
    return true;
}

bool plans_load(struct plans *out, struct sample *sample)
{
    bool ok = true;
    *out = (struct plans){0};
    for (size_t i = 0; ok && i < sample->session_count; i++) {
        if (sample->sessions[i].excluded)
            continue;
        char *lines = strdup(sample->sessions[i].planned);
        ok = lines != NULL;
        for (char *rest = lines, *line; ok && (line = strsep(&rest, "\n"));)
            ok = add(out, sample, line);
        free(lines);
    }
    if (!ok)
        plans_free(out);
    return ok;
}

// Titles and plans came into session.settings together: sessions with a title have the plans there were.
const char *plans_none(const struct sample *sample)
{
    bool kept = true;
    for (size_t i = 0; i < sample->session_count; i++)
        kept = kept && (sample->sessions[i].excluded || sample->sessions[i].title[0]);
    return kept ? "the protocol planned no analysis"
                : "the protocol planned no analysis, or the sessions were recorded by an early build of "
                  "fovstudy, "
                  "which did not keep what was planned";
}

void plans_free(struct plans *plans)
{
    free(plans->items);
    *plans = (struct plans){0};
}

// The margin of the plans that count, NaN and *out_differ where they have several.
static double margin_of(const struct plans *plans, const char *per, bool *out_differ)
{
    double margin = (double)NAN;
    *out_differ = false;
    for (size_t i = 0; i < plans->count; i++) {
        const struct plan *plan = &plans->items[i];
        if (isnan(plan->margin) || !plan_is(plan, "binomial", "choice", per))
            continue;
        *out_differ = *out_differ || (!isnan(margin) && margin != plan->margin);
        margin = plan->margin;
    }
    return *out_differ ? (double)NAN : margin;
}

double plans_margin(const struct plans *plans, bool *out_differ)
{
    double margin = margin_of(plans, "cell", out_differ);
    return isnan(margin) && !*out_differ ? margin_of(plans, NULL, out_differ) : margin;
}
