// How old a sample was when a frame used it, and the tracker's independent checks.
#include "analysis/report/gaze_private.h"

#include "studies/store/gaze.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Half a second, after which the gaze counts as lost and no frame follows it any more.
#define TIME_MS 0.1
enum { TIME_BINS = 5000 };

struct reading {
    struct gaze_report *out;
    const struct sample *sample;
    size_t file;
    int64_t session_id; // of the last frame
    size_t latency;     // its index; SAMPLE_NONE: not analysed
    bool no_memory;
};

static bool find_latency(struct reading *r, int64_t session_id)
{
    struct gaze_report *out = r->out;
    size_t session = sample_find_session(r->sample, r->file, session_id);
    r->session_id = session_id;
    r->latency = SAMPLE_NONE;
    for (size_t i = 0; i < out->latency_count && session != SAMPLE_NONE; i++)
        if (out->latencies[i].session == session)
            r->latency = i;
    if (session == SAMPLE_NONE || r->latency != SAMPLE_NONE)
        return true;
    if (!sample_grow(&out->latencies, out->latency_count, sizeof out->latencies[0]))
        return false;
    struct gaze_latency *latency = &out->latencies[out->latency_count];
    *latency = (struct gaze_latency){.session = session};
    r->latency = out->latency_count++; // from here on gaze_free() has it
    return gaze_bins_init(&latency->age, TIME_MS, TIME_BINS) &&
           gaze_bins_init(&latency->to_light, TIME_MS, TIME_BINS);
}

static bool add_use(void *user, const struct store_gaze_use *row)
{
    struct reading *r = user;
    if (row->session_id != r->session_id && !find_latency(r, row->session_id))
        return !(r->no_memory = true);
    if (r->latency == SAMPLE_NONE)
        return true;
    struct gaze_latency *latency = &r->out->latencies[r->latency];
    if (row->lost) {
        latency->lost++;
        return true;
    }
    latency->frames++;
    latency->estimated += row->estimated && !isnan(row->to_light_ms);
    latency->unknown += isnan(row->to_light_ms);
    gaze_bins_add(&latency->age, row->age_ms);
    gaze_bins_add(&latency->to_light, row->age_ms + row->to_light_ms);
    return true;
}

static bool read_file(struct reading *r, char *error, size_t error_size)
{
    struct store_reader *reader =
        store_reader_open(store_reader_path(r->sample->files[r->file]), error, error_size);
    if (!reader)
        return false;
    bool ok = store_read_gaze_uses(reader, add_use, r);
    if (!ok)
        snprintf(error, error_size, "%s", r->no_memory ? "not enough memory" : store_reader_error(reader));
    store_reader_close(reader);
    return ok;
}

bool gaze_read_uses(struct gaze_report *out, const struct sample *sample, char *error, size_t error_size)
{
    for (size_t i = 0; i < sample->file_count; i++) {
        struct reading r = {.out = out, .sample = sample, .file = i, .latency = SAMPLE_NONE};
        if (!read_file(&r, error, error_size))
            return false;
    }
    return true;
}
