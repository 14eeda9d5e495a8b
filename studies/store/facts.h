// What exclusion rules ask of a study file: protocols, sessions that lack their rules, what was measured of
// each answered trial, and what is out already. Reads only, in time linear in the rows (one range of gaze and
// of frames per trial). Same manners as read.h.
#ifndef STUDIES_STORE_FACTS_H
#define STUDIES_STORE_FACTS_H

#include "studies/store/read.h"

struct store_protocol_row {
    int64_t id;
    const char *name, *sha256, *text;
    const char *scenes; // names of its scenes, as sessions had them, each with a line end
};

struct store_ruled_row {                                         // one per session
    int64_t session_id, segment_id, participant_id, protocol_id; // the segment: its last
    const char *code, *status;
    bool ruled; // the rules were applied to all of it
};

// Of the attempt that was answered. Its stimulus is where any of an option was visible, and the gray between
// two such stretches of at most a second: not a pause.
struct store_fact_row {
    int64_t trial_id, session_id, ordinal;
    const char *block, *kind;
    bool rated;
    double seen_s[2]; // of slots a and b, without fade; NaN: no such option, or nothing was recorded
    int64_t gaze_samples, gaze_lost;
    double gaze_gap_ms;                   // longest time without a direction; NaN: the session had no tracker
    int64_t stimulus_frames, late_frames; // of those whose lateness is known
    // Frames that were drawn, and of these those whose option was not what its condition says: `effective`
    // differs, or the fovea of a foveated option was fixed or lost though the trial foveates by gaze.
    int64_t rendered_frames, fallback_frames;
    double reaction_s;
    bool caught, missed; // a catch trial with an answer of which it is known whether it was wrong; a wrong one
};

struct store_excluded_row {
    int64_t trial_id, session_id, participant_id; // two of them are 0
    int64_t ordinal;                              // of the trial; 0: none
    const char *code, *rule, *rule_set, *reason, *by, *applied_at;
};

typedef bool (*store_protocol_fn)(void *user, const struct store_protocol_row *row);
typedef bool (*store_ruled_fn)(void *user, const struct store_ruled_row *row);
typedef bool (*store_fact_fn)(void *user, const struct store_fact_row *row);
typedef bool (*store_excluded_fn)(void *user, const struct store_excluded_row *row);

bool store_read_protocols(struct store_reader *reader, store_protocol_fn each, void *user);
// `ruled` by the rules of the protocol with this hash; NULL: by those of its own.
bool store_read_ruled(struct store_reader *reader, const char *sha256, store_ruled_fn each, void *user);
// Answered trials without practice, by session and ordinal.
bool store_read_facts(struct store_reader *reader, int64_t participant_id, int64_t protocol_id,
                      store_fact_fn each, void *user);
bool store_read_excluded(struct store_reader *reader, store_excluded_fn each, void *user);
// 0 where the file has no such participant or trial.
int64_t store_find_participant(struct store_reader *reader, const char *code);
int64_t store_find_trial(struct store_reader *reader, int64_t trial_id);

#endif
