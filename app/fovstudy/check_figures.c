#include "app/fovstudy/check_figures.h"

#include "analysis/stats/power.h"
#include "analysis/stats/power_equivalence.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// "paired_t of rating, per order"
static void name_write(struct text *text, const struct check_analysis *analysis)
{
    const struct protocol_analysis *planned = analysis->planned;
    text_add(text, "%s of %s%s%s", planned->method, planned->of, *planned->per ? ", per " : "", planned->per);
}

// Tests of equality within the planned margin, of one answer each; with several they depend on how people
// differ.
static void margin_write(struct text *text, const struct check_part *part, double margin, uint32_t same)
{
    double power = stat_binomial_equivalence_power(part->people, margin, 0.5, CHECK_ALPHA);
    text_add(text, "    %u more of equality within the planned 50 +- %.4g %%: ", same, 100 * margin);
    if (part->answers > part->people)
        text_add(text, "depends on how people differ; fovstats power simulates it\n");
    else if (isnan(power))
        text_add(text, "nothing\n");
    else
        text_add(text, "shown in %.1f %% of studies without a preference\n", floor(1000 * power) / 10);
}

static void binomial_write(struct text *text, const struct check_part *part, double planned, uint32_t same)
{
    double share = stat_binomial_detectable(part->people, CHECK_ALPHA, CHECK_POWER),
           margin = stat_binomial_margin(part->people, CHECK_ALPHA, CHECK_POWER);
    if (isnan(share))
        text_add(text, "no preference, not even of all of them");
    else
        text_add(text, "a preference of %.1f %% or more", ceil(1000 * share) / 10);
    if (isnan(margin))
        text_add(text, "; no equivalence\n");
    else
        text_add(text, "; equivalence within 50 +- %.1f %%\n", ceil(1000 * margin) / 10);
    if (part->margin)
        margin_write(text, part, planned, same);
}

// The smallest difference in standard deviations; NaN where there is none, or no test.
static double detectable(const struct check_analysis *analysis, const struct check_part *part)
{
    if (analysis->test == CHECK_PAIRED_T)
        return stat_paired_t_detectable(part->people, CHECK_ALPHA, CHECK_POWER);
    return part->both ? (double)NAN
                      : stat_two_sample_t_detectable(part->people, part->second, CHECK_ALPHA, CHECK_POWER);
}

static void t_write(struct text *text, const struct check_analysis *analysis, const struct check_part *part)
{
    double d = detectable(analysis, part);
    if (part->both)
        text_add(text, "no test: %u have both; a paired test is theirs\n", part->both);
    else if (analysis->test == CHECK_PAIRED_T && part->people == 0)
        text_add(text, "no test: nobody has both in what is otherwise the same\n");
    else if (isnan(d))
        text_add(text, "nothing\n");
    else
        text_add(text, "a difference of %.2f standard deviations or more\n", ceil(100 * d) / 100);
}

static int by_number(uint32_t a, uint32_t b)
{
    return (a > b) - (a < b);
}

// Tests that come together here have the same figures.
static int by_people(const void *left, const void *right)
{
    const struct check_part *a = left, *b = right;
    int order = by_number(a->people, b->people);
    order = order ? order : by_number(a->second, b->second);
    order = order ? order : by_number(a->both, b->both);
    order = order ? order : by_number(a->margin, b->margin);
    return order ? order : by_number(a->answers, b->answers);
}

static void parts_write(struct text *text, const struct check_analysis *analysis, const struct check_part *part,
                        uint32_t same)
{
    text_add(text, "    ");
    if (analysis->part_count > 1)
        text_add(text, "%u %s%s, ", same, part->pair ? "pair" : "test", same > 1 ? "s" : "");
    text_add(text, "n = %u", part->people);
    if (analysis->test == CHECK_TWO_SAMPLE_T)
        text_add(text, " and %u", part->second);
    text_add(text, "%s%s%s%s: ", same > 1 ? " each" : "", same == 1 && *part->label ? " (" : "",
             same == 1 ? part->label : "", same == 1 && *part->label ? ")" : "");
    if (analysis->test == CHECK_BINOMIAL)
        binomial_write(text, part, analysis->planned->margin, same);
    else
        t_write(text, analysis, part);
}

static void notes_write(struct text *text, const struct check_analysis *analysis, bool repeated)
{
    if (repeated)
        text_add(
            text,
            "    choices repeat within participants, who differ, so that people are tested; n counts them, and "
            "the figures\n    are those of which option each chose more often; fovstats power simulates the "
            "test itself\n");
    if (analysis->test == CHECK_PAIRED_T)
        text_add(text, "    n counts participants, each with one difference; standard deviations are of the "
                       "differences\n");
    if (analysis->test == CHECK_TWO_SAMPLE_T)
        text_add(text, "    n counts the participants of two groups; standard deviations are of people\n");
}

