// Which trials, ratings and people the protocol's rules take out of the analysis, and why.
//
// Use: one struct exclude_facts per answered trial of one person, practice left out, in the order they were
// answered -> exclude_apply calls back once per verdict. A rule whose fact is not known (NaN, or a count of 0
// it would be a share of) does not hold. Does not: measure (the store does, store/facts.h), write, know other
// people.
//
// What a rule looks at, of the attempt that was answered:
//   unseen_option  seconds each option of the trial was on screen without fade; the least of them
//   gaze_loss      share of the gaze samples of its stimulus that have no direction
//   gaze_gap_ms    longest time without a direction during its stimulus
//   late_frames    share of its stimulus frames that came late
//   reaction       seconds from when an answer was allowed
//   failed_catch   of a trial: a catch trial was missed; of a person: the share of catch trials missed
//   fallback       share of its rendered frames that were not what was asked
#ifndef STUDIES_ENGINE_EXCLUDE_H
#define STUDIES_ENGINE_EXCLUDE_H

#include "studies/protocol/protocol.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { EXCLUDE_REASON = 256 };

struct exclude_facts {
    int64_t trial, session;   // the caller's ids; the trial's is named in sentences
    const char *block, *kind; // as the store has them
    bool rated;               // something was rated in it
    double seen_s[2];         // of slots a and b; NaN: not shown in this trial, or not known
    int64_t gaze_samples, gaze_lost;
    double gaze_gap_ms;                       // NaN: no tracker
    int64_t stimulus_frames, late_frames;     // those of which it is known whether they were late
    int64_t rendered_frames, fallback_frames; // fallback: `effective` differs, or the fovea was fixed or lost
    double reaction_s;                        // NaN: not known
    bool caught, missed;                      // a catch trial that has an answer; a wrong one
};

struct exclude_verdict {
    const struct protocol_exclusion *rule;
    int64_t trial; // 0: the person goes
    char reason[EXCLUDE_REASON];
};

// False stops.
typedef bool (*exclude_fn)(void *user, const struct exclude_verdict *verdict);

// By rule, as the protocol lists them, then by trial. False where `each` stopped it.
bool exclude_apply(const struct protocol *protocol, const struct exclude_facts *facts, size_t count,
                   exclude_fn each, void *user);

// The store's `rule`: the protocol's word; of rating pairs "gaze_loss:rating_pair", since such a row takes the
// ratings out and leaves a choice in the same trial alone.
void exclude_rule_name(const struct protocol_exclusion *rule, char out[PROTOCOL_NAME]);

#endif
