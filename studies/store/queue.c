#include "studies/store/queue.h"
#include "studies/store/sql.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// Written once, so that memory does not grow later; zeros would let the system hand out pages at first use.
static void *touched(size_t size)
{
    void *memory = malloc(size);
    if (memory)
        memset(memory, 0xa5, size);
    return memory;
}

struct queue *queue_create(uint32_t gaze_capacity, uint32_t log_capacity, int64_t next_gaze_id)
{
    struct queue *queue = calloc(1, sizeof *queue);
    if (!queue)
        return NULL;
    queue->gaze = touched(gaze_capacity * sizeof *queue->gaze);
    queue->log = touched(log_capacity * sizeof *queue->log);
    queue->gaze_capacity = gaze_capacity;
    queue->log_capacity = log_capacity;
    queue->next_gaze_id = next_gaze_id;
    pthread_mutex_init(&queue->mutex, NULL);
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC); // a wall clock set back must not stop the writer
    pthread_cond_init(&queue->wake, &attributes);
    pthread_condattr_destroy(&attributes);
    if (queue->gaze && queue->log)
        return queue;
    queue_destroy(queue);
    return NULL;
}

void queue_destroy(struct queue *queue)
{
    if (!queue)
        return;
    pthread_cond_destroy(&queue->wake);
    pthread_mutex_destroy(&queue->mutex);
    free(queue->gaze);
    free(queue->log);
    free(queue);
}

// --- the writing side ---

static uint64_t drop_count(const struct queue_drops *drops)
{
    uint64_t count = drops->gaze;
    for (int kind = 0; kind < QUEUE_KINDS; kind++)
        count += drops->log[kind];
    return count;
}

void queue_mark(struct queue *queue)
{
    pthread_mutex_lock(&queue->mutex);
    queue->span = (struct queue_span){.gaze_tail = queue->gaze_tail,
                                      .gaze_head = queue->gaze_head,
                                      .log_tail = queue->log_tail,
                                      .log_head = queue->log_head,
                                      .drops = queue->drops};
    pthread_mutex_unlock(&queue->mutex);
}

void queue_committed(struct queue *queue)
{
    const struct queue_span *span = &queue->span;
    pthread_mutex_lock(&queue->mutex);
    queue->gaze_tail = span->gaze_head;
    queue->log_tail = span->log_head;
    queue->drops.gaze -= span->drops.gaze;
    for (int kind = 0; kind < QUEUE_KINDS; kind++)
        queue->drops.log[kind] -= span->drops.log[kind];
    struct store_status *status = &queue->status;
    status->gaze_committed += span->gaze_head - span->gaze_tail;
    status->log_committed += span->log_head - span->log_tail;
    status->refused += span->refused;
    status->failing = false;
    status->error.text[0] = '\0';
    pthread_mutex_unlock(&queue->mutex);
}

void queue_failed(struct queue *queue, const char *why)
{
    pthread_mutex_lock(&queue->mutex);
    queue->status.failing = true;
    snprintf(queue->status.error.text, sizeof queue->status.error.text, "%s", why);
    pthread_mutex_unlock(&queue->mutex);
}

uint64_t queue_waiting(struct queue *queue)
{
    pthread_mutex_lock(&queue->mutex);
    uint64_t count = queue->gaze_head - queue->gaze_tail + queue->log_head - queue->log_tail;
    count += drop_count(&queue->drops);
    pthread_mutex_unlock(&queue->mutex);
    return count;
}

bool queue_failing(struct queue *queue)
{
    pthread_mutex_lock(&queue->mutex);
    bool failing = queue->status.failing;
    pthread_mutex_unlock(&queue->mutex);
    return failing;
}

void store_status(struct store *store, struct store_status *out)
{
    *out = (struct store_status){0};
    if (!store->queue)
        return;
    pthread_mutex_lock(&store->queue->mutex);
    *out = store->queue->status;
    pthread_mutex_unlock(&store->queue->mutex);
}

// --- the pushing side ---

static void note_drop(struct queue *queue, uint64_t *count, int64_t segment_id, int64_t at_ns)
{
    if (drop_count(&queue->drops) == 0) {
        queue->drops.segment_id = segment_id;
        queue->drops.at_ns = at_ns;
    }
    ++*count;
}

