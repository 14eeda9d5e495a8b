#include "analysis/report/jod.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// How many trials of a block had an option as their reference, whatever the rules take out.
struct vote {
    const char *block;
    size_t condition;
    int64_t trials;
};

struct filling {
    struct jod *jod;
    struct sample *sample;
    size_t file;
    struct vote *votes; // in the order of the data
    size_t vote_count;
};

static struct jod_block *find_block(struct filling *f, const char *name)
{
    struct jod *j = f->jod;
    for (size_t i = 0; i < j->block_count; i++)
        if (strcmp(j->blocks[i].block, name) == 0)
            return &j->blocks[i];
    struct jod_block block = {.block = sample_keep(f->sample, name)};
    if (!block.block || !sample_grow(&j->blocks, j->block_count, sizeof j->blocks[0]))
        return NULL;
    j->blocks[j->block_count] = block;
    return &j->blocks[j->block_count++];
}

// SAMPLE_NONE where there are more options than can be scaled.
static size_t find_option(struct jod_block *block, size_t condition)
{
    for (size_t i = 0; i < block->option_count; i++)
        if (block->options[i] == condition)
            return i;
    if (condition == SAMPLE_NONE || block->option_count == STAT_JOD_OPTIONS)
        return SAMPLE_NONE;
    block->options[block->option_count] = condition;
    return block->option_count++;
}

// The zero of the scale must not move with the rules: two scales with different zeros cannot be compared. So
// excluded answers have a say in what the reference is. False where memory ran out.
static bool vote(struct filling *f, const struct store_trial_row *row)
{
    size_t test = sample_find_condition(f->sample, f->file, row->test_id);
    size_t reference = sample_find_condition(f->sample, f->file, row->reference_id), i = 0;
    if (strcmp(row->status, "done") != 0 || row->correct >= 0 || test == reference ||
        (row->chosen != 't' && row->chosen != 'r') || test == SAMPLE_NONE || reference == SAMPLE_NONE)
        return true;
    while (i < f->vote_count &&
           (f->votes[i].condition != reference || strcmp(f->votes[i].block, row->block) != 0))
        i++;
    if (i == f->vote_count) {
        struct vote vote = {.block = sample_keep(f->sample, row->block), .condition = reference};
        if (!vote.block || !sample_grow(&f->votes, f->vote_count, sizeof f->votes[0]))
            return false;
        f->votes[f->vote_count++] = vote;
    }
    f->votes[i].trials++;
    return true;
}

// Counts what is left out; true for an answer to count.
static bool counts(struct filling *f, const struct store_trial_row *row)
{
    struct jod *j = f->jod;
    int64_t *reason = strcmp(row->status, "done") != 0                            ? &j->not_done
                      : sample_trial_excluded(f->sample, f->file, row->id)        ? &j->excluded
                      : row->correct >= 0                                         ? &j->correct
                      : row->chosen == '?' || !row->test_id || !row->reference_id ? &j->no_test_slot
                                                                                  : NULL;
    if (reason)
        ++*reason;
    return !reason;
}

static bool add_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    size_t session = sample_any_session(f->sample, f->file, row->session_id);
    bool pair = strcmp(row->kind, "toggle") == 0 || strcmp(row->kind, "sequential") == 0;
    if (row->choice_id == 0 || session == SAMPLE_NONE || !pair)
        return true;
    if (!vote(f, row))
        return false;
    if (f->sample->sessions[session].excluded || !counts(f, row))
        return true;
    struct jod_block *block = find_block(f, row->block);
    if (!block)
        return false;
    size_t test = find_option(block, sample_find_condition(f->sample, f->file, row->test_id));
    size_t reference = find_option(block, sample_find_condition(f->sample, f->file, row->reference_id));
    if (test == SAMPLE_NONE || reference == SAMPLE_NONE) {
        f->jod->too_many++;
        return true;
    }
    if (row->chosen == '=' || test == reference) {
        block->equal++;
        return true;
    }
    if (!sample_grow(&block->answers, block->answer_count, sizeof block->answers[0]))
        return false;
    block->answers[block->answer_count++] =
        (struct stat_preference){.person = f->sample->sessions[session].person,
                                 .winner = row->chosen == 't' ? test : reference,
                                 .loser = row->chosen == 't' ? reference : test};
    return true;
}

static bool set_people(struct jod_block *block)
{
    size_t last = 0;
    for (size_t i = 0; i < block->answer_count; i++)
        last = block->answers[i].person > last ? block->answers[i].person : last;
    bool *known = calloc(last + 1, sizeof *known);
    for (size_t i = 0; known && i < block->answer_count; i++) {
        block->persons += !known[block->answers[i].person];
        known[block->answers[i].person] = true;
    }
    free(known);
    return known != NULL;
}

