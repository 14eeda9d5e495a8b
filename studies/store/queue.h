// Inside the store room: the fixed queues between those who push and the one transaction that writes.
//
// Gaze samples and everything else have a ring each, so that neither starves the other. A push copies one entry
// under a mutex that is never held during a disk access. Entries leave the ring only after their commit.
#ifndef STUDIES_STORE_QUEUE_H
#define STUDIES_STORE_QUEUE_H

#include "studies/store/store.h"

#include <pthread.h>

enum queue_kind { QUEUE_FRAME, QUEUE_EXPOSURE, QUEUE_EVENT, QUEUE_ADJUST_STEP, QUEUE_KINDS };

enum { QUEUE_NAME_SIZE = 64 }; // of event.kind and adjust_step.parameter

struct queue_gaze {
    int64_t id;
    struct store_gaze row;
};

struct queue_log {
    enum queue_kind kind;
    union {
        struct store_frame frame; // pointers in here are not set; the texts are below
        struct store_exposure exposure;
        struct store_event event;
        struct store_adjust_step adjust_step;
    } row;
    bool has_text;
    char name[QUEUE_NAME_SIZE];
    char text[STORE_DETAIL_SIZE];
};

// Rows dropped and not yet reported.
struct queue_drops {
    uint64_t gaze, log[QUEUE_KINDS];
    int64_t segment_id, at_ns; // of the first of them
};

// What one transaction covers: entries from tail to head, and the drops it reports.
struct queue_span {
    uint64_t gaze_tail, gaze_head, log_tail, log_head;
    struct queue_drops drops;
    uint64_t refused; // counted by rows_write
};

struct queue {
    struct queue_gaze *gaze; // owned, gaze_capacity long; entry n is at n % gaze_capacity
    struct queue_log *log;
    uint32_t gaze_capacity, log_capacity;

    pthread_mutex_t mutex; // guards all below, and the entries outside tail..head
    pthread_cond_t wake;   // the writer's: half full, or stop
    bool stop;
    uint64_t gaze_head, gaze_tail, log_head, log_tail; // count up for ever
    int64_t next_gaze_id;
    struct queue_drops drops;
    struct store_status status;

    struct queue_span span; // of the transaction that runs; belongs to its thread
};

// NULL: out of memory.
struct queue *queue_create(uint32_t gaze_capacity, uint32_t log_capacity, int64_t next_gaze_id);
void queue_destroy(struct queue *queue); // NULL is fine

void queue_mark(struct queue *queue);      // sets span to all that waits
void queue_committed(struct queue *queue); // span is on disk
void queue_failed(struct queue *queue, const char *why);
uint64_t queue_waiting(struct queue *queue); // entries and unreported drops
bool queue_failing(struct queue *queue);     // the last commit did not succeed

#endif
