// Every fixation and saccade, in the order they end.
#include "analysis/tools/gaze_parts.h"

#include "analysis/tools/study_arguments.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

bool gaze_events_begin(struct gaze_events *events)
{
    FILE *out = tmpfile();
    events->json = (struct json){out, false};
    if (!out)
        return false;
    if (!events->as_json) {
        fputs(
            "participant,session,trial,eye,kind,start_ns,duration_ms,x_deg,y_deg,amplitude_deg,peak_deg_s,cut,"
            "simulated\n",
            out);
        return true;
    }
    json_open(&events->json, NULL, '{');
    study_title_json(&events->json, events->sample);
    json_open(&events->json, "events", '[');
    return true;
}

static void field(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, "%.6g", value);
    fputc(',', out);
}

// A code may hold a comma or a quotation mark.
static void code_field(FILE *out, const char *code)
{
    fputc('"', out);
    for (; *code; code++) {
        if (*code == '"')
            fputc('"', out);
        fputc(*code, out);
    }
    fputs("\",", out);
}

static void csv_line(FILE *out, const struct sample *sample, const struct sample_session *session,
                     int64_t trial_id, char eye, const struct gaze_event *event)
{
    code_field(out, sample->people[session->person].code);
    fprintf(out, "%" PRId64 ",%" PRId64 ",%s,%s,%" PRId64 ",", session->id, trial_id, gaze_eye_words(eye),
            event->kind == GAZE_FIXATION ? "fixation" : "saccade", event->start_ns);
    field(out, (double)(event->end_ns - event->start_ns) / 1e6);
    field(out, event->x_deg);
    field(out, event->y_deg);
    field(out, event->amplitude_deg);
    field(out, event->peak_deg_s);
    fprintf(out, "%d,%d\n", event->cut, sample->simulated);
}

void gaze_events_each(void *user, size_t index, int64_t trial_id, char eye, const struct gaze_event *event)
{
    struct gaze_events *events = user;
    const struct sample_session *session = &events->sample->sessions[index];
    struct json *json = &events->json;
    if (!events->as_json) {
        csv_line(json->out, events->sample, session, trial_id, eye, event);
        return;
    }
    json_open(json, NULL, '{');
    json_text(json, "participant", events->sample->people[session->person].code);
    json_integer(json, "session", session->id);
    json_integer(json, "trial", trial_id);
    json_text(json, "eye", gaze_eye_words(eye));
    json_text(json, "kind", event->kind == GAZE_FIXATION ? "fixation" : "saccade");
    json_integer(json, "start_ns", event->start_ns);
    json_number(json, "duration_ms", (double)(event->end_ns - event->start_ns) / 1e6);
    json_number(json, "x_deg", event->x_deg);
    json_number(json, "y_deg", event->y_deg);
    json_number(json, "amplitude_deg", event->amplitude_deg);
    json_number(json, "peak_deg_s", event->peak_deg_s);
    json_bool(json, "cut", event->cut);
    json_close(json, '}');
}

bool gaze_events_end(struct gaze_events *events, bool print)
{
    FILE *out = events->json.out;
    if (events->as_json) {
        json_close(&events->json, ']');
        json_close(&events->json, '}');
        fputc('\n', out);
    }
    bool ok = fflush(out) == 0 && !ferror(out);
    rewind(out);
    char part[1 << 16];
    for (size_t size; ok && print && (size = fread(part, 1, sizeof part, out)) > 0;)
        fwrite(part, 1, size, stdout);
    ok = ok && !ferror(out);
    fclose(out);
    return ok;
}
