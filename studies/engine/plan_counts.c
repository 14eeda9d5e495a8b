// What the plans of many participants have in common, counted: cells, scenes, sides, and which cell follows
// which.
#include "studies/engine/plan.h"

#include "studies/engine/plan_text.h"

#include <stdlib.h>
#include <string.h>

bool plan_each(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count, plan_fn visit,
               void *user)
{
    bool ok = true;
    for (uint32_t i = 0; i < count && ok; i++) {
        struct plan *plan = plan_create_bare(protocol, seed, first + i);
        ok = plan && visit(user, plan);
        plan_destroy(plan);
    }
    return ok;
}

// How often something came in one cell of one block.
struct count {
    uint32_t block, cell;
    enum protocol_role role;
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
    *row = (struct count){.block = trial->block, .cell = trial->cell, .role = trial->role};
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

static bool count_plan(void *user, const struct plan *plan)
{
    for (uint32_t t = 0; t < plan->trial_count; t++)
        if (!count_trial(user, plan->protocol, &plan->trials[t]))
            return false;
    return true;
}

static bool count_all(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count,
                      struct counts *counts)
{
    bool ok = plan_each(protocol, seed, first, count, count_plan, counts);
    if (ok && counts->used)
        qsort(counts->rows, counts->used, sizeof *counts->rows, by_block_and_cell);
    return ok;
}

// The scenes have a column each where those fit, else they stand with the factors.
static int scene_width(const struct protocol *protocol, uint32_t scene)
{
    int length = (int)strlen(protocol->scenes[scene]);
    return length < 7 ? 7 : length;
}

static bool scenes_fit(const struct protocol *protocol)
{
    int width = 0;
    for (uint32_t i = 0; i < protocol->scene_count; i++)
        width += 1 + scene_width(protocol, i);
    return width <= 40;
}

// A column of roles where they differ, as in a participant's trials.
static bool roles_differ(const struct counts *counts)
{
    for (uint32_t r = 1; r < counts->used; r++)
        if (counts->rows[r].role != counts->rows[0].role)
            return true;
    return false;
}

static void row_write(struct text *text, const struct protocol *protocol, const struct count *row, int width,
                      bool roles)
{
    struct text members = {0};
    size_t begin = text->size;
    bool fit = scenes_fit(protocol);
    text_add(text, "%-*s ", width, protocol->blocks[row->block].name);
    if (roles)
        text_add(text, "%-8s ", protocol_role_name(row->role));
    text_add(text, "%7u %7u %7u %7u", row->trials, row->test_a, row->test_b, row->test_first);
    for (uint32_t i = 0; i < protocol->scene_count; i++) {
        if (fit)
            text_add(text, " %*u", scene_width(protocol, i), row->scene[i]);
        else if (row->scene[i] > 0)
            text_add(&members, "\"%s\":%u,", protocol->scenes[i], row->scene[i]);
    }
    text_add(&members, "%s", row->factors);
    char *told = text_take(&members);
    text_add(text, " ");
    size_t used = text->size - begin;
    plan_members_write(text, told ? told : "", used, used);
    text->failed = text->failed || !told;
    free(told);
}

char *plan_counts_text(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count)
{
    struct counts counts = {0};
    struct text text = {0};
    int width = 5;
    for (uint32_t b = 0; b < protocol->block_count; b++)
        width = (int)strlen(protocol->blocks[b].name) > width ? (int)strlen(protocol->blocks[b].name) : width;
    text.failed = !count_all(protocol, seed, first, count, &counts);
    bool roles = roles_differ(&counts);
    text_add(&text, "%u participants from number %u, seed %llu\n\n%-*s ", count, first + 1,
             (unsigned long long)seed, width, "block");
    if (roles)
        text_add(&text, "%-8s ", "role");
    text_add(&text, "%7s %7s %7s %7s", "trials", "test=a", "test=b", "first");
    for (uint32_t i = 0; i < protocol->scene_count && scenes_fit(protocol); i++)
        text_add(&text, " %*s", scene_width(protocol, i), protocol->scenes[i]);
    text_add(&text, scenes_fit(protocol) ? "  factors\n" : "  scenes and factors\n");
    for (uint32_t r = 0; r < counts.used; r++)
        row_write(&text, protocol, &counts.rows[r], width, roles);
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
                 "%s\n{\"block\":\"%s\",\"role\":\"%s\",\"factors\":%s,\"trials\":%u,\"test_a\":%u,\"test_b\":%"
                 "u,\"test_"
                 "first\":%u,\"scenes\":{",
                 r ? "," : "", protocol->blocks[row->block].name, protocol_role_name(row->role), row->factors,
                 row->trials, row->test_a, row->test_b, row->test_first);
        for (uint32_t i = 0; i < protocol->scene_count; i++)
            text_add(&text, "%s\"%s\":%u", i ? "," : "", protocol->scenes[i], row->scene[i]);
        text_add(&text, "}}");
    }
    text_add(&text, "]\n");
    free(counts.rows);
    return text_take(&text);
}

// --- carry-over ---

struct follow {
    const struct protocol *protocol;
    uint32_t *times[PROTOCOL_BLOCKS]; // of block b: [i * cells + j]: cell j right after cell i
};

static bool follow_plan(void *user, const struct plan *plan)
{
    struct follow *follow = user;
    for (uint32_t t = 1; t < plan->trial_count; t++) {
        const struct plan_trial *before = &plan->trials[t - 1], *trial = &plan->trials[t];
        uint32_t cells = plan->protocol->blocks[trial->block].cell_count;
        if (before->block == trial->block && before->cell < cells && trial->cell < cells)
            follow->times[trial->block][before->cell * cells + trial->cell]++;
    }
    return true;
}

// Whether one participant can get both cells.
static bool meet(const struct protocol_block *block, uint32_t i, uint32_t j)
{
    for (uint32_t f = 0; f < block->factor_count; f++)
        if (block->factors[f].between && block->cells[i].level[f] != block->cells[j].level[f])
            return false;
    return true;
}

static void carry_of(const struct protocol_block *block, const uint32_t *times, struct plan_carry *out)
{
    uint64_t sum = 0;
    *out = (struct plan_carry){.least = UINT32_MAX};
    for (uint32_t i = 0; i < block->cell_count; i++)
        for (uint32_t j = 0; j < block->cell_count; j++) {
            uint32_t n = times[i * block->cell_count + j];
            if (i == j || !meet(block, i, j))
                continue;
            out->pairs++;
            out->least = n < out->least ? n : out->least;
            out->most = n > out->most ? n : out->most;
            sum += n;
        }
    out->even = out->pairs ? (double)sum / out->pairs : 0;
    out->least = out->pairs ? out->least : 0;
}

bool plan_carry_over(const struct protocol *protocol, uint64_t seed, uint32_t first, uint32_t count,
                     struct plan_carry out[PROTOCOL_BLOCKS])
{
    struct follow follow = {.protocol = protocol};
    bool ok = true;
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        size_t cells = protocol->blocks[b].cell_count;
        follow.times[b] = calloc(cells * cells, sizeof *follow.times[b]);
        ok = ok && follow.times[b];
    }
    ok = ok && plan_each(protocol, seed, first, count, follow_plan, &follow);
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        if (ok)
            carry_of(&protocol->blocks[b], follow.times[b], &out[b]);
        free(follow.times[b]);
    }
    return ok;
}
