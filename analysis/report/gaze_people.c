// People's records: their sittings' together, at the rate of each.
#include "analysis/report/gaze_private.h"

#include <math.h>
#include <stdlib.h>

// Sittings whose rates differ by no more are of one tracker, which is as exact as a rate measured with errors
// of time and losses is.
#define SAME_RATE 1.02

static int eye_order(char eye)
{
    return eye == 'l' ? 0 : eye == 'r' ? 1 : 2;
}

static int by_session(const void *x, const void *y)
{
    const struct gaze_record *a = x, *b = y;
    if (a->session != b->session)
        return a->session < b->session ? -1 : 1;
    return eye_order(a->eye) - eye_order(b->eye);
}

static int by_person(const void *x, const void *y)
{
    const struct gaze_record *a = x, *b = y;
    if (a->person != b->person)
        return a->person < b->person ? -1 : 1;
    return eye_order(a->eye) - eye_order(b->eye);
}

// --- sittings without a sample ---

static struct gaze_record *record_for(struct gaze_report *out, size_t person, size_t session, char eye)
{
    for (size_t i = 0; i < out->record_count; i++)
        if (out->records[i].session == session && out->records[i].eye == eye)
            return &out->records[i];
    if (!sample_grow(&out->records, out->record_count, sizeof out->records[0]))
        return NULL;
    struct gaze_record *record = &out->records[out->record_count];
    *record = (struct gaze_record){.person = person, .session = session, .eye = eye};
    if (!gaze_record_init(record))
        return NULL;
    out->record_count++;
    return record;
}

// The person's eyes were recorded in other sittings, so that in this one all samples are missing.
static bool add_silent(struct gaze_report *out, const struct sample *sample, const struct gaze_silent *silent)
{
    size_t person = sample->sessions[silent->session].person, count = out->record_count;
    bool done[3] = {false, false, false};
    for (size_t i = 0; i < count; i++) {
        char eye = out->records[i].eye;
        if (out->records[i].person != person || !out->records[i].quality.samples || done[eye_order(eye)])
            continue;
        struct gaze_record *record = record_for(out, person, silent->session, eye);
        if (!record)
            return false;
        gaze_bins_join(&record->edges, &silent->time);
        done[eye_order(eye)] = true;
    }
    return true;
}

// --- people ---

static struct gaze_record *person_record(struct gaze_report *out, const struct gaze_record *of)
{
    for (size_t i = 0; i < out->person_count; i++)
        if (out->people[i].person == of->person && out->people[i].eye == of->eye)
            return &out->people[i];
    if (!sample_grow(&out->people, out->person_count, sizeof out->people[0]))
        return NULL;
    struct gaze_record *record = &out->people[out->person_count];
    *record = (struct gaze_record){.person = of->person,
                                   .session = SAMPLE_NONE,
                                   .eye = of->eye,
                                   .slowest_hz = NAN,
                                   .fastest_hz = NAN,
                                   .span_ms = NAN,
                                   .span_hz = NAN};
    if (!gaze_record_init(record))
        return NULL;
    out->person_count++;
    return record;
}

static bool measure_rates(struct gaze_report *out)
{
    for (size_t i = 0; i < out->record_count; i++) {
        struct gaze_record *record = &out->records[i], *person = person_record(out, record);
        if (!person)
            return false;
        record->rate_hz = 1000 / gaze_quality_interval(&record->quality);
        record->slowest_hz = record->fastest_hz = record->rate_hz;
        person->slowest_hz = fmin(person->slowest_hz, record->rate_hz);
        person->fastest_hz = fmax(person->fastest_hz, record->rate_hz);
    }
    for (size_t i = 0; i < out->person_count; i++) {
        struct gaze_record *person = &out->people[i];
        double samples = 0, sum = 0;
        for (size_t j = 0; j < out->record_count; j++) {
            const struct gaze_record *r = &out->records[j];
            if (r->person == person->person && r->eye == person->eye && !isnan(r->rate_hz)) {
                samples += (double)r->quality.samples;
                sum += (double)r->quality.samples * r->rate_hz;
            }
        }
        bool one = person->fastest_hz <= SAME_RATE * person->slowest_hz;
        person->rate_hz = one ? sum / samples : (double)NAN;
    }
    return true;
}

static double nominal_of(const struct gaze_report *out, double rate_hz)
{
    return out->options.rate_hz > 0 ? out->options.rate_hz : rate_hz;
}

// A fit to peaks taken over too long a time is no estimate.
static void fit_sequence(struct gaze_record *person, double conf)
{
    const struct stat_estimate none = {NAN, NAN, NAN, NAN};
    struct stat_main_sequence m =
        stat_main_sequence(person->amplitude, person->peak, person->saccade_count, conf);
    if (!(person->span_ms <= GAZE_VMAX_SPAN_MS)) {
        m.vmax = none;
        m.residual_sd = NAN;
    }
    if (!(person->span_ms <= GAZE_SHAPE_SPAN_MS))
        m.c = m.k = m.b = none;
    person->main_sequence = m;
}

static bool add_sittings(struct gaze_report *out)
{
    for (size_t i = 0; i < out->record_count; i++) {
        struct gaze_record *record = &out->records[i], *person = person_record(out, record);
        double rate_hz = isnan(record->rate_hz) ? person->rate_hz : record->rate_hz;
        record->nominal_hz = nominal_of(out, rate_hz);
        gaze_record_close(record, &out->options);
        person->missing += record->missing; // each sitting's at its own rate
        if (!gaze_record_join(person, record))
            return false;
    }
    for (size_t i = 0; i < out->person_count; i++) {
        out->people[i].nominal_hz = nominal_of(out, out->people[i].rate_hz);
        fit_sequence(&out->people[i], out->options.conf);
    }
    return true;
}

bool gaze_join_people(struct gaze_report *out, const struct sample *sample)
{
    for (size_t i = 0; i < out->silent_count; i++)
        if (!add_silent(out, sample, &out->silent[i]))
            return false;
    if (!measure_rates(out) || !add_sittings(out))
        return false;
    if (out->record_count > 1)
        qsort(out->records, out->record_count, sizeof out->records[0], by_session);
    if (out->person_count > 1)
        qsort(out->people, out->person_count, sizeof out->people[0], by_person);
    return true;
}
