// What `fovstats power` says before and after its tests.
#include "analysis/tools/power_plan.h"

#include <math.h>
#include <stdio.h>

static void title(const struct power_plan *plan)
{
    if (!isnan(plan->f))
        printf(
            "Power of the analysis of variance within people at %g, for an effect of f = %g over the cells, by "
            "the\nnoncentral F distribution, under sphericity\n",
            plan->alpha, plan->f);
    else if (!isnan(plan->d) && plan->unpaired)
        printf("Power of Student's t-test of two groups, two-sided at %g, where their means differ by %g SD of "
               "the "
               "ratings;\npeople of both groups together, halves (Welch's test has nearly this power in equal "
               "groups)\n",
               plan->alpha, plan->d);
    else if (!isnan(plan->d))
        printf(
            "Power of the paired t-test, two-sided at %g, where the mean difference is %g SD of the people's "
            "differences\n",
            plan->alpha, plan->d);
    else if (!isnan(plan->margin))
        printf("Power to show equality within %g to %g at %g, where the mean preference is %g",
               0.5 - plan->margin, 0.5 + plan->margin, plan->alpha, plan->share);
    else
        printf("Power against one half, two-sided at %g, where the mean preference is %g", plan->alpha,
               plan->share);
}

static void begin_text(const struct power_plan *plan, const struct power_source *source)
{
    title(plan);
    if (source->simulates && !source->hash)
        printf(" and people differ by %g logits; %g simulated studies a size, seed %.0f", plan->sd,
               plan->studies, plan->seed);
    puts(power_plan_ratings(plan) ? "" : "\n");
    if (source->hash)
        printf("%s as in the data with SHA-256 %s\n",
               isnan(plan->f) ? "Choices per person" : "Factors and levels", source->hash);
    if (source->simulates && source->hash)
        printf("Cells in which somebody chooses several times are simulated: people differ by %g logits; %g "
               "studies "
               "a size, seed %.0f\n",
               plan->sd, plan->studies, plan->seed);
    if (source->hash)
        putchar('\n');
}

static void designs_json(const struct power_source *source, struct json *json)
{
    json_open(json, "designs", '[');
    for (size_t i = 0; i < source->design_count; i++) {
        const struct power_design *design = &source->designs[i];
        json_open(json, NULL, '{');
        json_text(json, "question", design->question ? design->question : "");
        json_text(json, "block", design->block ? design->block : "");
        json_text(json, "levels_from", design->question ? "file" : "--levels");
        json_open(json, "factors", '[');
        for (size_t k = 0; k < design->factors; k++) {
            json_open(json, NULL, '{');
            json_text(json, "name", design->names[k]);
            json_integer(json, "levels", design->levels[k]);
            json_close(json, '}');
        }
        json_close(json, ']');
        json_integer(json, "cells", design->cells);
        json_text(json, "left_out", design->left_out);
        json_text(json, "not_planned", design->refusal);
        json_close(json, '}');
    }
    json_close(json, ']');
}

void power_begin(const struct power_plan *plan, const struct power_source *source, struct json *json)
{
    const double none = (double)NAN;
    if (!plan->json) {
        begin_text(plan, source);
        return;
    }
    json_open(json, NULL, '{');
    json_text(json, "program", "fovstats " FOVSTUDY_VERSION);
    if (source->hash)
        json_text(json, "data_sha256", source->hash);
    if (!isnan(plan->f)) {
        json_number(json, "f", plan->f);
        designs_json(source, json);
    } else if (!isnan(plan->d)) {
        json_number(json, "d", plan->d);
        json_bool(json, "unpaired", plan->unpaired);
    } else {
        json_number(json, "share", plan->share);
        json_number(json, "margin", plan->margin);
        json_bool(json, "simulates", source->simulates);
        json_number(json, "sd", source->simulates ? plan->sd : none);
        json_number(json, "studies", source->simulates ? plan->studies : none);
        json_number(json, "seed", source->simulates ? plan->seed : none);
    }
    json_number(json, "alpha", plan->alpha);
    json_number(json, "wanted_power", plan->power);
    json_open(json, "cells", '[');
}

void power_end(const struct power_plan *plan, struct json *json)
{
    if (!plan->json)
        return;
    json_close(json, ']');
    json_close(json, '}');
    putchar('\n');
}
