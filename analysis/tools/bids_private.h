// What the files of the BIDS export share.
#ifndef ANALYSIS_TOOLS_BIDS_PRIVATE_H
#define ANALYSIS_TOOLS_BIDS_PRIVATE_H

#include "analysis/tools/bids.h"
#include "analysis/tools/cell.h"
#include "analysis/tools/json.h"

#include <stdio.h>

enum { BIDS_LABEL_SIZE = 96, BIDS_PATH_SIZE = 4096 };

// A text of the study and the label that stands for it in file names: letters and digits, unique also where
// a file system does not tell capitals.
struct bids_name {
    char *text;
    char label[BIDS_LABEL_SIZE];
};

struct bids_names {
    struct bids_name *items;
    size_t count;
};

struct bids_session {
    int64_t id;
    size_t person, task; // indices of names
    int64_t number;      // among the person's, from 1
    int64_t runs;
};

struct bids_run {
    int64_t segment;
    size_t session;
    int64_t number; // within the session, from 1
    char version[64];
};

struct bids_trial {
    int64_t id, started_ns, ended_ns; // of its last attempt
    size_t run;                       // SIZE_MAX: never started
};

struct bids_condition {
    int64_t id;
    char *text;
};

struct bids {
    struct store_reader *reader;
    const char *folder;
    char *error;
    size_t error_size;
    bool simulated;
    struct bids_names people, tasks;
    struct bids_session *sessions;
    struct bids_run *runs;     // by segment
    struct bids_trial *trials; // by id
    struct bids_condition *conditions;
    size_t session_count, run_count, trial_count, condition_count;
    struct bids_counts counts;
};

bool bids_fail(struct bids *bids, const char *format, ...) __attribute__((format(printf, 2, 3))); // false

// bids_layout.c: who, when and under which label. What was loaded is freed by bids_layout_free().
bool bids_layout_load(struct bids *bids);
void bids_layout_free(struct bids *bids);
bool bids_read(struct bids *bids, const char *table, store_export_fn each, void *user);
size_t bids_find_run(const struct bids *bids, int64_t segment);                // SIZE_MAX: none
const struct bids_trial *bids_find_trial(const struct bids *bids, int64_t id); // NULL: none
const struct bids_session *bids_find_session(const struct bids *bids, int64_t id);

// bids_file.c: `name` is relative to the dataset.
FILE *bids_open(struct bids *bids, const char *name);
bool bids_close(struct bids *bids, FILE *file, const char *name);
bool bids_make_folders(struct bids *bids, const char *name); // those above a file
void bids_run_name(const struct bids *bids, size_t run, const char *tail, char out[BIDS_PATH_SIZE]);

// bids_columns.c: {"NAME": {"Description": ..., "Units": ..., "Levels": ...}, ...}
void bids_describe(const struct bids *bids, struct json *json, const char *const *columns, size_t count);

bool bids_write_people(struct bids *bids);
bool bids_write_sessions(struct bids *bids);
bool bids_write_trials(struct bids *bids); // events and answers
bool bids_write_gaze(struct bids *bids);

#endif
