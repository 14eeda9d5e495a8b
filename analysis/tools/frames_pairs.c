#include "analysis/tools/frames_pairs.h"

#include "analysis/tools/table.h"

#include <math.h>
#include <stdio.h>

static const char *const measures[FRAMES_MEASURES] = {"GPU", "CPU"};

static void cells(struct table *t, double value, double low, double high)
{
    if (isnan(value))
        table_cell(t, "-");
    else
        table_cell(t, "%.3f", value);
    if (isnan(low))
        table_cell(t, "-");
    else
        table_cell(t, "%.3f to %.3f", low, high);
}

bool frames_pairs_print(const struct sample *sample, const struct frames_pairs *pairs, double conf)
{
    const char *const headings[] = {"<test", "<reference", "<time", "trials", "people", "ms",
                                    "CI",    "ratio",      "CI",    "late %", "CI",     NULL};
    struct table t;
    bool some_unknown = false;
    if (pairs->count == 0)
        return true;
    table_init(&t, headings);
    for (size_t i = 0; i < pairs->count; i++) {
        const struct frames_pair *p = &pairs->pairs[i];
        table_cell(&t, "%s", sample->conditions[p->test].label);
        table_cell(&t, "%s", sample->conditions[p->reference].label);
        table_cell(&t, "%s", measures[p->measure]);
        table_cell(&t, "%zu", p->trials);
        table_cell(&t, "%zu", p->people);
        cells(&t, p->difference_ms.mean, p->difference_ms.t.ci_low, p->difference_ms.t.ci_high);
        cells(&t, exp(p->log_ratio.mean), exp(p->log_ratio.t.ci_low), exp(p->log_ratio.t.ci_high));
        cells(&t, 100 * p->late.mean, 100 * p->late.t.ci_low, 100 * p->late.t.ci_high);
        some_unknown = some_unknown || p->late.people < p->people || p->log_ratio.people < p->people;
    }
    puts("\nTest option less reference within trials: medians of full frames, their ratio, and percent of them "
         "late");
    bool ok = table_print(&t, stdout);
    table_finish(&t);
    printf("Each trial counts once; a person's trials are averaged, and the %g %% interval is Student's t over "
           "people\n(- for one person, and where all are the same).%s\n",
           100 * conf, pairs->simulated_clock ? " Late frames are the simulated clock's." : "");
    for (size_t i = 0; some_unknown && i < pairs->count; i++) {
        const struct frames_pair *p = &pairs->pairs[i];
        printf("%s against %s: late frames are known of %zu of the %zu people, the ratio of %zu.\n",
               sample->conditions[p->test].label, sample->conditions[p->reference].label, p->late.people,
               p->people, p->log_ratio.people);
    }
    return ok;
}

static void value_json(struct json *json, const char *key, size_t people, double estimate, double low,
                       double high)
{
    json_open(json, key, '{');
    json_integer(json, "people", (int64_t)people);
    json_number(json, "estimate", estimate);
    json_number(json, "ci_low", low);
    json_number(json, "ci_high", high);
    json_close(json, '}');
}

void frames_pairs_json(struct json *json, const struct sample *sample, const struct frames_pairs *pairs)
{
    json_open(json, "pairs", '[');
    for (size_t i = 0; i < pairs->count; i++) {
        const struct frames_pair *p = &pairs->pairs[i];
        json_open(json, NULL, '{');
        json_text(json, "test", sample->conditions[p->test].label);
        json_text(json, "reference", sample->conditions[p->reference].label);
        json_text(json, "time", measures[p->measure]);
        json_integer(json, "trials", (int64_t)p->trials);
        json_integer(json, "people", (int64_t)p->people);
        value_json(json, "difference_ms", p->difference_ms.people, p->difference_ms.mean,
                   p->difference_ms.t.ci_low, p->difference_ms.t.ci_high);
        value_json(json, "ratio", p->log_ratio.people, exp(p->log_ratio.mean), exp(p->log_ratio.t.ci_low),
                   exp(p->log_ratio.t.ci_high));
        value_json(json, "late_share", p->late.people, p->late.mean, p->late.t.ci_low, p->late.t.ci_high);
        json_close(json, '}');
    }
    json_close(json, ']');
}
