// Plans as text and JSON for `fovstudy check`, and as a hash.
#include "studies/engine/plan.h"

#include "studies/protocol/text.h"

#include <stdlib.h>
#include <string.h>

static const char *block_name(const struct plan *plan, const struct plan_trial *trial)
{
    return plan->protocol->blocks[trial->block].name;
}

char *plan_table_json(const struct plan *plan)
{
    struct text text = {0};
    text_add(
        &text,
        "{\"protocol\":\"%s\",\"sha256\":\"%s\",\"seed\":%llu,\"number\":%u,\"imbalance\":%u,\"conditions\":[",
        plan->protocol->name, plan->protocol->sha256_hex, (unsigned long long)plan->seed, plan->number + 1,
        plan->imbalance);
    for (uint32_t i = 0; i < plan->condition_count; i++)
        text_add(&text, "%s\n{\"mode\":\"%s\",\"parameters\":%s}", i ? "," : "", plan->conditions[i].mode,
                 plan->conditions[i].parameters);
    text_add(&text, "],\"trials\":[");
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        text_add(&text,
                 "%s\n{\"ordinal\":%u,\"block\":\"%s\",\"kind\":\"%s\",\"scene\":\"%s\",\"settings\":%s,"
                 "\"factors\":%s",
                 i ? "," : "", trial->ordinal, block_name(plan, trial), plan_trial_kind(trial), trial->scene,
                 trial->settings, trial->factors);
        text_add(&text, ",\"option_a\":%d,\"option_b\":", trial->option[0]);
        text_add(&text, trial->option[1] < 0 ? "null" : "%d", trial->option[1]);
        text_add(&text, ",\"test_slot\":");
        text_add(&text, trial->test_slot == PLAN_SLOT_NONE ? "null" : "\"%s\"",
                 trial->test_slot == PLAN_SLOT_NONE ? "" : plan_slot_name(trial->test_slot));
        text_add(&text, ",\"first_shown\":\"%s\",\"fixation\":\"%s\",\"question\":\"%s\",\"seed\":%llu}",
                 plan_slot_name(trial->first_shown), trial->fixation,
                 trial->question ? trial->question->name : "", (unsigned long long)trial->seed);
    }
    text_add(&text, "]}\n");
    return text_take(&text);
}

void plan_hash(const struct plan *plan, char out[SHA256_HEX])
{
    char *table = plan_table_json(plan);
    uint8_t digest[SHA256_BYTES] = {0}; // all zero: out of memory
    if (table)
        sha256(table, strlen(table), digest);
    free(table);
    sha256_hex(digest, out);
}

// "time_warped {...}" with only those parameters that differ from the mode's defaults would hide what is shown,
// so all of them stand in a list of conditions and the table names them by number.
char *plan_table_text(const struct plan *plan)
{
    struct text text = {0};
    text_add(&text, "%s, participant number %u, seed %llu, protocol %.12s\n", plan->protocol->name,
             plan->number + 1, (unsigned long long)plan->seed, plan->protocol->sha256_hex);
    text_add(&text, "\n%5s  %-14s %-7s %-12s %3s %3s %5s %6s  %s\n", "trial", "block", "kind", "scene", "a",
             "b", "test", "first", "factors");
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        const char *test = plan_slot_name(trial->test_slot);
        text_add(&text, "%5u  %-14s %-7s %-12s %3d ", trial->ordinal, block_name(plan, trial),
                 plan_trial_kind(trial), trial->scene, trial->option[0] + 1);
        if (trial->option[1] >= 0)
            text_add(&text, "%3d ", trial->option[1] + 1);
        else
            text_add(&text, "  - ");
        text_add(&text, "%5s %6s  %s\n", test ? test : "-", plan_slot_name(trial->first_shown), trial->factors);
    }
    text_add(&text, "\ncondition\n");
    for (uint32_t i = 0; i < plan->condition_count; i++)
        text_add(&text, "%9u  %s %s\n", i + 1, plan->conditions[i].mode, plan->conditions[i].parameters);
    if (plan->imbalance)
        text_add(&text, "\nbalance: %u trials off what would be even; no better assignment was found\n",
                 plan->imbalance);
    else
        text_add(&text, "\nbalance: scenes, sides and first-shown options within one\n");
    return text_take(&text);
}

// How often something came in one cell of one block.
struct count {
    uint32_t block, cell;
    char factors[PLAN_JSON];
    uint32_t trials, test_a, test_b, test_first, scene[PROTOCOL_SCENES];
};

struct counts {
    struct count *rows;
    uint32_t used, capacity;
};