static void set_order(struct jod_block *block, const struct sample *sample)
{
    for (size_t i = 0; i < block->option_count; i++) {
        size_t place = i;
        const char *label = sample->conditions[block->options[i]].label;
        for (; place > 0; place--) {
            size_t before = block->order[place - 1];
            if (before == block->reference ||
                (i != block->reference && strcmp(sample->conditions[block->options[before]].label, label) <= 0))
                break;
            block->order[place] = before;
        }
        block->order[place] = i;
    }
}

// Of equally many votes the first: the order of the data does not depend on the rules either. An option that no
// answer is left of is the reference nevertheless, and nothing is then estimable.
static void set_reference(struct jod_block *block, const struct filling *f)
{
    const struct vote *best = NULL;
    for (size_t i = 0; i < f->vote_count; i++) {
        const struct vote *vote = &f->votes[i];
        bool room = block->option_count < STAT_JOD_OPTIONS;
        for (size_t k = 0; k < block->option_count && !room; k++)
            room = block->options[k] == vote->condition;
        if (room && strcmp(vote->block, block->block) == 0 && (!best || vote->trials > best->trials))
            best = vote;
    }
    block->reference = best ? find_option(block, best->condition) : 0;
}

static bool scale(struct jod_block *block, const struct sample *sample, double conf, size_t replicates,
                  uint64_t seed)
{
    bool ok = set_people(block);
    set_order(block, sample);
    return ok && stat_jod_scale(block->answers, block->answer_count,
                                &(struct stat_jod_desc){.options = block->option_count,
                                                        .reference = block->reference,
                                                        .conf = conf,
                                                        .replicates = replicates,
                                                        .seed = seed},
                                block->scores);
}

bool jod_load(struct jod *out, struct sample *sample, double conf, size_t replicates, uint64_t seed,
              char *error, size_t error_size)
{
    struct filling f = {.jod = out, .sample = sample};
    *out = (struct jod){.conf = conf, .replicates = replicates};
    bool ok = true;
    snprintf(error, error_size, "not enough memory");
    for (; ok && f.file < sample->file_count; f.file++) {
        struct store_reader *reader = sample->files[f.file];
        ok = store_read_trials(reader, add_trial, &f);
        if (!ok && store_reader_error(reader)[0])
            snprintf(error, error_size, "%s", store_reader_error(reader));
    }
    size_t kept = 0; // blocks in which something was compared
    for (size_t i = 0; ok && i < out->block_count; i++)
        if (out->blocks[i].answer_count > 0)
            out->blocks[kept++] = out->blocks[i];
    out->block_count = ok ? kept : out->block_count;
    for (size_t i = 0; ok && i < out->block_count; i++) {
        set_reference(&out->blocks[i], &f);
        ok = scale(&out->blocks[i], sample, conf, replicates, seed);
    }
    free(f.votes);
    if (ok)
        error[0] = '\0';
    else
        jod_free(out);
    return ok;
}

void jod_free(struct jod *jod)
{
    for (size_t i = 0; i < jod->block_count; i++)
        free(jod->blocks[i].answers);
    free(jod->blocks);
    *jod = (struct jod){0};
}

// --- in words ---

bool jod_open(const struct stat_jod *s)
{
    return isinf(s->interval.low) || isinf(s->interval.high);
}

void jod_interval_text(const struct stat_jod *s, int digits, char out[64])
{
    double low = s->interval.low, high = s->interval.high;
    out[0] = '\0';
    if (isnan(low) || isnan(high))
        return;
    if (isinf(low) && isinf(high))
        snprintf(out, 64, "open at both ends");
    else if (isinf(low))
        snprintf(out, 64, "below %.*f", digits, high);
    else if (isinf(high))
        snprintf(out, 64, "above %.*f", digits, low);
    else
        snprintf(out, 64, "%.*f to %.*f", digits, low, digits, high);
}

const char *jod_reason(const struct stat_jod *s)
{
    static const char *const reasons[] = {
        "", "the reference, 0 by definition",
        "not estimable: not compared with the reference, nor by way of others",
        "not estimable without a prior: no chain of answers prefers the reference to it",
        "not estimable without a prior: no chain of answers prefers it to the reference"};
    if (s->status == STAT_JOD_OK && s->alike)
        return "no interval: no difference between people";
    return s->status == STAT_JOD_OK && s->unreliable ? "interval unreliable" : reasons[s->status];
}
