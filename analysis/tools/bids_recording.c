// What the columns of a recording mean (BIDS 1.11.1, Physiological recordings, Eye-tracking). A direction in
// the head's frame with the eye at its origin is "eye-in-head"; one direction for both eyes is "cyclopean".
#include "analysis/report/gaze.h"
#include "analysis/tools/bids_gaze.h"

#define HEAD "in the head's frame, the eye at its origin, 0 straight ahead"
#define CLOCK "The tracker's own clock, whose origin is the tracker's."

struct column {
    const char *name, *unit, *description;
};

static const struct column sample_columns[] = {
    {"timestamp", "ns", "When the tracker took the sample. " CLOCK},
    {"x_coordinate", "deg", "Direction of gaze to the right, " HEAD ": atan2(x, -z). n/a where not valid."},
    {"y_coordinate", "deg", "Direction of gaze upwards, " HEAD ": atan2(y, hypot(x, z)). n/a where not valid."},
    {"pupil_size", "mm", "Pupil diameter."},
    {"arrival", "s", "When the sample arrived: seconds since time 0 of the run, as onset in events.tsv."},
    {"valid", NULL, "Whether the tracker had a direction: 1 yes, 0 no."},
    {"confidence", NULL, "The tracker's confidence, 0 to 1."},
    {"trial_id", NULL, "The trial the sample belongs to; n/a between trials."},
    {"attempt", NULL,
     "Attempt at the trial, from 1; an interrupted trial begins anew with the next. n/a: of no trial, from "
     "before its first attempt, or of an interrupted attempt that is not known."},
    {NULL, NULL, NULL},
};

static const struct column event_columns[] = {
    {"onset", "ns", "Time of the first sample, as timestamp in the recording. " CLOCK},
    {"duration", "s", "From the first sample to the last one."},
    {"trial_type", NULL,
     "fixation or saccade; of an interrupted trial only those of its last attempt. Between trials there are "
     "some too."},
    {"x_coordinate", "deg", "A fixation's mean, a saccade's last sample, " HEAD "."},
    {"y_coordinate", "deg", "The same upwards."},
    {"amplitude", "deg", "Angle between a saccade's first and last sample; n/a for a fixation."},
    {"peak_velocity", "deg/s",
     "Of a saccade's fastest sample; n/a for a fixation, and where the samples are too far apart."},
    {"cut", NULL,
     "1: it lies at a gap or at a trial's end, so that duration and amplitude are lower bounds; 0: whole."},
    {"trial_id", NULL, "The trial it belongs to; n/a between trials."},
    {NULL, NULL, NULL},
};

void bids_recording_name(const struct bids *bids, size_t run, size_t eye, const char *suffix,
                         char out[BIDS_PATH_SIZE])
{
    char tail[64];
    snprintf(tail, sizeof tail, "recording-eye%zu_%s", eye + 1, suffix); // the labels BIDS recommends
    bids_run_name(bids, run, tail, out);
}

static void write_columns(struct json *json, const struct column *columns)
{
    json_open(json, "Columns", '[');
    for (const struct column *c = columns; c->name; c++)
        json_text(json, NULL, c->name);
    json_close(json, ']');
    for (const struct column *c = columns; c->name; c++) {
        json_open(json, c->name, '{');
        json_text(json, "Description", c->description);
        if (c->unit)
            json_text(json, "Units", c->unit);
        json_close(json, '}');
    }
}

static const char *task_of(const struct bids *b, size_t run)
{
    return b->tasks.items[b->sessions[b->runs[run].session].task].text;
}

static bool describe_samples(struct bids *b, size_t run, size_t eye, const struct bids_recording *recording,
                             double frequency_hz)
{
    static const char *const eyes[BIDS_EYES] = {"left", "right", "cyclopean"};
    char name[BIDS_PATH_SIZE], text[128];
    bids_recording_name(b, run, eye, "physio.json", name);
    FILE *out = bids_open(b, name);
    if (!out)
        return false;
    struct json json = {out, false};
    json_open(&json, NULL, '{');
    json_text(&json, "TaskName", task_of(b, run));
    json_text(&json, "PhysioType", "eyetrack");
    json_number(&json, "SamplingFrequency", frequency_hz);
    json_text(&json, "SamplingFrequencyOrigin",
              "As measured: the usual interval between samples on the tracker's clock.");
    json_number(&json, "StartTime", (double)recording->start_ns / 1e9);
    json_text(&json, "RecordedEye", eyes[eye]);
    json_text(&json, "SampleCoordinateSystem", "eye-in-head");
    snprintf(text, sizeof text, "fovstudy %s", b->runs[run].version);
    json_text(&json, "SoftwareVersions", text);
    write_columns(&json, sample_columns);
    json_close(&json, '}');
    fputc('\n', out);
    return bids_close(b, out, name);
}

static bool describe_events(struct bids *b, size_t run, size_t eye)
{
    struct gaze_options options = gaze_options(GAZE_IVT);
    char name[BIDS_PATH_SIZE], text[640];
    bids_recording_name(b, run, eye, "physioevents.json", name);
    FILE *out = bids_open(b, name);
    if (!out)
        return false;
    snprintf(text, sizeof text,
             "Fixations and saccades found by fovstats " FOVSTUDY_VERSION
             ", not by the tracker: I-VT (Salvucci & "
             "Goldberg 2000; Olsen 2012), saccades faster than %g deg/s over %g ms, fixations of at least %g "
             "ms; a peak velocity is over %g ms, at least between a sample's neighbours; where that is over "
             "more than %g ms, as of slow trackers "
             "and beside missing samples, it is n/a.",
             options.rules.velocity_deg_s, options.rules.window_ms, options.rules.min_fixation_ms,
             options.rules.peak_ms, GAZE_VMAX_SPAN_MS);
    struct json json = {out, false};
    json_open(&json, NULL, '{');
    json_text(&json, "TaskName", task_of(b, run));
    json_text(&json, "Description", text);
    json_text(&json, "OnsetSource", "timestamp");
    write_columns(&json, event_columns);
    json_close(&json, '}');
    fputc('\n', out);
    return bids_close(b, out, name);
}

bool bids_describe_recording(struct bids *bids, size_t run, size_t eye, const struct bids_recording *recording,
                             double frequency_hz)
{
    return describe_samples(bids, run, eye, recording, frequency_hz) &&
           (recording->events == 0 || describe_events(bids, run, eye));
}
