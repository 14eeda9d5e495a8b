#include "studies/store/writer.h"
#include "studies/store/queue.h"

#include <signal.h>
#include <stdlib.h>
#include <time.h>

struct writer {
    struct store *store; // borrowed; outlives the thread
    uint32_t flush_ms;
    pthread_t thread;
};

static struct timespec after_ms(uint32_t ms)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    time.tv_sec += ms / 1000;
    time.tv_nsec += (long)(ms % 1000) * 1000000;
    if (time.tv_nsec >= 1000000000) {
        time.tv_sec++;
        time.tv_nsec -= 1000000000;
    }
    return time;
}

static bool half_full(const struct queue *queue)
{
    return queue->gaze_head - queue->gaze_tail > queue->gaze_capacity / 2 ||
           queue->log_head - queue->log_tail > queue->log_capacity / 2;
}

// Waits for the interval's end, or for a queue that fills up. After a failure the whole interval, so that a
// full disk is not asked without pause. False: stop.
static bool wait_for_work(struct queue *queue, uint32_t flush_ms, bool failed)
{
    struct timespec deadline = after_ms(flush_ms);
    pthread_mutex_lock(&queue->mutex);
    int code = 0;
    while (!queue->stop && code == 0 && (failed || !half_full(queue)))
        code = pthread_cond_timedwait(&queue->wake, &queue->mutex, &deadline);
    bool go_on = !queue->stop;
    pthread_mutex_unlock(&queue->mutex);
    return go_on;
}

static void *run(void *argument)
{
    struct writer *writer = argument;
    struct queue *queue = writer->store->queue;
    bool failed = false;
    while (wait_for_work(queue, writer->flush_ms, failed)) {
        struct store_error error; // kept by the queue for store_status
        // Also where nothing waits: a file that is gone must be known within a second, and that it is back too.
        if (queue_waiting(queue) > 0 || queue_failing(queue) || !sql_file_there(writer->store))
            failed = store_flush(writer->store, &error) != STORE_OK;
        else
            failed = false;
    }
    return NULL;
}

struct writer *writer_start(struct store *store, uint32_t flush_ms)
{
    struct writer *writer = calloc(1, sizeof *writer);
    if (!writer)
        return NULL;
    writer->store = store;
    writer->flush_ms = flush_ms;
    // Signals are the program's main thread's to handle.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int code = pthread_create(&writer->thread, NULL, run, writer);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (code == 0)
        return writer;
    free(writer);
    return NULL;
}

void writer_stop(struct writer *writer)
{
    if (!writer)
        return;
    struct queue *queue = writer->store->queue;
    pthread_mutex_lock(&queue->mutex);
    queue->stop = true;
    pthread_cond_signal(&queue->wake);
    pthread_mutex_unlock(&queue->mutex);
    pthread_join(writer->thread, NULL);
    free(writer);
}
