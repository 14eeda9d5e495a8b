#include "analysis/tools/choices_three.h"

#include "analysis/tools/choices_people.h"

#include <inttypes.h>
#include <math.h>

static void row(struct table *t, const struct choice_cell *cell, const struct choice_three *x)
{
    table_cell(t, "%s", cell->block);
    table_cell(t, "%s", cell->label);
    table_cell(t, "%zu", x->people);
    table_cell(t, "%" PRId64, x->test);
    table_cell(t, "%" PRId64, x->equal);
    table_cell(t, "%" PRId64, x->reference);
    table_cell(t, "%.1f", 100 * x->negative);
    choices_range_cell(t, x->negative_ci);
    table_cell(t, "%+.3f", x->net);
    if (isnan(x->net_ci.low))
        table_cell(t, "-");
    else
        table_cell(t, "%+.3f to %+.3f", x->net_ci.low, x->net_ci.high);
    choices_p_cell(t, x->p_value);
}

bool choices_three_print(const struct choices *c)
{
    char ci[32];
    bool any = false, ok = true;
    snprintf(ci, sizeof ci, "%g %% CI", 100 * c->conf);
    const char *const headings[] = {"<block",     "<cell", "people", "test", "equal", "reference",
                                    "negative %", ci,      "net",    ci,     "p",     NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; ok && i < c->cell_count; i++) {
        struct choice_three x;
        if (!choice_three_applies(c, &c->cells[i]))
            continue;
        any = true;
        ok = choice_three_of(c, &c->cells[i], &x);
        if (ok)
            row(&t, &c->cells[i], &x);
    }
    if (any && ok) {
        puts("\nAnswers of three kinds: test better, equal, reference better");
        ok = table_print(&t, stdout);
        puts("negative: answers for the reference of all, mean over people. net: test minus reference over "
             "all, mean "
             "over people,\n-1 (always the reference) to 1. p: exact sign flip over people, where \"equal\" "
             "counts 0; "
             "two-sided. A large p does\nnot show equality: --margin does.");
    }
    table_finish(&t);
    return ok;
}

bool choices_three_json(struct json *json, const struct choices *c)
{
    bool ok = true;
    json_open(json, "three_way", '[');
    for (size_t i = 0; ok && i < c->cell_count; i++) {
        struct choice_three x;
        if (!choice_three_applies(c, &c->cells[i]))
            continue;
        ok = choice_three_of(c, &c->cells[i], &x);
        json_open(json, NULL, '{');
        json_text(json, "block", c->cells[i].block);
        json_text(json, "cell", c->cells[i].label);
        json_integer(json, "people", (int64_t)x.people);
        json_integer(json, "test", x.test);
        json_integer(json, "equal", x.equal);
        json_integer(json, "reference", x.reference);
        json_number(json, "negative", x.negative);
        json_number(json, "negative_low", x.negative_ci.low);
        json_number(json, "negative_high", x.negative_ci.high);
        json_number(json, "net", x.net);
        json_number(json, "net_low", x.net_ci.low);
        json_number(json, "net_high", x.net_ci.high);
        json_number(json, "p_value", x.p_value);
        json_number(json, "least_p", x.least_p);
        json_close(json, '}');
    }
    json_close(json, ']');
    return ok;
}