int64_t store_push_gaze(struct store *store, const struct store_gaze *gaze)
{
    struct queue *queue = store->queue;
    if (!queue)
        return 0;
    int64_t id = 0;
    pthread_mutex_lock(&queue->mutex);
    uint64_t waiting = queue->gaze_head - queue->gaze_tail;
    if (waiting < queue->gaze_capacity) {
        id = queue->next_gaze_id++;
        queue->gaze[queue->gaze_head++ % queue->gaze_capacity] = (struct queue_gaze){.id = id, .row = *gaze};
        queue->status.gaze_pushed++;
        if (waiting == queue->gaze_capacity / 2)
            pthread_cond_signal(&queue->wake);
    } else {
        note_drop(queue, &queue->drops.gaze, gaze->segment_id, gaze->sample.host_ns);
        queue->status.gaze_dropped++;
    }
    pthread_mutex_unlock(&queue->mutex);
    return id;
}

struct push {
    enum queue_kind kind;
    const char *name, *text; // name for kind or parameter
    int64_t segment_id, at_ns;
};

// Takes the mutex; returns the entry to fill, or NULL where the row is dropped. push_end in any case.
static struct queue_log *push_begin(struct queue *queue, const struct push *push)
{
    size_t name_length = push->name ? strnlen(push->name, QUEUE_NAME_SIZE) : 0;
    size_t text_length = push->text ? strnlen(push->text, STORE_DETAIL_SIZE) : 0;
    bool fits = name_length < QUEUE_NAME_SIZE && text_length < STORE_DETAIL_SIZE;
    pthread_mutex_lock(&queue->mutex);
    uint64_t waiting = queue->log_head - queue->log_tail;
    if (!fits || waiting >= queue->log_capacity) {
        note_drop(queue, &queue->drops.log[push->kind], push->segment_id, push->at_ns);
        queue->status.log_dropped++;
        return NULL;
    }
    struct queue_log *entry = &queue->log[queue->log_head++ % queue->log_capacity];
    queue->status.log_pushed++;
    entry->kind = push->kind;
    entry->has_text = push->text != NULL;
    memcpy(entry->name, push->name ? push->name : "", name_length);
    entry->name[name_length] = '\0';
    memcpy(entry->text, push->text ? push->text : "", text_length);
    entry->text[text_length] = '\0';
    if (waiting == queue->log_capacity / 2)
        pthread_cond_signal(&queue->wake);
    return entry;
}

static bool push_end(struct queue *queue, const struct queue_log *entry)
{
    pthread_mutex_unlock(&queue->mutex);
    return entry != NULL;
}

bool store_push_frame(struct store *store, const struct store_frame *frame)
{
    if (!store->queue)
        return false;
    struct queue_log *entry = push_begin(store->queue, &(struct push){.kind = QUEUE_FRAME,
                                                                      .text = frame->effective,
                                                                      .segment_id = frame->segment_id,
                                                                      .at_ns = frame->start_ns});
    if (entry) {
        entry->row.frame = *frame;
        entry->row.frame.effective = NULL;
    }
    return push_end(store->queue, entry);
}

bool store_push_exposure(struct store *store, const struct store_exposure *exposure)
{
    if (!store->queue)
        return false;
    struct queue_log *entry = push_begin(store->queue, &(struct push){.kind = QUEUE_EXPOSURE,
                                                                      .segment_id = exposure->segment_id,
                                                                      .at_ns = exposure->start_ns});
    if (entry)
        entry->row.exposure = *exposure;
    return push_end(store->queue, entry);
}

bool store_push_event(struct store *store, const struct store_event *event)
{
    if (!store->queue)
        return false;
    struct queue_log *entry = push_begin(store->queue, &(struct push){.kind = QUEUE_EVENT,
                                                                      .name = event->kind,
                                                                      .text = event->detail,
                                                                      .segment_id = event->segment_id,
                                                                      .at_ns = event->at_ns});
    if (entry) {
        entry->row.event = *event;
        entry->row.event.kind = entry->row.event.detail = NULL;
    }
    return push_end(store->queue, entry);
}

bool store_push_adjust_step(struct store *store, const struct store_adjust_step *step)
{
    if (!store->queue)
        return false;
    struct queue_log *entry = push_begin(store->queue, &(struct push){.kind = QUEUE_ADJUST_STEP,
                                                                      .name = step->parameter,
                                                                      .segment_id = step->segment_id,
                                                                      .at_ns = step->at_ns});
    if (entry) {
        entry->row.adjust_step = *step;
        entry->row.adjust_step.parameter = NULL;
    }
    return push_end(store->queue, entry);
}
