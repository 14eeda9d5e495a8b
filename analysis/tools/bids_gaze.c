// The tracker's samples, one pass, run by run and eye by eye: physio.tsv.gz, and the fixations and saccades
// found in them as `fovstats gaze --events` finds them by default, of last attempts, and those between trials:
// physioevents.tsv.gz. Both have no header. Of a run the sampling frequency is known at its end only, so the
// JSON files come last.
#include "analysis/tools/bids_gaze.h"
#include "analysis/gaze/track.h"
#include "analysis/report/gaze.h"
#include "analysis/tools/gzip_file.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct eye {
    struct gaze *gaze;
    size_t index;
    struct gzip_file *samples, *events;
    struct gaze_track track;
    int64_t trial;   // 0: none
    bool superseded; // of an attempt at the trial that was not the last
};

struct gaze {
    struct bids *bids;
    size_t at[GAZE_COLUMNS]; // where the columns of the table stand
    size_t run;              // whose files are open; SIZE_MAX: none
    struct eye eyes[BIDS_EYES];
    FILE *out; // writes `line`
    char line[512];
    struct bids_recording *recordings; // run by run, BIDS_EYES each
    bool failed;                       // inside a call that cannot say so
};

static const char *const source[GAZE_COLUMNS] = {[GAZE_SEGMENT] = "segment_id",
                                                 [GAZE_TRIAL] = "trial_id",
                                                 [GAZE_ATTEMPT] = "attempt",
                                                 [GAZE_DEVICE] = "device_ns",
                                                 [GAZE_HOST] = "host_ns",
                                                 [GAZE_EYE] = "eye",
                                                 [GAZE_X] = "x_deg",
                                                 [GAZE_Y] = "y_deg",
                                                 [GAZE_PUPIL] = "pupil_mm",
                                                 [GAZE_VALID] = "valid",
                                                 [GAZE_CONFIDENCE] = "confidence"};

static bool open_gzip(struct bids *b, size_t run, size_t eye, const char *suffix, struct gzip_file **out)
{
    char name[BIDS_PATH_SIZE], path[2 * BIDS_PATH_SIZE];
    bids_recording_name(b, run, eye, suffix, name);
    snprintf(path, sizeof path, "%s/%s", b->folder, name);
    if (!*out && bids_make_folders(b, name) && !(*out = gzip_file_open(path)))
        bids_fail(b, "%s: cannot be written: %s", path, strerror(errno));
    return *out;
}

static bool close_gzip(struct bids *b, struct gzip_file **file)
{
    bool ok = gzip_file_close(*file);
    *file = NULL;
    return ok || bids_fail(b, "%s: gaze cannot be written: %s", b->folder, strerror(errno));
}

// "\tVALUE"
static void put(FILE *out, double value)
{
    char text[CELL_NUMBER_SIZE];
    fprintf(out, "\t%s", isfinite(value) ? cell_number(value, text) : "n/a");
}

// What was written to the line goes to the file.
static bool send_line(struct gaze *g, struct gzip_file *file)
{
    long size = ftell(g->out);
    bool ok = fflush(g->out) == 0 && size > 0 && gzip_file_write(file, g->line, (size_t)size);
    rewind(g->out);
    return ok || bids_fail(g->bids, "%s: gaze cannot be written", g->bids->folder);
}

static void write_event(void *user, const struct gaze_event *e, const struct gaze_point *points)
{
    (void)points;
    struct eye *eye = user;
    struct gaze *g = eye->gaze;
    char seconds[CELL_SECONDS_SIZE];
    FILE *out = g->out;
    if (eye->superseded)
        return;
    if (!open_gzip(g->bids, g->run, eye->index, "physioevents.tsv.gz", &eye->events)) {
        g->failed = true;
        return;
    }
    fprintf(out, "%" PRId64 "\t%s\t%s", e->start_ns, cell_seconds(e->end_ns - e->start_ns, seconds),
            e->kind == GAZE_FIXATION ? "fixation" : "saccade");
    put(out, e->x_deg);
    put(out, e->y_deg);
    put(out, e->amplitude_deg);
    put(out, e->peak_deg_s);
    fprintf(out, "\t%d", e->cut);
    fprintf(out, eye->trial ? "\t%" PRId64 "\n" : "\tn/a\n", eye->trial);
    g->recordings[g->run * BIDS_EYES + eye->index].events++;
    if (!send_line(g, eye->events))
        g->failed = true;
}

static bool leave_run(struct gaze *g)
{
    bool ok = true;
    for (size_t i = 0; i < BIDS_EYES; i++) {
        gaze_track_begin(&g->eyes[i].track, NULL);
        g->eyes[i].trial = 0;
        g->eyes[i].superseded = false;
        ok = close_gzip(g->bids, &g->eyes[i].samples) && ok;
        ok = close_gzip(g->bids, &g->eyes[i].events) && ok;
    }
    g->run = SIZE_MAX;
    return ok && !g->failed;
}

static double real(const struct store_cell *cell)
{
    return cell->kind == STORE_CELL_REAL ? cell->real : (double)NAN;
}

