// Reads what is most of a study's rows: gaze and frames.
#include "analysis/report/sections.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

static bool load_gaze(struct report *r, char *error, size_t error_size)
{
    struct gaze_options options = gaze_options(GAZE_IVT);
    options.conf = r->conf;
    if (!gaze_load(&r->gaze, r->sample, &options, error, error_size))
        return false;
    if (gaze_over_people(&r->gaze_over, &r->gaze))
        return true;
    snprintf(error, error_size, "not enough memory");
    return false;
}

// Gaze and frames are most of a study's rows. The audit of the frames goes on beside the rest, with readers of
// its own, since a reader belongs to one thread; of the sample it reads only.
struct audit_task {
    struct report *report;
    char error[SAMPLE_ERROR_SIZE];
    bool ok;
};

static void *run_audit(void *user)
{
    struct audit_task *task = user;
    struct sample sample = *task->report->sample;
    sample.files = calloc(sample.file_count, sizeof sample.files[0]);
    task->ok = sample.files != NULL;
    if (!task->ok)
        snprintf(task->error, sizeof task->error, "not enough memory");
    for (size_t i = 0; i < sample.file_count && task->ok; i++) {
        const char *path = store_reader_path(task->report->sample->files[i]);
        sample.files[i] = store_reader_open(path, task->error, sizeof task->error);
        task->ok = sample.files[i] != NULL;
    }
    task->ok = task->ok && audit_load(&task->report->audit, &sample, task->error, sizeof task->error);
    for (size_t i = 0; sample.files && i < sample.file_count; i++)
        if (sample.files[i])
            store_reader_close(sample.files[i]);
    free(sample.files);
    return NULL;
}

bool report_load_frames(struct report *r, char *error, size_t error_size)
{
    struct audit_task task = {.report = r};
    pthread_t thread;
    bool threaded = pthread_create(&thread, NULL, run_audit, &task) == 0;
    bool ok = load_gaze(r, error, error_size) &&
              frames_load(&r->frames, &r->frames_pairs, r->sample, r->conf, error, error_size);
    if (threaded)
        pthread_join(thread, NULL);
    else
        run_audit(&task);
    if (ok && !task.ok)
        snprintf(error, error_size, "%s", task.error);
    return ok && task.ok;
}
