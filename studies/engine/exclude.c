#include "studies/engine/exclude.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void exclude_rule_name(const struct protocol_exclusion *rule, char out[PROTOCOL_NAME])
{
    snprintf(out, PROTOCOL_NAME, "%s%s", protocol_rule_name(rule->rule),
             rule->of == PROTOCOL_OF_RATING_PAIR ? ":rating_pair" : "");
}

static bool beyond(const struct protocol_exclusion *rule, double value)
{
    return value > rule->above || value < rule->below; // both false for NaN, of the limit or the value
}

// "less than 1 s": which side of the rule's limits a value is on.
static const char *side(const struct protocol_exclusion *rule, double value, double *out_limit)
{
    bool over = value > rule->above;
    *out_limit = over ? rule->above : rule->below;
    return over ? "more" : "less";
}

static double share(int64_t part, int64_t whole)
{
    return whole > 0 ? (double)part / (double)whole : (double)NAN;
}

// The three rules on a share of something counted, in one sentence.
static bool share_holds(const struct protocol_exclusion *rule, int64_t part, int64_t whole, const char *what,
                        char reason[EXCLUDE_REASON])
{
    double value = share(part, whole);
    if (!(value > rule->above))
        return false;
    snprintf(reason, EXCLUDE_REASON, "%" PRId64 " of %" PRId64 " %s (%.3g %%), more than %g %%", part, whole,
             what, 100 * value, 100 * rule->above);
    return true;
}

static bool unseen(const struct protocol_exclusion *rule, const struct exclude_facts *facts,
                   char reason[EXCLUDE_REASON])
{
    for (int slot = 0; slot < 2; slot++)
        if (facts->seen_s[slot] < rule->below) {
            snprintf(reason, EXCLUDE_REASON, "option %s was seen for %.3g s, less than %g s", slot ? "b" : "a",
                     facts->seen_s[slot], rule->below);
            return true;
        }
    return false;
}

static bool reaction(const struct protocol_exclusion *rule, const struct exclude_facts *facts,
                     char reason[EXCLUDE_REASON])
{
    double limit = 0;
    if (!beyond(rule, facts->reaction_s))
        return false;
    const char *word = side(rule, facts->reaction_s, &limit);
    snprintf(reason, EXCLUDE_REASON, "answered after %.3g s, %s than %g s", facts->reaction_s, word, limit);
    return true;
}

static bool gap(const struct protocol_exclusion *rule, const struct exclude_facts *facts,
                char reason[EXCLUDE_REASON])
{
    if (!(facts->gaze_gap_ms > rule->above))
        return false;
    snprintf(reason, EXCLUDE_REASON, "no gaze direction for %.4g ms, more than %g ms", facts->gaze_gap_ms,
             rule->above);
    return true;
}

// Whether the rule holds for one trial by itself, with the sentence that says so.
static bool holds(const struct protocol_exclusion *rule, const struct exclude_facts *facts,
                  char reason[EXCLUDE_REASON])
{
    switch (rule->rule) {
    case PROTOCOL_UNSEEN_OPTION:
        return unseen(rule, facts, reason);
    case PROTOCOL_GAZE_LOSS:
        return share_holds(rule, facts->gaze_lost, facts->gaze_samples, "gaze samples have no direction",
                           reason);
    case PROTOCOL_GAZE_GAP:
        return gap(rule, facts, reason);
    case PROTOCOL_LATE_FRAMES:
        return share_holds(rule, facts->late_frames, facts->stimulus_frames, "stimulus frames came late",
                           reason);
    case PROTOCOL_REACTION:
        return reaction(rule, facts, reason);
    case PROTOCOL_FAILED_CATCH:
        snprintf(reason, EXCLUDE_REASON, "a catch trial that was missed");
        return facts->missed;
    case PROTOCOL_FALLBACK:
        return share_holds(rule, facts->fallback_frames, facts->rendered_frames,
                           "frames were not what was asked", reason);
    case PROTOCOL_RULE_KINDS:
        break;
    }
    return false;
}

static int32_t block_index(const struct protocol *protocol, const char *name)
{
    for (uint32_t i = 0; i < protocol->block_count; i++)
        if (strcmp(protocol->blocks[i].name, name) == 0)
            return (int32_t)i;
    return -1; // a later file's rules may not know it
}

