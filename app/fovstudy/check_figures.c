#include "app/fovstudy/check_figures.h"

#include "analysis/stats/power.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// "paired_t of rating, per order"
static void name_write(struct text *text, const struct check_analysis *analysis)
{
    const struct protocol_analysis *planned = analysis->planned;
    text_add(text, "%s of %s%s%s", planned->method, planned->of, *planned->per ? ", per " : "", planned->per);
}

static void binomial_write(struct text *text, const struct check_part *part)
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
}

static void t_write(struct text *text, double d)
{
    if (isnan(d))
        text_add(text, "nothing\n");
    else
        text_add(text, "a difference of %.2f standard deviations or more\n", ceil(100 * d) / 100);
}

static int by_people_alone(const void *left, const void *right)
{
    const struct check_part *a = left, *b = right;
    return (a->people > b->people) - (a->people < b->people);
}

static int by_people(const void *left, const void *right)
{
    const struct check_part *a = left, *b = right;
    if (a->people != b->people)
        return a->people < b->people ? -1 : 1;
    return (a->answers > b->answers) - (a->answers < b->answers);
}

// Tests with as many people and answers have the same figures: one line for all of them.
static void parts_text(struct text *text, const struct check_analysis *analysis)
{
    bool paired = analysis->test == CHECK_PAIRED_T, repeated = false;
    const char *per = analysis->planned->per;
    bool levels =
        paired && (strcmp(per, "factor") == 0 || strcmp(per, "scene") == 0); // compared with each other
    struct check_part *parts = calloc(analysis->part_count + 1, sizeof *parts);
    text->failed = text->failed || !parts;
    for (uint32_t i = 0; i < analysis->part_count && parts; i++)
        parts[i] = analysis->parts[i];
    int (*order)(const void *, const void *) = paired ? by_people_alone : by_people;
    if (parts)
        qsort(parts, analysis->part_count, sizeof *parts, order);
    for (uint32_t i = 0, same; i < analysis->part_count && parts; i += same) {
        for (same = 1; i + same < analysis->part_count && order(&parts[i], &parts[i + same]) == 0;)
            same++;
        text_add(text, "    ");
        if (analysis->part_count > 1)
            text_add(text, "%u %s%s, ", same, levels ? "level" : "test", same > 1 ? "s" : "");
        text_add(text, "n = %u%s: ", parts[i].people, same > 1 ? " each" : "");
        if (paired)
            t_write(text, stat_paired_t_detectable(parts[i].people, CHECK_ALPHA, CHECK_POWER));
        else
            binomial_write(text, &parts[i]);
        repeated = repeated || parts[i].answers > parts[i].people;
    }
    if (repeated && !paired)
        text_add(
            text,
            "    choices repeat within participants, so n counts participants: the test at their level, of "
            "which\n    option each of them chose more often; their single choices are not independent\n");
    if (paired)
        text_add(text, "    n counts participants, each with one difference; standard deviations are of the "
                       "differences\n");
    free(parts);
}

static void two_samples_text(struct text *text, const struct check_analysis *analysis)
{
    const struct check_part *parts = analysis->parts;
    if (analysis->part_count != 2) {
        text_add(text, "    needs two groups of people, and there %s %u\n",
                 analysis->part_count == 1 ? "is" : "are", analysis->part_count);
        return;
    }
    text_add(text, "    n = %u (%s) and %u (%s): ", parts[0].people, parts[0].label, parts[1].people,
             parts[1].label);
    t_write(text, stat_two_sample_t_detectable(parts[0].people, parts[1].people, CHECK_ALPHA, CHECK_POWER));
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
        else if (analysis->part_count == 0)
            text_add(text, "    no trial gives it\n");
        else if (analysis->test == CHECK_TWO_SAMPLE_T)
            two_samples_text(text, analysis);
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
    text_add(text, ",\"n\":%u,\"answers\":%u", part->people, part->answers);
    if (analysis->test == CHECK_BINOMIAL) {
        number_json(text, "share", stat_binomial_detectable(part->people, CHECK_ALPHA, CHECK_POWER));
        number_json(text, "margin", stat_binomial_margin(part->people, CHECK_ALPHA, CHECK_POWER));
    }
    if (analysis->test == CHECK_PAIRED_T)
        number_json(text, "d", stat_paired_t_detectable(part->people, CHECK_ALPHA, CHECK_POWER));
    text_add(text, "}");
}

void check_figures_json(struct text *text, const struct check_analyses *analyses)
{
    text_add(text, ",\n\"power\":[");
    for (uint32_t i = 0; i < analyses->count; i++) {
        const struct check_analysis *analysis = &analyses->each[i];
        const struct protocol_analysis *planned = analysis->planned;
        const struct check_part *parts = analysis->parts;
        text_add(text, "%s\n{\"method\":\"%s\",\"of\":\"%s\",\"per\":\"%s\",\"alpha\":%g,\"power\":%g",
                 i ? "," : "", planned->method, planned->of, planned->per, CHECK_ALPHA, CHECK_POWER);
        if (analysis->test == CHECK_TWO_SAMPLE_T && analysis->part_count == 2)
            number_json(
                text, "d",
                stat_two_sample_t_detectable(parts[0].people, parts[1].people, CHECK_ALPHA, CHECK_POWER));
        text_add(text, ",\"parts\":[");
        for (uint32_t p = 0; p < analysis->part_count; p++)
            part_json(text, analysis, &parts[p]);
        text_add(text, "]}");
    }
    text_add(text, "]");
}
