// Which cells a planned test joins, and who is in it: as `fovstats planned` has it
// (analysis/report/planned_groups.c and planned_pairs.c).
#include "app/fovstudy/check_power.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct group {
    const char *series, *factor, *level; // factor NULL: cells or all of them
    uint32_t *cells;
    uint32_t cell_count;
};

struct groups {
    const struct check_values *values;
    const struct protocol_analysis *planned;
    struct group *items;
    uint32_t count;
};

static bool differs(const char *a, const char *b)
{
    return a != b && (!a || !b || strcmp(a, b) != 0);
}

static bool join(struct groups *groups, uint32_t cell, const char *factor, const char *level, bool alone)
{
    const char *series = groups->values->cells[cell].series;
    uint32_t i = alone ? groups->count : 0;
    while (i < groups->count &&
           (differs(groups->items[i].series, series) || differs(groups->items[i].factor, factor) ||
            differs(groups->items[i].level, level)))
        i++;
    if (i == groups->count) {
        struct group *items = realloc(groups->items, (i + 1) * sizeof *items);
        if (!items)
            return false;
        groups->items = items;
        items[i] = (struct group){.series = series, .factor = factor, .level = level};
        groups->count++;
    }
    struct group *group = &groups->items[i];
    uint32_t *cells = realloc(group->cells, (group->cell_count + 1) * sizeof *cells);
    if (!cells)
        return false;
    group->cells = cells;
    cells[group->cell_count++] = cell;
    return true;
}

// A person's cells are joined only if asked.
static bool join_cell(struct groups *groups, uint32_t cell)
{
    const struct check_cell *c = &groups->values->cells[cell];
    const char *per = groups->planned->per;
    bool ok = true;
    if (strcmp(per, "cell") == 0 || strcmp(per, "order") == 0 ||
        (*per == '\0' && strcmp(groups->planned->method, "binomial") == 0)) {
        // In order, of those who began with one option and with the other first ratings alone are compared.
        if (strcmp(per, "order") == 0 && strcmp(groups->planned->method, "unpaired_t") == 0 &&
            (!*c->rated || strcmp(c->block, "first") != 0))
            return true;
        return join(groups, cell, NULL, NULL, true);
    }
    if (strcmp(per, "scene") == 0)
        return !check_level_of(c, "scene") || join(groups, cell, "scene", check_level_of(c, "scene"), false);
    if (strcmp(per, "factor") != 0)
        return join(groups, cell, NULL, NULL, false);
    for (uint32_t i = 0; ok && i < c->level_count; i++)
        ok = join(groups, cell, c->levels[i].factor, c->levels[i].level, false);
    return ok;
}

static void label_write(const struct groups *groups, const struct group *group, bool series, char *out,
                        size_t size)
{
    const struct check_cell *c = &groups->values->cells[group->cells[0]];
    const char *per = groups->planned->per;
    size_t used =
        (size_t)snprintf(out, size, "%s%s", series ? group->series : "", series && *group->series ? ": " : "");
    if (group->factor && used < size)
        snprintf(out + used, size - used, "%s=%s", group->factor, group->level);
    else if (*per == '\0' || strcmp(per, "study") == 0 || used >= size)
        return;
    else if (*c->rated)
        snprintf(out + used, size - used, "%s %s", c->rated, c->block);
    else {
        used +=
            (size_t)snprintf(out + used, size - used, "%s%s%s", c->block, *c->trial ? " trial=" : "", c->trial);
        for (uint32_t i = 0; i < c->level_count && used < size; i++)
            used +=
                (size_t)snprintf(out + used, size - used, " %s=%s", c->levels[i].factor, c->levels[i].level);
    }
}

static struct check_part *part_add(struct check_analysis *analysis)
{
    struct check_part *parts = realloc(analysis->parts, (analysis->part_count + 1) * sizeof *parts);
    if (!parts)
        return NULL;
    analysis->parts = parts;
    parts[analysis->part_count] = (struct check_part){0};
    return &parts[analysis->part_count++];
}

static bool has(const struct groups *groups, const struct group *group, uint32_t person)
{
    for (uint32_t i = 0; i < group->cell_count; i++)
        if (groups->values->cells[group->cells[i]].count[person])
            return true;
    return false;
}

// One group against what chance, or no difference, would give.
static bool add_single(struct check_analysis *analysis, const struct groups *groups, const struct group *group)
{
    struct check_part *part = part_add(analysis);
    if (!part)
        return false;
    label_write(groups, group, true, part->label, sizeof part->label);
    part->margin = analysis->test == CHECK_BINOMIAL && analysis->planned->margin > 0 && !*group->series;
    for (uint32_t p = 0; p < groups->values->people; p++) {
        part->people += has(groups, group, p);
        for (uint32_t i = 0; i < group->cell_count; i++)
            part->answers += groups->values->cells[group->cells[i]].count[p];
    }
    return true;
}

