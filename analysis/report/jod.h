// Preferences on one scale: just-objectionable differences from the reference (analysis/stats/thurstone.h).
//
// One scale per block. Counted are answers of toggle and sequential trials that are done and not excluded,
// whose question has no right answer. "Equal" is counted apart and is no comparison; so is a choice between an
// option and itself. The reference is the option that most such trials of the block had as theirs, those that
// rules take out among them, so that scales under different rules have one zero; of equally many that of the
// trial read first. Scenes and levels that do not change an option are put together.
#ifndef ANALYSIS_REPORT_JOD_H
#define ANALYSIS_REPORT_JOD_H

#include "analysis/report/sample.h"
#include "analysis/stats/thurstone.h"

enum { JOD_REPLICATES = 1000, JOD_SEED = 5 }; // of the bootstrap; the seed is one for all studies

struct jod_block {
    const char *block;
    size_t option_count;
    size_t options[STAT_JOD_OPTIONS]; // conditions of the sample
    size_t reference;                 // index into options
    size_t order[STAT_JOD_OPTIONS];   // to print them in: the reference, then by label
    size_t answer_count;
    struct stat_preference *answers;
    int64_t persons, equal;
    struct stat_jod scores[STAT_JOD_OPTIONS];
};

struct jod {
    double conf;
    size_t replicates;
    size_t block_count;
    struct jod_block *blocks;
    // Left out, by the first reason that holds:
    int64_t not_done, excluded, no_test_slot, correct, too_many;
};

// False with a sentence. No answer at all is not an error: block_count is 0.
bool jod_load(struct jod *out, struct sample *sample, double conf, size_t replicates, uint64_t seed,
              char *error, size_t error_size);
void jod_free(struct jod *jod);

// "-1.05 to 0.20", "below 0.20", "above 0.20", "open at both ends"; "" where there is no interval.
void jod_interval_text(const struct stat_jod *score, int digits, char out[64]);
bool jod_open(const struct stat_jod *score); // an end of its interval is infinite
// Why an option has no score or no interval, in words; "" for neither.
const char *jod_reason(const struct stat_jod *score);

#endif
