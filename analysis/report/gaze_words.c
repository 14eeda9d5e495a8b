// What the page and the tables say of rates and peaks in words.
#include "analysis/report/gaze.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

bool gaze_sequence_problem(const struct gaze_record *record, enum gaze_part part, char out[GAZE_REASON_SIZE])
{
    const struct stat_main_sequence *m = &record->main_sequence;
    const char *problem = part == GAZE_POWER ? m->power_problem : m->problem;
    if (isnan(record->span_ms))
        snprintf(out, GAZE_REASON_SIZE, "the tracker's rate cannot be measured");
    else if (record->span_ms > (part == GAZE_VMAX ? GAZE_VMAX_SPAN_MS : GAZE_SHAPE_SPAN_MS))
        snprintf(out, GAZE_REASON_SIZE, "at %.0f Hz a peak is taken over %.0f ms", record->span_hz,
                 record->span_ms);
    else if (m->n < STAT_MAIN_SEQUENCE_LEAST && record->quality.saccade_ms.n >= STAT_MAIN_SEQUENCE_LEAST)
        snprintf(out, GAZE_REASON_SIZE,
                 "samples are missing at the peaks of all but %zu of %" PRId64 " saccades", m->n,
                 record->quality.saccade_ms.n);
    else
        snprintf(out, GAZE_REASON_SIZE, "%s", problem ? problem : "");
    return out[0] != '\0';
}

void gaze_sequence_remark(const struct gaze_record *record, char out[GAZE_WORDS_SIZE])
{
    char vmax[GAZE_REASON_SIZE], c[GAZE_REASON_SIZE], power[GAZE_REASON_SIZE];
    gaze_sequence_problem(record, GAZE_VMAX, vmax);
    gaze_sequence_problem(record, GAZE_C, c);
    gaze_sequence_problem(record, GAZE_POWER, power);
    const char *first = vmax[0] ? "Vmax, c" : "c", *why = vmax[0] ? vmax : c;
    bool same = why[0] && strcmp(why, power) == 0;
    size_t used = 0;
    out[0] = '\0';
    if (why[0])
        used =
            (size_t)snprintf(out, GAZE_WORDS_SIZE, "%s%s not estimable: %s", first, same ? ", k, b" : "", why);
    if (power[0] && !same && used < GAZE_WORDS_SIZE)
        snprintf(out + used, GAZE_WORDS_SIZE - used, "%sk, b not estimable: %s", used ? "; " : "", power);
}

static void range(const char *format, double low, double high, char *out, size_t size)
{
    char from[32], to[32];
    snprintf(from, sizeof from, format, low);
    snprintf(to, sizeof to, format, high);
    if (low < high)
        snprintf(out, size, "%s to %s", from, to);
    else
        snprintf(out, size, "%s", from);
}

void gaze_rate_words(const struct gaze_record *record, char out[GAZE_REASON_SIZE])
{
    out[0] = '\0';
    if (!isnan(record->rate_hz))
        snprintf(out, GAZE_REASON_SIZE, "%.1f", record->rate_hz);
    else if (!isnan(record->slowest_hz))
        range("%.1f", record->slowest_hz, record->fastest_hz, out, GAZE_REASON_SIZE);
}

void gaze_sequence_words(const struct gaze_report *report, char out[GAZE_WORDS_SIZE])
{
    double span[2] = {NAN, NAN}, hz[2] = {NAN, NAN};
    char spans[80], rates[80], at[200] = "";
    int64_t complete = 0, known = 0;
    for (size_t i = 0; i < report->record_count; i++) {
        const struct gaze_record *r = &report->records[i];
        span[0] = fmin(span[0], r->span_ms);
        span[1] = fmax(span[1], r->span_ms);
        hz[0] = fmin(hz[0], r->span_hz);
        hz[1] = fmax(hz[1], r->span_hz);
    }
    if (!isnan(span[0])) {
        range("%.1f", span[0], span[1], spans, sizeof spans);
        range("%.0f", hz[0], hz[1], rates, sizeof rates);
        snprintf(at, sizeof at, ": here over %s ms, at %s Hz", spans, rates);
    }
    for (size_t i = 0; i < report->person_count; i++) {
        complete += report->people[i].quality.saccade_ms.n;
        known += (int64_t)report->people[i].saccade_count;
    }
    snprintf(
        out, GAZE_WORDS_SIZE,
        "A peak is the velocity between the samples at most %g ms before and after the fastest one, at "
        "least its neighbours%s. Of simulated saccades (Vmax 400 to 700 deg/s, c 4 to 7 deg, noise up to 0.1 "
        "deg) Vmax was right to 10 %% where that time was at most %g ms, and c, k and b to 16 %% where it was "
        "at "
        "most %g ms; the intervals do not contain this. Over longer times they are not estimable, and a "
        "saccade whose peak is over a longer time than its tracker's rate gives, since samples are missing "
        "there, is left out: %" PRId64 " of %" PRId64 " complete saccades are in.",
        report->options.rules.peak_ms / 2, at, GAZE_VMAX_SPAN_MS, GAZE_SHAPE_SPAN_MS, known, complete);
}
