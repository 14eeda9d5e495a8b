// The posterior of QUEST+ and the choice of the next level; sources, equations and units in quest_plus.h.
//
// Watson chooses the level x with the smallest expected entropy of the posterior, E[H(x)] = sum over outcomes k
// of P(k | x) H(posterior after k). With the posterior w over parameter sets so far this equals
//     H(w) - ( H(outcome | x) - sum over sets w H(outcome | x, set) )
// (the chain rule: Cover and Thomas 2006, "Elements of Information Theory", equation 2.38 ff.), and what is in
// brackets, the information the answer gives, is computed instead: the entropies given a set do not change, so
// a choice takes sums of products and no logarithm per set.
#include "studies/engine/quest_plus_state.h"

#include <math.h>
#include <stdlib.h>

struct quest_plus {
    struct quest_plus_desc desc;
    uint32_t sets, width;              // width: values of a set
    double *memory;                    // owned; the tables below lie in it
    double *values;                    // [set][width]
    double *probability;               // [level][outcome][set]
    double *doubt;                     // [level][set], entropy of the outcome
    double *log_posterior, *posterior; // [set]
    double *gain;                      // [level], information the answer would give
    double entropy;                    // of the posterior
    uint32_t next;                     // index of the level
};

enum { LANES = 8 };

// In lanes, because a single running sum cannot be vectorised without changing its order and rounds worse.
static double dot(const double *a, const double *b, uint32_t count)
{
    double lane[LANES] = {0}, rest = 0;
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES)
        for (uint32_t j = 0; j < LANES; j++)
            lane[j] += a[i + j] * b[i + j];
    for (; i < count; i++)
        rest += a[i] * b[i];
    return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7])) + rest;
}

// Below this a weight is taken as 0: exp would give denormal numbers, which are slow and count for nothing.
#define LOG_NOTHING (-700.0)

static void normalise(struct quest_plus *quest)
{
    double most = -INFINITY, sum = 0, entropy = 0;
    for (uint32_t i = 0; i < quest->sets; i++)
        most = fmax(most, quest->log_posterior[i]);
    for (uint32_t i = 0; i < quest->sets; i++)
        sum += exp(quest->log_posterior[i] - most);
    double all = most + log(sum); // log-sum-exp
    for (uint32_t i = 0; i < quest->sets; i++) {
        double value = quest->log_posterior[i] - all;
        quest->log_posterior[i] = value;
        quest->posterior[i] = value < LOG_NOTHING ? 0 : exp(value);
        entropy -= quest->posterior[i] * value;
    }
    quest->entropy = entropy;
}

static double information(const struct quest_plus *quest, uint32_t level)
{
    uint32_t outcomes = quest->desc.model.outcomes;
    const double *p = quest->probability + (size_t)level * outcomes * quest->sets;
    double answer = 0;
    for (uint32_t k = 0; k < outcomes; k++) {
        double share = dot(quest->posterior, p + (size_t)k * quest->sets, quest->sets);
        answer -= share > 0 ? share * log(share) : 0;
    }
    return answer - dot(quest->posterior, quest->doubt + (size_t)level * quest->sets, quest->sets);
}

static void choose(struct quest_plus *quest)
{
    double best = -INFINITY;
    for (uint32_t i = 0; i < quest->desc.level.count; i++) {
        quest->gain[i] = information(quest, i);
        best = fmax(best, quest->gain[i]);
    }
    quest->next = 0;
    while (quest->gain[quest->next] < best - QUEST_PLUS_TIE)
        quest->next++;
}

static void fill_tables(struct quest_plus *quest, double *answer)
{
    uint32_t outcomes = quest->desc.model.outcomes;
    for (uint32_t i = 0; i < quest->desc.level.count; i++) {
        double *p = quest->probability + (size_t)i * outcomes * quest->sets;
        double *doubt = quest->doubt + (size_t)i * quest->sets;
        for (uint32_t j = 0; j < quest->sets; j++) {
            quest_plus_probabilities(&quest->desc, quest_plus_grid_value(&quest->desc.level, i),
                                     quest->values + (size_t)j * quest->width, answer);
            doubt[j] = 0;
            for (uint32_t k = 0; k < outcomes; k++) {
                p[(size_t)k * quest->sets + j] = answer[k];
                doubt[j] -= answer[k] * log(answer[k]);
            }
        }
    }
}

struct quest_plus *quest_plus_create(const struct quest_plus_desc *desc)
{
    char sentence[1];
    if (!quest_plus_check(desc, sentence, sizeof sentence))
        return NULL;
    struct quest_plus *quest = calloc(1, sizeof *quest);
    uint32_t outcomes = desc->model.outcomes, *order = calloc(outcomes - 1, sizeof *order);
    double *answer = calloc(outcomes, sizeof *answer);
    double *next = calloc((size_t)quest_plus_doubles(desc), sizeof *next);
    if (!quest || !order || !answer || !next) {
        free(next);
        free(quest);
        quest = NULL;
    } else {
        size_t sets = (size_t)quest_plus_sets(&desc->model), levels = desc->level.count;
        *quest = (struct quest_plus){
            .desc = *desc, .sets = (uint32_t)sets, .width = outcomes + 2, .memory = next, .values = next};
        quest->probability = next += sets * quest->width;
        quest->doubt = next += levels * outcomes * sets;
        quest->log_posterior = next += levels * sets;
        quest->posterior = next += sets;
        quest->gain = next + sets;
        quest_plus_fill_sets(&desc->model, desc->falling, order, quest->values);
        fill_tables(quest, answer);
        normalise(quest); // all log-posteriors are 0: flat
        choose(quest);
    }
    free(order);
    free(answer);
    return quest;
}

void quest_plus_destroy(struct quest_plus *quest)
{
    if (!quest)
        return;
    free(quest->memory);
    free(quest);
}

double quest_plus_level(const struct quest_plus *quest)
{
    return quest_plus_grid_value(&quest->desc.level, quest->next);
}

void quest_plus_outcome(struct quest_plus *quest, uint32_t outcome)
{
    const double *p =
        quest->probability + ((size_t)quest->next * quest->desc.model.outcomes + outcome) * quest->sets;
    for (uint32_t i = 0; i < quest->sets; i++)
        quest->log_posterior[i] += log(p[i]);
    normalise(quest);
    choose(quest);
}

double quest_plus_mean(const struct quest_plus *quest, uint32_t parameter, double *out_sd)
{
    const double *value = quest->values + parameter;
    double mean = 0, square = 0;
    for (uint32_t i = 0; i < quest->sets; i++)
        mean += quest->posterior[i] * value[(size_t)i * quest->width];
    for (uint32_t i = 0; i < quest->sets; i++) {
        double off = value[(size_t)i * quest->width] - mean;
        square += quest->posterior[i] * off * off;
    }
    *out_sd = sqrt(square);
    return mean;
}

double quest_plus_entropy(const struct quest_plus *quest)
{
    return quest->entropy;
}

double quest_plus_expected_entropy(const struct quest_plus *quest)
{
    return quest->entropy - quest->gain[quest->next];
}
