#include "app/fovbench/group.h"

#include "app/fovbench/csv.h"
#include "app/fovbench/errors.h"
#include "app/fovbench/lineup.h"
#include "app/fovbench/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// What a walk fills.
struct measured {
    struct series series[REQUEST_MODES];
    struct errors *errors; // NULL: none
};

static void out_of_memory(void)
{
    fprintf(stderr, "fovbench: out of memory\n");
}

static struct walk walk_of(const struct group_desc *g)
{
    return (struct walk){.gaze = g->gaze->gaze,
                         .width = g->size.width,
                         .height = g->size.height,
                         .fov_deg = g->request->fov_deg,
                         .start_s = g->request->start_s,
                         .rest = g->request->rest};
}

static struct lineup_desc lineup_of(const struct group_desc *g)
{
    return (struct lineup_desc){.device = g->request->device,
                                .width = g->size.width,
                                .height = g->size.height,
                                .modes = g->request->modes,
                                .mode_count = g->request->mode_count,
                                .settings = {.ssao = g->request->ssao, .taa = g->request->taa}};
}

static bool step(struct lineup *lineup, const struct frame *frame, struct measured *m)
{
    struct frame_stats stats[REQUEST_MODES];
    if (!lineup_draw(lineup, frame, stats))
        return false;
    if (frame->number < REQUEST_WARM_UP)
        return true;
    const uint64_t n = frame->number - REQUEST_WARM_UP;
    for (size_t mode = 0; mode < lineup->count; mode++)
        series_add(&m->series[mode], &stats[mode]);
    return !m->errors || !errors_due(m->errors, n) || errors_take(m->errors, frame, n);
}

static bool walk_path(const struct group_desc *g, struct lineup *lineup, struct measured *m)
{
    const struct walk walk = walk_of(g);
    const uint64_t all = REQUEST_WARM_UP + g->request->frames;
    struct frame frame;
    for (uint64_t n = 0; n < all; n++) {
        progress_show(g->progress_name, "frame", n, all);
        walk_frame(&walk, g->scene, n, &frame);
        if (!step(lineup, &frame, m))
            return false;
    }
    return true;
}

// Each pass in a submission of its own: the frame's time means nothing here, the passes' do.
static bool walk_passes(const struct group_desc *g, struct row *rows)
{
    enum { PASS_FRAMES = 30 };
    const struct walk walk = walk_of(g);
    struct lineup_desc desc = lineup_of(g);
    struct frame_stats stats[REQUEST_MODES];
    struct pass_series passes[REQUEST_MODES] = {0};
    struct lineup lineup;
    struct frame frame;
    const uint64_t measured = g->request->frames < PASS_FRAMES ? g->request->frames : PASS_FRAMES;
    desc.pass_times = true;
    bool ok = lineup_init(&lineup, &desc, g->scene);
    for (size_t mode = 0; ok && mode < lineup.count; mode++)
        ok = pass_series_init(&passes[mode], measured);
    for (uint64_t n = 0; ok && n < REQUEST_WARM_UP + measured; n++) {
        progress_show(g->progress_name, "passes of frame", n, REQUEST_WARM_UP + measured);
        walk_frame(&walk, g->scene, n, &frame);
        ok = lineup_draw(&lineup, &frame, stats);
        for (size_t mode = 0; ok && n >= REQUEST_WARM_UP && mode < lineup.count; mode++)
            pass_series_add(&passes[mode], &stats[mode]);
    }
    for (size_t mode = 0; mode < g->request->mode_count; mode++) {
        for (size_t i = 0; ok && i < passes[mode].pass_count; i++)
            rows[mode].passes[rows[mode].pass_count++] =
                (struct row_pass){passes[mode].names[i], pass_series_median_ms(&passes[mode], i)};
        rows[mode].pass_source = "one submission per pass";
        pass_series_finish(&passes[mode]);
    }
    lineup_finish(&lineup);
    return ok;
}

static bool fill_row(const struct group_desc *g, const struct lineup *lineup, const struct measured *m,
                     size_t mode, struct row *out)
{
    const struct request *r = g->request;
    const struct renderer_device *device = renderer_device(lineup->renderer);
    const double none = (double)NAN;
    const struct row_error no_error = {none, none, none, none, none};
    *out = (struct row){.scene = g->scene_name,
                        .label = r->modes[mode].text,
                        .mode = r->modes[mode].choice.mode->name,
                        .gaze = g->gaze->text,
                        .width = g->size.width,
                        .height = g->size.height,
                        .ssao = r->ssao,
                        .taa = r->taa,
                        .rest = r->rest,
                        .frames = m->series[mode].count,
                        .memory_mb = (double)renderer_option_memory(lineup->options[mode]) / 1e6,
                        .error = no_error,
                        .flicker_still = none,
                        .supersampled = no_error};
    memcpy(out->device, device->name, sizeof out->device);
    memcpy(out->driver, device->driver, sizeof out->driver);
    for (int i = 0; i < ROW_RINGS; i++)
        out->rings[i] = no_error;
    if (!mode_parameters_json(&r->modes[mode].choice, out->parameters, sizeof out->parameters) ||
        !series_times(&m->series[mode], &out->times) ||
        !series_ratio(&m->series[0], &m->series[mode], &out->ratio)) {
        out_of_memory();
        return false;
    }
    series_work(&m->series[mode], &out->work);
    if (m->errors) {
        out->error_frames = errors_frames(m->errors);
        errors_result(m->errors, mode, &out->error, out->rings);
    }
    return true;
}

static bool measured_init(const struct group_desc *g, struct lineup *lineup, struct measured *m)
{
    const struct errors_desc desc = {
        .lineup = lineup, .width = g->size.width, .height = g->size.height, .every = g->request->error_every};
    *m = (struct measured){0};
    for (size_t mode = 0; mode < lineup->count; mode++)
        if (!series_init(&m->series[mode], g->request->frames)) {
            out_of_memory();
            return false;
        }
    m->errors = desc.every ? errors_create(&desc) : NULL;
    return m->errors || !desc.every;
}

static void measured_finish(struct measured *m)
{
    for (size_t mode = 0; mode < REQUEST_MODES; mode++)
        series_finish(&m->series[mode]);
    errors_destroy(m->errors);
}

static void write_frames(FILE *out, const struct measured *m, const struct row *rows, size_t mode_count)
{
    for (size_t mode = 0; mode < mode_count; mode++)
        for (size_t i = 0; i < m->series[mode].count; i++)
            csv_write_frame(out, &rows[mode], i, &m->series[mode].samples[i]);
}

bool group_measure(const struct group_desc *g, struct row *out_rows)
{
    struct lineup lineup;
    struct measured measured;
    const struct lineup_desc desc = lineup_of(g);
    if (!lineup_init(&lineup, &desc, g->scene))
        return false;
    bool ok = measured_init(g, &lineup, &measured) && walk_path(g, &lineup, &measured);
    for (size_t mode = 0; ok && mode < lineup.count; mode++)
        ok = fill_row(g, &lineup, &measured, mode, &out_rows[mode]);
    if (ok && g->frames_csv)
        write_frames(g->frames_csv, &measured, out_rows, lineup.count);
    measured_finish(&measured);
    lineup_finish(&lineup);
    ok = ok && (!g->request->pass_times || walk_passes(g, out_rows));
    progress_clear();
    return ok;
}
