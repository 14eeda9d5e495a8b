// Writes what the session's state machine reports: trials, answers, exposures and events into the store, and
// the event lines that others watch. An answer is committed before its line is written.
//
// Use: fill a struct recorder -> recorder_take each machine record in order. Does not: own anything.
#ifndef APP_SESSION_RECORD_H
#define APP_SESSION_RECORD_H

#include "app/session/event_lines.h"
#include "studies/engine/machine.h"
#include "studies/store/store.h"

#include <stdbool.h>
#include <stddef.h>

struct recorder {
    struct store *store;
    const struct plan *plan;
    const struct store_session_ids *ids; // with condition_ids and trial_ids
    struct event_lines *lines;
    int64_t trial_id; // the running trial, 0: none
    uint32_t attempt; // of it
};

enum recorder_result {
    RECORDER_DONE,
    RECORDER_ANSWERED, // an answer is on disk: the machine may go on
    RECORDER_FAILED,   // one sentence in `error`
};

enum recorder_result recorder_take(struct recorder *recorder, const struct machine_record *record, char *error,
                                   size_t error_size);

// Now as ISO 8601 UTC, "2026-05-01T09:30:00Z": for the store's *_at columns.
enum { RECORD_TIME = 32 };
void record_time_utc(char out[RECORD_TIME]);

#endif
