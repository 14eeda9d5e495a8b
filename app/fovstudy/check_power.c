#include "app/fovstudy/check_power.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct tally {
    struct check_analyses *out;
    uint32_t person; // from 1
};

static bool is_pair_rating(const struct protocol *protocol, uint32_t block)
{
    if (protocol->blocks[block].complement_of >= 0)
        return true;
    for (uint32_t b = 0; b < protocol->block_count; b++)
        if (protocol->blocks[b].complement_of == (int32_t)block)
            return true;
    return false;
}

// Whether a trial gives what the analysis is of.
static bool gives(const struct plan_trial *trial, const char *of)
{
    bool choice = trial->kind == PROTOCOL_TOGGLE || trial->kind == PROTOCOL_SEQUENTIAL;
    if (trial->role != PROTOCOL_MAIN)
        return false;
    if (strcmp(of, "choice") == 0 || strcmp(of, "reaction") == 0)
        return choice;
    if (strcmp(of, "rating") == 0)
        return trial->kind == PROTOCOL_RATE || trial->resolved->rating_count > 0 ||
               (trial->kind == PROTOCOL_TASK && trial->resolved->asked_count > 0);
    if (strcmp(of, "toggles") == 0)
        return trial->kind == PROTOCOL_TOGGLE || trial->kind == PROTOCOL_STAIRCASE;
    if (strcmp(of, "adjusted") == 0)
        return trial->kind == PROTOCOL_ADJUST;
    return trial->kind == PROTOCOL_STAIRCASE;
}

static bool count(struct check_analysis *analysis, const char *label, uint32_t person)
{
    uint32_t i = 0;
    while (i < analysis->part_count && strcmp(analysis->parts[i].label, label) != 0)
        i++;
    if (i == analysis->part_count) {
        struct check_part *parts = realloc(analysis->parts, (i + 1) * sizeof *parts);
        if (!parts)
            return false;
        analysis->parts = parts;
        parts[i] = (struct check_part){0};
        snprintf(parts[i].label, sizeof parts[i].label, "%s", label);
        analysis->part_count++;
    }
    struct check_part *part = &analysis->parts[i];
    part->answers++;
    part->people += part->last != person;
    part->last = person;
    return true;
}

// The next member of {"a":1,"b":"x"} as a=1 or b=x; false: none is left.
static bool next_member(const char **json, char *out, size_t out_size)
{
    size_t length = strcspn(*json, ",}"), kept = 0;
    for (size_t i = 0; i < length && kept + 1 < out_size; i++)
        if (!strchr("{\"", (*json)[i]))
            out[kept++] = (*json)[i] == ':' ? '=' : (*json)[i];
    out[kept] = '\0';
    *json += length + ((*json)[length] != '\0');
    return kept > 0;
}

// Each combination of a block's factors and labels by itself; scenes' labels are not the cell's.
static void cell_label(const struct plan *plan, const struct plan_trial *trial, char *out, size_t size)
{
    const struct protocol_block *block = &plan->protocol->blocks[trial->block];
    const struct protocol_cell *cell = &block->cells[trial->cell];
    const char *labels = cell->labels;
    char member[PROTOCOL_LABELS];
    size_t used = (size_t)snprintf(out, size, "%s", block->name);
    for (labels += *labels == ','; next_member(&labels, member, sizeof member) && used < size;)
        used += (size_t)snprintf(out + used, size - used, " %s", member);
    for (uint32_t f = 0; f < block->factor_count && used < size; f++)
        used += (size_t)snprintf(out + used, size - used, " %s=%s", block->factors[f].name,
                                 block->factors[f].level[cell->level[f]]);
}

// Of the two orders of a rating pair: which option came first.
static const char *first_option(const struct plan *plan, uint32_t block)
{
    const struct protocol *protocol = plan->protocol;
    int32_t first = protocol->blocks[block].complement_of;
    uint32_t wanted = first >= 0 ? (uint32_t)first : block;
    for (uint32_t t = 0; t < plan->trial_count; t++)
        if (plan->trials[t].block == wanted)
            return protocol
                ->options[protocol->blocks[wanted].options[plan->trials[t].test_slot == PLAN_SLOT_A ? 0 : 1]]
                .name;
    return "";
}

static bool count_trial(struct check_analysis *analysis, const struct plan *plan,
                        const struct plan_trial *trial, uint32_t person)
{
    const char *per = analysis->planned->per, *factors = trial->factors;
    char label[PROTOCOL_LABELS] = "";
    if (!gives(trial, analysis->planned->of))
        return true;
    if (strcmp(per, "factor") == 0) {
        while (next_member(&factors, label, sizeof label)) // a listed trial's name is no factor
            if (strncmp(label, "trial=", 6) != 0 && !count(analysis, label, person))
                return false;
        return true;
    }
    if (strcmp(per, "cell") == 0)
        cell_label(plan, trial, label, sizeof label);
    else if (strcmp(per, "scene") == 0)
        snprintf(label, sizeof label, "scene=%s", trial->scene);
    else if (strcmp(per, "order") == 0) {
        if (!is_pair_rating(plan->protocol, trial->block))
            return true;
        snprintf(label, sizeof label, "%s first", first_option(plan, trial->block));
    }
    return count(analysis, label, person);
}

static bool count_plan(void *user, const struct plan *plan)
{
    struct tally *tally = user;
    tally->person++;
    for (uint32_t a = 0; a < tally->out->count; a++)
        for (uint32_t t = 0; t < plan->trial_count; t++)
            if (!count_trial(&tally->out->each[a], plan, &plan->trials[t], tally->person))
                return false;
    return true;
}

bool check_analyses_init(struct check_analyses *out, const struct protocol *protocol, uint64_t seed,
                         uint32_t people)
{
    struct tally tally = {.out = out};
    *out = (struct check_analyses){.count = protocol->analysis_count};
    for (uint32_t i = 0; i < out->count; i++) {
        const char *method = protocol->analyses[i].method;
        // Only choices are counts of two answers; of anything else a binomial test says nothing.
        bool counts = strcmp(protocol->analyses[i].of, "choice") == 0;
        out->each[i].planned = &protocol->analyses[i];
        out->each[i].test = strcmp(method, "binomial") == 0 && counts ? CHECK_BINOMIAL
                            : strcmp(method, "paired_t") == 0         ? CHECK_PAIRED_T
                            : strcmp(method, "unpaired_t") == 0       ? CHECK_TWO_SAMPLE_T
                                                                      : CHECK_ESTIMATE;
    }
    return plan_each(protocol, seed, 0, people, count_plan, &tally);
}

void check_analyses_finish(struct check_analyses *analyses)
{
    for (uint32_t i = 0; i < analyses->count; i++)
        free(analyses->each[i].parts);
    *analyses = (struct check_analyses){0};
}
