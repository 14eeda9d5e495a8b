#include "analysis/report/frames.h"

#include "analysis/report/frames_private.h"
#include "analysis/report/level.h"
#include "analysis/stats/quantile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct filling {
    struct frames *frames;
    struct frames_pairing *pairing;
    struct sample *sample;
    size_t file;
    int64_t last_segment, last_number, last_start_ns;
    int64_t session_id; // of the last frame
    size_t session;
};

static struct frame_group *find_group(struct filling *f, const struct store_frame_row *row)
{
    struct frames *all = f->frames;
    size_t condition = sample_find_condition(f->sample, f->file, row->condition_id);
    for (size_t i = 0; i < all->group_count; i++)
        if (all->groups[i].condition == condition && strcmp(all->groups[i].phase, row->phase) == 0)
            return &all->groups[i];
    struct frame_group group = {.condition = condition,
                                .label = condition == SAMPLE_NONE ? "gray or text"
                                                                  : f->sample->conditions[condition].label,
                                .phase = sample_keep(f->sample, row->phase)};
    if (!group.phase || !sample_grow(&all->groups, all->group_count, sizeof all->groups[0]))
        return NULL;
    all->groups[all->group_count] = group;
    return &all->groups[all->group_count++];
}

static bool add_time(struct frame_times *times, double ms)
{
    if (isnan(ms))
        return true;
    if (!sample_grow(&times->values, times->count, sizeof times->values[0]))
        return false;
    times->values[times->count++] = ms;
    return true;
}

static bool add_frame(void *user, const struct store_frame_row *row)
{
    struct filling *f = user;
    if (f->session_id != row->session_id) {
        f->session_id = row->session_id;
        f->session = sample_find_session(f->sample, f->file, row->session_id);
    }
    if (f->session == SAMPLE_NONE)
        return true;
    struct frame_group *group = find_group(f, row);
    if (!group)
        return false;
    bool follows = f->last_segment == row->segment_id && f->last_number + 1 == row->number;
    double interval = follows ? (double)(row->start_ns - f->last_start_ns) / 1e6 : (double)NAN;
    f->last_segment = row->segment_id;
    f->last_number = row->number;
    f->last_start_ns = row->start_ns;
    group->frames++;
    group->late += row->late;
    group->late_known += row->late_known;
    if (!isnan(row->shaded_px)) {
        group->shaded_px_sum += row->shaded_px;
        group->shaded_frames++;
    }
    f->frames->frames++;
    f->frames->late += row->late;
    f->frames->late_known += row->late_known;
    f->frames->simulated_clock = f->frames->simulated_clock || row->simulated_clock;
    return frames_pairing_frame(f->pairing, row) && add_time(&group->gpu, row->gpu_us / 1e3) &&
           add_time(&group->cpu, row->cpu_us / 1e3) && add_time(&group->interval, interval);
}

static void finish_times(struct frame_times *times)
{
    stat_sort(times->values, times->count);
    times->median = stat_quantile(times->values, times->count, 0.5);
    times->p95 = stat_quantile(times->values, times->count, 0.95);
    times->p99 = stat_quantile(times->values, times->count, 0.99);
}

static int phase_order(const char *phase)
{
    static const char *const order[] = {"stimulus", "fade", "question", "rest"};
    int i = 0;
    while (i < 4 && strcmp(order[i], phase) != 0)
        i++;
    return i;
}

static int by_phase(const void *x, const void *y)
{
    const struct frame_group *a = x, *b = y;
    int p = phase_order(a->phase), q = phase_order(b->phase);
    if (p != q)
        return p - q;
    int order = level_order(a->label, b->label);
    return order ? order : (a->condition > b->condition) - (a->condition < b->condition);
}

static bool read_file(struct filling *f)
{
    bool ok =
        frames_pairing_begin(f->pairing, f->file) && store_read_frames(f->sample->files[f->file], add_frame, f);
    return frames_pairing_end(f->pairing) && ok;
}

static void finish(struct frames *out)
{
    for (size_t i = 0; i < out->group_count; i++) {
        struct frame_group *g = &out->groups[i];
        finish_times(&g->gpu);
        finish_times(&g->cpu);
        finish_times(&g->interval);
        g->shaded_px_mean = g->shaded_frames ? g->shaded_px_sum / (double)g->shaded_frames : (double)NAN;
    }
    if (out->group_count > 1)
        qsort(out->groups, out->group_count, sizeof out->groups[0], by_phase);
}

bool frames_load(struct frames *out, struct frames_pairs *pairs, struct sample *sample, double conf,
                 char *error, size_t error_size)
{
    struct frames_pairing pairing = {.sample = sample};
    bool ok = true;
    *out = (struct frames){0};
    *pairs = (struct frames_pairs){0};
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; i < sample->file_count && ok; i++) {
        ok = read_file(&(struct filling){
            .frames = out, .pairing = &pairing, .sample = sample, .file = i, .session = SAMPLE_NONE});
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    if (frames_pairing_finish(&pairing, pairs, conf) && ok) {
        finish(out);
        error[0] = '\0';
        return true;
    }
    frames_free(out);
    frames_pairs_free(pairs);
    return false;
}

void frames_free(struct frames *frames)
{
    for (size_t i = 0; i < frames->group_count; i++) {
        free(frames->groups[i].gpu.values);
        free(frames->groups[i].cpu.values);
        free(frames->groups[i].interval.values);
    }
    free(frames->groups);
    *frames = (struct frames){0};
}
