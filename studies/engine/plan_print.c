// One participant's plan as text and JSON for `fovstudy check`, and as a hash.
#include "studies/engine/plan.h"

#include "studies/engine/plan_text.h"

#include <stdint.h>
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

// Which columns tell something: those that vary, and names as wide as they are.
struct columns {
    bool role, question, view, fixation;
    int block, scene, asked;
};

static int wider(int width, const char *text)
{
    int length = (int)strlen(text);
    return length > width ? length : width;
}

static const char *question_name(const struct plan_trial *trial)
{
    return trial->question ? trial->question->name : "-";
}

static struct columns columns_of(const struct plan *plan)
{
    struct columns columns = {.block = 5, .scene = 5, .asked = 8};
    const struct plan_trial *first = plan->trials;
    for (uint32_t i = 0; i < plan->trial_count; i++) {
        const struct plan_trial *trial = &plan->trials[i];
        columns.role = columns.role || trial->role != first->role;
        columns.question = columns.question || trial->question != first->question;
        columns.view = columns.view || trial->resolved->view_ns != first->resolved->view_ns;
        columns.fixation = columns.fixation || trial->fixation != first->fixation;
        columns.block = wider(columns.block, block_name(plan, trial));
        columns.scene = wider(columns.scene, trial->scene);
        columns.asked = wider(columns.asked, question_name(trial));
    }
    return columns;
}

void plan_members_write(struct text *text, const char *json, size_t used, size_t indent)
{
    enum { WIDTH = 120 };
    while (*json) {
        char member[PROTOCOL_LABELS] = "";
        size_t length = strcspn(json, ",}"), kept = 0;
        for (size_t i = 0; i < length && kept < sizeof member - 1; i++)
            if (json[i] != '"' && json[i] != '{')
                member[kept++] = json[i] == ':' ? '=' : json[i];
        json += length + (json[length] != '\0');
        if (kept == 0)
            continue;
        if (used + kept + 1 > WIDTH && used > indent) {
            text_add(text, "\n%*s", (int)indent, "");
            used = indent;
        }
        text_add(text, " %s", member);
        used += kept + 1;
    }
    while (text->size > 0 && text->data[text->size - 1] == ' ') // of a line without members
        text->size--;
    text_add(text, "\n");
}

static void header_write(struct text *text, const struct columns *c)
{
    text_add(text, "\n%5s  %-*s ", "trial", c->block, "block");
    if (c->role)
        text_add(text, "%-8s ", "role");
    text_add(text, "%-10s %-*s ", "kind", c->scene, "scene");
    if (c->question)
        text_add(text, "%-*s ", c->asked, "question");
    if (c->view)
        text_add(text, "%6s ", "view_s");
    if (c->fixation)
        text_add(text, "%-8s ", "fixation");
    text_add(text, "%3s %3s %4s %5s  %s\n", "a", "b", "test", "first", "factors");
}

static void trial_write(struct text *text, const struct plan *plan, const struct columns *c,
                        const struct plan_trial *trial)
{
    const char *test = plan_slot_name(trial->test_slot);
    size_t begin = text->size;
    text_add(text, "%5u  %-*s ", trial->ordinal, c->block, block_name(plan, trial));
    if (c->role)
        text_add(text, "%-8s ", protocol_role_name(trial->role));
    text_add(text, "%-10s %-*s ", protocol_kind_name(trial->kind), c->scene, trial->scene);
    if (c->question)
        text_add(text, "%-*s ", c->asked, question_name(trial));
    if (c->view)
        text_add(text, "%6g ", (double)trial->resolved->view_ns / 1e9);
    if (c->fixation)
        text_add(text, "%-8s ", trial->fixation);
    text_add(text, "%3d ", trial->option[0] + 1);
    if (trial->option[1] >= 0)
        text_add(text, "%3d ", trial->option[1] + 1);
    else
        text_add(text, "  - ");
    text_add(text, "%4s %5s ", test ? test : "-", plan_slot_name(trial->first_shown));
    size_t used = text->size - begin;
    plan_members_write(text, trial->factors, used, used);
}

// The levels between participants that this one's group has.
static void group_write(struct text *text, const struct plan *plan)
{
    const struct protocol *protocol = plan->protocol;
    uint32_t groups = protocol_groups(protocol), at = 0;
    const struct protocol_factor *seen[PROTOCOL_BLOCKS * PROTOCOL_FACTORS];
    if (groups == 1)
        return;
    text_add(text, "group %u of %u:", plan->group + 1, groups);
    for (uint32_t b = 0; b < protocol->block_count; b++)
        for (uint32_t f = 0; f < protocol->blocks[b].factor_count; f++) {
            const struct protocol_factor *factor = &protocol->blocks[b].factors[f];
            bool known = !factor->between;
            for (uint32_t i = 0; i < at; i++)
                known = known || strcmp(seen[i]->name, factor->name) == 0;
            if (known)
                continue;
            seen[at++] = factor;
            text_add(text, " %s=%s", factor->name,
                     factor->level[protocol_group_level(protocol, plan->group, factor->name)]);
        }
    text_add(text, "\n");
}

// "time_warped {...}" with only those parameters that differ from the mode's defaults would hide what is shown,
// so all of them stand in a list of conditions and the table names them by number.
char *plan_table_text(const struct plan *plan)
{
    struct text text = {0};
    struct columns columns = columns_of(plan);
    text_add(&text, "%s, participant number %u, seed %llu, protocol %.12s\n", plan->protocol->name,
             plan->number + 1, (unsigned long long)plan->seed, plan->protocol->sha256_hex);
    group_write(&text, plan);
    header_write(&text, &columns);
    for (uint32_t i = 0; i < plan->trial_count; i++)
        trial_write(&text, plan, &columns, &plan->trials[i]);
    text_add(&text, "\ncondition\n");
    for (uint32_t i = 0; i < plan->condition_count; i++) {
        size_t begin = text.size;
        text_add(&text, "%9u  %s", i + 1, plan->conditions[i].mode);
        plan_members_write(&text, plan->conditions[i].parameters, text.size - begin, 11);
    }
    if (plan->imbalance)
        text_add(&text, "\nbalance: %u trials off what would be even; no better assignment was found\n",
                 plan->imbalance);
    else
        text_add(&text, "\nbalance: scenes, sides and first-shown options within one\n");
    return text_take(&text);
}