// The rate block whose ratings belong with this one's; -1: none.
static int32_t partner_block(const struct protocol *protocol, int32_t block)
{
    if (block < 0 || protocol->blocks[block].kind != PROTOCOL_RATE)
        return -1;
    if (protocol->blocks[block].complement_of >= 0)
        return protocol->blocks[block].complement_of;
    for (uint32_t i = 0; i < protocol->block_count; i++)
        if (protocol->blocks[i].complement_of == block)
            return (int32_t)i;
    return -1;
}

// The other half of a rating pair: the n-th trial of a rate block goes with the n-th of its complement in the
// same session (the plan gives both the same scene). NULL: its pair is in the trial itself, or there is none.
static const struct exclude_facts *pair_of(const struct protocol *protocol, const struct exclude_facts *facts,
                                           size_t count, size_t index)
{
    const struct exclude_facts *mine = &facts[index];
    int32_t partner = partner_block(protocol, block_index(protocol, mine->block));
    size_t place = 0;
    if (partner < 0)
        return NULL;
    for (size_t i = 0; i < index; i++)
        place += facts[i].session == mine->session && strcmp(facts[i].block, mine->block) == 0;
    for (size_t i = 0; i < count; i++) {
        if (facts[i].session != mine->session || strcmp(facts[i].block, protocol->blocks[partner].name) != 0)
            continue;
        if (place-- == 0)
            return &facts[i];
    }
    return NULL;
}

static bool judge_trials(const struct protocol *protocol, const struct protocol_exclusion *rule,
                         const struct exclude_facts *facts, size_t count, exclude_fn each, void *user)
{
    bool pairs = rule->of == PROTOCOL_OF_RATING_PAIR;
    for (size_t i = 0; i < count; i++) {
        struct exclude_verdict verdict = {.rule = rule, .trial = facts[i].trial};
        char why[EXCLUDE_REASON];
        if (pairs && !facts[i].rated)
            continue;
        const struct exclude_facts *pair = pairs ? pair_of(protocol, facts, count, i) : NULL;
        if (!holds(rule, &facts[i], verdict.reason)) {
            if (!pair || !holds(rule, pair, why))
                continue;
            snprintf(verdict.reason, sizeof verdict.reason, "its pair, trial %" PRId64 ", is out: %.180s",
                     pair->trial, why);
        }
        if (!each(user, &verdict))
            return false;
    }
    return true;
}

// A person's share of trials for which the rule holds; of failed_catch: of the catch trials.
static bool judge_person(const struct protocol_exclusion *rule, const struct exclude_facts *facts, size_t count,
                         exclude_fn each, void *user)
{
    bool catches = rule->rule == PROTOCOL_FAILED_CATCH;
    struct exclude_verdict verdict = {.rule = rule};
    char why[EXCLUDE_REASON];
    int64_t out = 0, of = 0;
    for (size_t i = 0; i < count; i++) {
        of += !catches || facts[i].caught;
        out += holds(rule, &facts[i], why);
    }
    double limit = catches && !isnan(rule->above) ? rule->above : rule->share;
    if (!(share(out, of) > limit))
        return true;
    if (catches)
        snprintf(verdict.reason, sizeof verdict.reason,
                 "missed %" PRId64 " of %" PRId64 " catch trials (%.3g %%), more than %g %%", out, of,
                 100 * share(out, of), 100 * limit);
    else
        snprintf(verdict.reason, sizeof verdict.reason,
                 "%s holds in %" PRId64 " of %" PRId64 " trials (%.3g %%), more than %g %%",
                 protocol_rule_name(rule->rule), out, of, 100 * share(out, of), 100 * limit);
    return each(user, &verdict);
}

bool exclude_apply(const struct protocol *protocol, const struct exclude_facts *facts, size_t count,
                   exclude_fn each, void *user)
{
    for (uint32_t i = 0; i < protocol->exclusion_count; i++) {
        const struct protocol_exclusion *rule = &protocol->exclusions[i];
        bool going = rule->of == PROTOCOL_OF_PERSON ? judge_person(rule, facts, count, each, user)
                                                    : judge_trials(protocol, rule, facts, count, each, user);
        if (!going)
            return false;
    }
    return true;
}