static bool write_sample(struct gaze *g, struct eye *eye, const struct store_cell *cells)
{
    char seconds[CELL_SECONDS_SIZE];
    FILE *out = g->out;
    fprintf(out, "%" PRId64 "\t", cells[g->at[GAZE_DEVICE]].integer);
    static const int columns[] = {GAZE_X, GAZE_Y, GAZE_PUPIL};
    for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++) {
        cell_write_tsv(out, &cells[g->at[columns[i]]]);
        fputc('\t', out);
    }
    fprintf(out, "%s\t", cell_seconds(cells[g->at[GAZE_HOST]].integer, seconds));
    cell_write_tsv(out, &cells[g->at[GAZE_VALID]]);
    fputc('\t', out);
    cell_write_tsv(out, &cells[g->at[GAZE_CONFIDENCE]]);
    fputc('\t', out);
    cell_write_tsv(out, &cells[g->at[GAZE_TRIAL]]);
    fputc('\t', out);
    cell_write_tsv(out, &cells[g->at[GAZE_ATTEMPT]]);
    fputc('\n', out);
    return open_gzip(g->bids, g->run, eye->index, "physio.tsv.gz", &eye->samples) && send_line(g, eye->samples);
}

// As the analysis of the gaze has it (report/gaze_samples.c).
static bool is_superseded(const struct gaze *g, int64_t trial_id, int64_t host_ns)
{
    const struct bids_trial *trial = bids_find_trial(g->bids, trial_id);
    return trial && (trial->run != g->run || host_ns < trial->started_ns);
}

static bool take_sample(struct gaze *g, const struct store_cell *cells)
{
    const char *name = cells[g->at[GAZE_EYE]].text;
    size_t index = strcmp(name, "left") == 0 ? 0 : strcmp(name, "right") == 0 ? 1 : 2;
    struct eye *eye = &g->eyes[index];
    struct bids_recording *recording = &g->recordings[g->run * BIDS_EYES + index];
    const struct store_cell *trial = &cells[g->at[GAZE_TRIAL]];
    int64_t trial_id = trial->kind == STORE_CELL_INTEGER ? trial->integer : 0;
    bool superseded = is_superseded(g, trial_id, cells[g->at[GAZE_HOST]].integer);
    if (recording->samples == 0) {
        if (!gaze_quality_init(&recording->quality))
            return false;
        recording->start_ns = cells[g->at[GAZE_HOST]].integer;
    }
    recording->samples++;
    if (!eye->samples)
        gaze_track_begin(&eye->track, &recording->quality);
    else if (trial_id != eye->trial || superseded != eye->superseded)
        gaze_track_break(&eye->track);
    eye->trial = trial_id;
    eye->superseded = superseded;
    gaze_track_sample(&eye->track, cells[g->at[GAZE_DEVICE]].integer, real(&cells[g->at[GAZE_X]]),
                      real(&cells[g->at[GAZE_Y]]), cells[g->at[GAZE_VALID]].integer == 1);
    return !g->failed && write_sample(g, eye, cells);
}

static bool take_row(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct gaze *g = user;
    if (header) {
        for (size_t c = 0; c < GAZE_COLUMNS; c++)
            for (size_t i = 0; i < count; i++)
                if (strcmp(cells[i].name, source[c]) == 0)
                    g->at[c] = i;
        return true;
    }
    size_t run = bids_find_run(g->bids, cells[g->at[GAZE_SEGMENT]].integer);
    if (run == SIZE_MAX)
        return bids_fail(g->bids, "%s: a gaze sample belongs to no segment",
                         store_reader_path(g->bids->reader));
    if (run != g->run && g->run != SIZE_MAX && !leave_run(g))
        return false;
    g->run = run;
    return take_sample(g, cells);
}

// What has no rate cannot be a recording of BIDS, which demands it.
static bool finish_recording(struct bids *b, size_t run, size_t eye, struct bids_recording *recording)
{
    double interval_ms = gaze_quality_interval(&recording->quality);
    if (interval_ms > 0) {
        b->counts.recordings++;
        b->counts.samples += recording->samples;
        return bids_describe_recording(b, run, eye, recording, 1000 / interval_ms);
    }
    b->counts.samples_without_rate += recording->samples;
    static const char *const suffixes[] = {"physio.tsv.gz", "physioevents.tsv.gz"};
    for (size_t i = 0; i < 2; i++) {
        char name[BIDS_PATH_SIZE], path[2 * BIDS_PATH_SIZE];
        bids_recording_name(b, run, eye, suffixes[i], name);
        snprintf(path, sizeof path, "%s/%s", b->folder, name);
        if (unlink(path) != 0 && errno != ENOENT)
            return bids_fail(b, "%s: cannot be removed: %s", path, strerror(errno));
    }
    return true;
}

bool bids_write_gaze(struct bids *b)
{
    struct gaze g = {.bids = b, .run = SIZE_MAX};
    struct gaze_options options = gaze_options(GAZE_IVT);
    g.recordings = calloc(b->run_count * BIDS_EYES + 1, sizeof *g.recordings);
    g.out = fmemopen(g.line, sizeof g.line, "w");
    bool ok = g.recordings && g.out;
    for (size_t i = 0; i < BIDS_EYES; i++) {
        g.eyes[i].gaze = &g;
        g.eyes[i].index = i;
        ok = gaze_track_init(&g.eyes[i].track, &options.rules, options.gap_ms, write_event, &g.eyes[i]) && ok;
    }
    ok = ok && bids_read(b, "gaze", take_row, &g);
    ok = leave_run(&g) && ok;
    for (size_t i = 0; g.recordings && i < b->run_count * BIDS_EYES; i++) {
        if (!g.recordings[i].samples)
            continue;
        ok = ok && finish_recording(b, i / BIDS_EYES, i % BIDS_EYES, &g.recordings[i]);
        gaze_quality_finish(&g.recordings[i].quality);
    }
    for (size_t i = 0; i < BIDS_EYES; i++)
        gaze_track_finish(&g.eyes[i].track);
    free(g.recordings);
    if (g.out)
        fclose(g.out);
    return ok;
}