// Tests with as many people and answers have the same figures: one line for all of them.
static void parts_text(struct text *text, const struct check_analysis *analysis)
{
    bool repeated = false;
    struct check_part *parts = calloc(analysis->part_count + 1, sizeof *parts);
    text->failed = text->failed || !parts;
    if (!parts)
        return;
    for (uint32_t i = 0; i < analysis->part_count; i++)
        parts[i] = analysis->parts[i];
    qsort(parts, analysis->part_count, sizeof *parts, by_people);
    for (uint32_t i = 0, same; i < analysis->part_count; i += same) {
        for (same = 1; i + same < analysis->part_count && by_people(&parts[i], &parts[i + same]) == 0;)
            same++;
        parts_write(text, analysis, &parts[i], same);
        repeated = repeated || (analysis->test == CHECK_BINOMIAL && parts[i].answers > parts[i].people);
    }
    notes_write(text, analysis, repeated);
    free(parts);
}

void check_figures_text(struct text *text, const struct check_analyses *analyses, uint32_t people, bool assumed)
{
    text_add(text, "\nwhat the planned tests find, each by itself, with %.0f %% power and %.0f %% error\n",
             100 * CHECK_POWER, 100 * CHECK_ALPHA);
    text_add(text, "  %u participants%s\n", people,
             assumed ? " are assumed; write how many with 'participants', or try --counts N" : "");
    if (analyses->count == 0)
        text_add(text, "  the file plans no analysis; add 'analysis'\n");
    for (uint32_t i = 0; i < analyses->count; i++) {
        const struct check_analysis *analysis = &analyses->each[i];
        text_add(text, "  ");
        name_write(text, analysis);
        text_add(text, "\n");
        if (analysis->test == CHECK_ESTIMATE)
            text_add(text, "    no figure: %s\n",
                     analysis->planned->method[0] == 'm' ? "an estimate, nothing is tested"
                                                         : "power of this method is not computed here");
        else if (analysis->too_many)
            text_add(text, "    no test: %u are %s\n", analysis->too_many, analysis->none);
        else if (analysis->none)
            text_add(text, "    no test: %s\n", analysis->none);
        else
            parts_text(text, analysis);
    }
}

static void number_json(struct text *text, const char *name, double value)
{
    text_add(text, ",\"%s\":", name);
    if (isnan(value))
        text_add(text, "null");
    else
        text_number(text, value);
}

static void part_json(struct text *text, const struct check_analysis *analysis, const struct check_part *part)
{
    text_add(text, "%s{\"label\":", part == analysis->parts ? "" : ",");
    text_json_string(text, part->label);
    text_add(text, ",\"n\":%u", part->people);
    if (analysis->test == CHECK_BINOMIAL)
        text_add(text, ",\"answers\":%u", part->answers);
    if (analysis->test == CHECK_BINOMIAL) {
        number_json(text, "share", stat_binomial_detectable(part->people, CHECK_ALPHA, CHECK_POWER));
        number_json(text, "margin", stat_binomial_margin(part->people, CHECK_ALPHA, CHECK_POWER));
    }
    text_add(text, ",\"margin_planned\":%s", part->margin ? "true" : "false");
    if (part->margin && part->answers == part->people)
        number_json(text, "planned_margin_power",
                    stat_binomial_equivalence_power(part->people, analysis->planned->margin, 0.5, CHECK_ALPHA));
    if (analysis->test == CHECK_TWO_SAMPLE_T)
        text_add(text, ",\"n_second\":%u,\"both\":%u", part->second, part->both);
    if (analysis->test != CHECK_BINOMIAL)
        number_json(text, "d", detectable(analysis, part));
    text_add(text, "}");
}

void check_figures_json(struct text *text, const struct check_analyses *analyses)
{
    text_add(text, ",\n\"power\":[");
    for (uint32_t i = 0; i < analyses->count; i++) {
        const struct check_analysis *analysis = &analyses->each[i];
        const struct protocol_analysis *planned = analysis->planned;
        text_add(text, "%s\n{\"method\":\"%s\",\"of\":\"%s\",\"per\":\"%s\",\"alpha\":%g,\"power\":%g",
                 i ? "," : "", planned->method, planned->of, planned->per, CHECK_ALPHA, CHECK_POWER);
        if (planned->margin > 0)
            number_json(text, "margin", planned->margin);
        text_add(text, ",\"none\":");
        text_json_string(text, analysis->none ? analysis->none : "");
        text_add(text, ",\"parts\":[");
        for (uint32_t p = 0; p < analysis->part_count; p++)
            part_json(text, analysis, &analysis->parts[p]);
        text_add(text, "]}");
    }
    text_add(text, "]");
}