static struct count *count_row(struct counts *counts, const struct plan_trial *trial)
{
    for (uint32_t i = 0; i < counts->used; i++)
        if (counts->rows[i].block == trial->block && counts->rows[i].cell == trial->cell &&
            strcmp(counts->rows[i].factors, trial->factors) == 0)
            return &counts->rows[i];
    if (counts->used == counts->capacity) {
        uint32_t capacity = counts->capacity ? 2 * counts->capacity : 32;
        struct count *rows = realloc(counts->rows, capacity * sizeof *rows);
        if (!rows)
            return NULL;
        counts->rows = rows;
        counts->capacity = capacity;
    }
    struct count *row = &counts->rows[counts->used++];
    *row = (struct count){.block = trial->block, .cell = trial->cell};
    memcpy(row->factors, trial->factors, sizeof row->factors);
    return row;
}

static bool count_trial(struct counts *counts, const struct protocol *protocol, const struct plan_trial *trial)
{
    struct count *row = count_row(counts, trial);
    if (!row)
        return false;
    row->trials++;
    row->test_a += trial->test_slot == PLAN_SLOT_A;
    row->test_b += trial->test_slot == PLAN_SLOT_B;
    row->test_first += trial->test_slot == trial->first_shown;
    for (uint32_t i = 0; i < protocol->scene_count; i++)
        row->scene[i] += strcmp(protocol->scenes[i], trial->scene) == 0;
    return true;
}

static int by_block_and_cell(const void *left, const void *right)
{
    const struct count *a = left, *b = right;
    if (a->block != b->block)
        return a->block < b->block ? -1 : 1;
    if (a->cell != b->cell)
        return a->cell < b->cell ? -1 : 1;
    return strcmp(a->factors, b->factors);
}

static bool count_all(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count,
                      struct counts *counts)
{
    bool ok = true;
    for (uint32_t i = 0; i < count && ok; i++) {
        struct plan *plan = plan_create(protocol, seed, first + i);
        ok = plan != NULL;
        for (uint32_t t = 0; ok && t < plan->trial_count; t++)
            ok = count_trial(counts, protocol, &plan->trials[t]);
        plan_destroy(plan);
    }
    if (ok && counts->used)
        qsort(counts->rows, counts->used, sizeof *counts->rows, by_block_and_cell);
    return ok;
}

char *plan_counts_text(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count)
{
    struct counts counts = {0};
    struct text text = {0};
    text_add(&text, "%u participants from number %u, seed %llu\n\n%-14s %7s %7s %7s %7s", count, first + 1,
             (unsigned long long)seed, "block", "trials", "test=a", "test=b", "first");
    for (uint32_t i = 0; i < protocol->scene_count; i++)
        text_add(&text, " %*s", (int)(strlen(protocol->scenes[i]) < 7 ? 7 : strlen(protocol->scenes[i])),
                 protocol->scenes[i]);
    text_add(&text, "  factors\n");
    text.failed = !count_all(protocol, seed, first, count, &counts) || text.failed;
    for (uint32_t r = 0; r < counts.used; r++) {
        const struct count *row = &counts.rows[r];
        text_add(&text, "%-14s %7u %7u %7u %7u", protocol->blocks[row->block].name, row->trials, row->test_a,
                 row->test_b, row->test_first);
        for (uint32_t i = 0; i < protocol->scene_count; i++)
            text_add(&text, " %*u", (int)(strlen(protocol->scenes[i]) < 7 ? 7 : strlen(protocol->scenes[i])),
                     row->scene[i]);
        text_add(&text, "  %s\n", row->factors);
    }
    free(counts.rows);
    return text_take(&text);
}

char *plan_counts_json(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count)
{
    struct counts counts = {0};
    struct text text = {0};
    text_add(&text, "[");
    text.failed = !count_all(protocol, seed, first, count, &counts) || text.failed;
    for (uint32_t r = 0; r < counts.used; r++) {
        const struct count *row = &counts.rows[r];
        text_add(&text,
                 "%s\n{\"block\":\"%s\",\"factors\":%s,\"trials\":%u,\"test_a\":%u,\"test_b\":%u,\"test_"
                 "first\":%u,\"scenes\":{",
                 r ? "," : "", protocol->blocks[row->block].name, row->factors, row->trials, row->test_a,
                 row->test_b, row->test_first);
        for (uint32_t i = 0; i < protocol->scene_count; i++)
            text_add(&text, "%s\"%s\":%u", i ? "," : "", protocol->scenes[i], row->scene[i]);
        text_add(&text, "}}");
    }
    text_add(&text, "]\n");
    free(counts.rows);
    return text_take(&text);
}
