// Writes what the session's state machine reports: trials, answers, exposures and events into the store, and
// the event lines that others watch. An answer is committed before its line is written.
//
// Use: fill a struct recorder -> recorder_init -> recorder_take each machine record in order; after
// RECORDER_WAIT the same record again, until it is taken. -> recorder_finish. Does not: wait.
#ifndef APP_SESSION_RECORD_H
#define APP_SESSION_RECORD_H

#include "app/session/event_lines.h"
#include "studies/engine/machine.h"
#include "studies/store/store.h"

#include <stdbool.h>
#include <stddef.h>

enum { RECORDER_DETAILS = 256 };

struct recorder {
    struct store *store;
    const struct plan *plan;
    const struct machine *machine;
    const struct store_session_ids *ids; // with condition_ids and trial_ids
    struct event_lines *lines;
    const char *device; // what answers are entered with
    int64_t trial_id;   // the running trial, 0: none
    uint32_t attempt;   // of it
    // The recorder's own: a record whose rows are written and whose line is not.
    int64_t *trial_ids; // by place, repetitions too; owned
    uint32_t capacity;
    int64_t level_condition; // of the running staircase trial's tested option, 0: none
    bool line_waits;
    const char *event;
    char details[RECORDER_DETAILS];
};

enum recorder_result {
    RECORDER_DONE,
    RECORDER_ANSWERED, // an answer is on disk: the machine may go on
    RECORDER_WAIT,     // the disk is in the way, nothing is lost: one sentence in `error`
    RECORDER_FAILED,   // it can never be taken: one sentence in `error`
};

// places: trials that ids->trial_ids has. False: out of memory.
bool recorder_init(struct recorder *recorder, uint32_t places);
void recorder_finish(struct recorder *recorder);
// The condition that a slot of the running trial shows; 0: none.
int64_t recorder_condition(const struct recorder *recorder, const struct plan_trial *trial,
                           enum plan_slot slot);

enum recorder_result recorder_take(struct recorder *recorder, const struct machine_record *record, char *error,
                                   size_t error_size);

// Now as ISO 8601 UTC, "2026-05-01T09:30:00Z": for the store's *_at columns.
enum { RECORD_TIME = 32 };
void record_time_utc(char out[RECORD_TIME]);

#endif
