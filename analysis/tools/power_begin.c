// What `fovstats power` says before and after its tests.
#include "analysis/tools/power_plan.h"

#include <math.h>
#include <stdio.h>

static void title(const struct power_plan *plan)
{
    if (plan->factors)
        printf("Power of the analysis of variance within people at %g, for an effect of f = %g over %lld cells "
               "each, "
               "by the\nnoncentral F distribution, under sphericity\n",
               plan->alpha, plan->f, (long long)plan->cells);
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

void power_begin(const struct power_plan *plan, const char *hash, struct json *json)
{
    if (!plan->json) {
        title(plan);
        if (plan->choices > 1 || hash)
            printf(" and people differ by %g logits; %g simulated studies a size, seed %.0f", plan->sd,
                   plan->studies, plan->seed);
        puts(power_plan_ratings(plan) ? "" : "\n");
        if (hash)
            printf("Choices per person as in the data with SHA-256 %s\n\n", hash);
        return;
    }
    json_open(json, NULL, '{');
    json_text(json, "program", "fovstats " FOVSTUDY_VERSION);
    if (hash)
        json_text(json, "data_sha256", hash);
    if (plan->factors) {
        json_number(json, "f", plan->f);
        json_open(json, "levels", '[');
        for (size_t i = 0; i < plan->factors; i++)
            json_integer(json, NULL, plan->levels[i]);
        json_close(json, ']');
    } else if (!isnan(plan->d)) {
        json_number(json, "d", plan->d);
        json_bool(json, "unpaired", plan->unpaired);
    } else {
        json_number(json, "share", plan->share);
        json_number(json, "sd", plan->sd);
        json_number(json, "margin", plan->margin);
        json_number(json, "studies", plan->studies);
        json_number(json, "seed", plan->seed);
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
