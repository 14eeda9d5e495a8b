#include "app/fovbench/group.h"

#include "app/fovbench/csv.h"
#include "app/fovbench/errors.h"
#include "app/fovbench/lineup.h"
#include "app/fovbench/progress.h"
#include "app/fovbench/still.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// What a walk fills.
struct measured {
    struct series series[REQUEST_MODES];
    struct pass_series
        passes[REQUEST_MODES];       // of the measured frames; empty where they do not tell passes apart
    struct supersample *supersample; // NULL: none
    struct errors *errors;           // NULL: none
    double flicker_still[REQUEST_MODES];
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
    double moving_share = (double)NAN;
    if (!lineup_draw(lineup, frame, stats))
        return false;
    if (frame->number < REQUEST_WARM_UP)
        return true;
    const uint64_t n = frame->number - REQUEST_WARM_UP;
    if (m->errors && errors_due(m->errors, n) && !errors_take(m->errors, frame, n, &moving_share))
        return false;
    for (size_t mode = 0; mode < lineup->count; mode++) {
        series_add(&m->series[mode], &stats[mode], moving_share);
        pass_series_add(&m->passes[mode], &stats[mode]);
    }
    return true;
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

static void fill_passes(struct pass_series *passes, const char *source, struct row *row)
{
    row->pass_source = passes->count ? source : NULL;
    for (size_t i = 0; i < passes->pass_count; i++)
        row->passes[row->pass_count++] = (struct row_pass){passes->names[i], pass_series_median_ms(passes, i)};
}

// Each pass in a submission of its own: the frame's time means nothing here, the passes' do.
static bool walk_passes(const struct group_desc *g, struct row *rows)
{
    enum { PASS_FRAMES = 10, PASS_WARM_UP = 5 };
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
    for (uint64_t n = 0; ok && n < PASS_WARM_UP + measured; n++) {
        progress_show(g->progress_name, "passes of frame", n, PASS_WARM_UP + measured);
        walk_frame(&walk, g->scene, n, &frame);
        ok = lineup_draw(&lineup, &frame, stats);
        for (size_t mode = 0; ok && n >= PASS_WARM_UP && mode < lineup.count; mode++)
            pass_series_add(&passes[mode], &stats[mode]);
    }
    for (size_t mode = 0; mode < g->request->mode_count; mode++) {
        if (ok)
            fill_passes(&passes[mode], "one submission per pass", &rows[mode]);
        pass_series_finish(&passes[mode]);
    }
    lineup_finish(&lineup);
    return ok;
}

static bool fill_row(const struct group_desc *g, const struct lineup *lineup, struct measured *m, size_t mode,
                     struct row *out)
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
                        .flicker_still = m->flicker_still[mode],
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
    fill_passes(&m->passes[mode], "time stamps of the measured frames", out);
    if (m->errors)
        errors_result(m->errors, mode, out);
    return true;
}

static bool create_errors(const struct group_desc *g, struct lineup *lineup, struct measured *m)
{
    const struct request *r = g->request;
    const struct walk walk = walk_of(g);
    const struct lineup_desc desc = lineup_of(g);
    struct frame frame;
    walk_frame(&walk, g->scene, 0, &frame);
    if (r->supersampled && !(m->supersample = supersample_create(&desc, g->scene)))
        return false;
    const struct errors_desc errors = {.lineup = lineup,
                                       .supersample = m->supersample,
                                       .reference = &r->modes[0].choice,
                                       .eye = &frame.eyes[EYE_LEFT],
                                       .width = g->size.width,
                                       .height = g->size.height,
                                       .frames = r->frames,
                                       .every = r->error_every,
                                       .supersampled_frames = r->supersampled};
    m->errors = errors_create(&errors);
    return m->errors != NULL;
}

// A software driver's time stamps do not tell passes of one submission apart (DESIGN section 2).
static bool measured_init(const struct group_desc *g, struct lineup *lineup, struct measured *m)
{
    const bool stamps = !renderer_device(lineup->renderer)->software && !g->request->pass_times;
    *m = (struct measured){0};
    for (size_t mode = 0; mode < lineup->count; mode++) {
        m->flicker_still[mode] = (double)NAN;
        if (!series_init(&m->series[mode], g->request->frames) ||
            !pass_series_init(&m->passes[mode], stamps ? g->request->frames : 0)) {
            out_of_memory();
            return false;
        }
    }
    return !g->request->error_every || create_errors(g, lineup, m);
}

static void measured_finish(struct measured *m)
{
    for (size_t mode = 0; mode < REQUEST_MODES; mode++) {
        series_finish(&m->series[mode]);
        pass_series_finish(&m->passes[mode]);
    }
    errors_destroy(m->errors);
    supersample_destroy(m->supersample);
}

static bool walk_still(const struct group_desc *g, struct lineup *lineup, struct measured *m)
{
    const struct walk walk = walk_of(g);
    return !g->request->still_frames ||
           still_measure(lineup, &walk, g->scene, g->request->still_frames, g->progress_name, m->flicker_still);
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
    bool ok = measured_init(g, &lineup, &measured) && walk_path(g, &lineup, &measured) &&
              walk_still(g, &lineup, &measured);
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