// Whether a level of `from` never comes with two levels of `to`, in a series.
static bool fixes(const struct check_values *values, const char *series, const char *from, const char *to)
{
    for (uint32_t i = 0; i < values->cell_count; i++)
        for (uint32_t j = i + 1; j < values->cell_count; j++) {
            const struct check_cell *a = &values->cells[i], *b = &values->cells[j];
            if (strcmp(a->series, series) != 0 || strcmp(b->series, series) != 0)
                continue;
            const char *fa = check_level_of(a, from), *fb = check_level_of(b, from),
                       *ta = check_level_of(a, to), *tb = check_level_of(b, to);
            if (fa && fb && ta && tb && strcmp(fa, fb) == 0 && strcmp(ta, tb) != 0)
                return false;
        }
    return true;
}

static bool differs_freely(const struct check_values *values, const struct group *group,
                           const struct check_cell *a, const struct check_cell *b)
{
    for (uint32_t i = 0; i < a->level_count; i++) {
        const char *key = a->levels[i].factor;
        if (strcmp(key, group->factor) != 0 && differs(a->levels[i].level, check_level_of(b, key)) &&
            !fixes(values, group->series, group->factor, key) &&
            !fixes(values, group->series, key, group->factor))
            return true;
    }
    return false;
}

// Whether two cells are the same but for the factor compared, and what follows from it or fixes it.
static bool same_rest(const struct check_values *values, const struct group *group, uint32_t i, uint32_t j)
{
    const struct check_cell *a = &values->cells[i], *b = &values->cells[j];
    return !group->factor || (strcmp(a->block, b->block) == 0 && !differs_freely(values, group, a, b) &&
                              !differs_freely(values, group, b, a));
}

// People with a value of both in what is otherwise the same.
static bool count_within(struct check_part *part, const struct groups *groups, const struct group *a,
                         const struct group *b)
{
    const struct check_cell *cells = groups->values->cells;
    bool *in = calloc(groups->values->people + 1, sizeof *in);
    for (uint32_t i = 0; in && i < a->cell_count; i++)
        for (uint32_t j = 0; j < b->cell_count; j++)
            if (same_rest(groups->values, a, a->cells[i], b->cells[j]))
                for (uint32_t p = 0; p < groups->values->people; p++)
                    in[p] = in[p] || (cells[a->cells[i]].count[p] && cells[b->cells[j]].count[p]);
    for (uint32_t p = 0; in && p < groups->values->people; p++)
        part->people += in[p];
    free(in);
    return in != NULL;
}

static bool add_pair(struct check_analysis *analysis, const struct groups *groups, const struct group *a,
                     const struct group *b)
{
    struct check_part *part = part_add(analysis);
    char first[PROTOCOL_LABELS], other[PROTOCOL_LABELS];
    if (!part)
        return false;
    label_write(groups, a, true, first, sizeof first);
    label_write(groups, b, false, other, sizeof other);
    snprintf(part->label, sizeof part->label, "%.250s - %.250s", first, other);
    part->pair = true;
    if (analysis->test == CHECK_PAIRED_T)
        return count_within(part, groups, a, b);
    for (uint32_t p = 0; p < groups->values->people; p++) {
        bool in_a = has(groups, a, p), in_b = has(groups, b, p);
        part->people += in_a;
        part->second += in_b;
        part->both += in_a && in_b;
    }
    return true;
}

static bool are_pair(const struct group *a, const struct group *b)
{
    return strcmp(a->series, b->series) == 0 && !differs(a->factor, b->factor);
}

static bool add_pairs(struct check_analysis *analysis, const struct groups *groups)
{
    uint32_t pairs = 0;
    bool ok = true;
    for (uint32_t i = 0; i < groups->count; i++)
        for (uint32_t j = i + 1; j < groups->count; j++)
            pairs += are_pair(&groups->items[i], &groups->items[j]);
    if (pairs == 0)
        analysis->none = "it compares two, and there is one alone";
    if (pairs > CHECK_PAIRS) {
        analysis->none = "more pairs than a table shows; plan it per factor or scene";
        analysis->too_many = pairs;
        return true;
    }
    for (uint32_t i = 0; ok && i < groups->count; i++)
        for (uint32_t j = i + 1; ok && j < groups->count; j++)
            ok = !are_pair(&groups->items[i], &groups->items[j]) ||
                 add_pair(analysis, groups, &groups->items[i], &groups->items[j]);
    return ok;
}

static bool add_singles(struct check_analysis *analysis, const struct groups *groups)
{
    bool ok = true;
    for (uint32_t i = 0; ok && i < groups->count; i++)
        ok = add_single(analysis, groups, &groups->items[i]);
    return ok;
}

bool check_tests(struct check_analysis *analysis, const struct check_values *values)
{
    struct groups groups = {.values = values, .planned = analysis->planned};
    bool ok = true, differences = values->cell_count > 0 && values->cells[0].difference;
    for (uint32_t i = 0; ok && i < values->cell_count; i++)
        ok = join_cell(&groups, i);
    if (ok && groups.count == 0)
        analysis->none = values->cell_count == 0 ? "no trial gives it" : "the trials have no factor";
    else if (ok && (analysis->test == CHECK_TWO_SAMPLE_T || (analysis->test == CHECK_PAIRED_T && !differences)))
        ok = add_pairs(analysis, &groups);
    else if (ok)
        ok = add_singles(analysis, &groups);
    for (uint32_t i = 0; i < groups.count; i++)
        free(groups.items[i].cells);
    free(groups.items);
    return ok;
}
