// fovstats gaze as tables.
#include "analysis/tools/gaze_parts.h"

#include "analysis/tools/study_arguments.h"
#include "analysis/tools/table.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void number(struct table *t, const char *format, double value)
{
    if (isnan(value))
        table_cell(t, "-");
    else
        table_cell(t, format, value);
}

static void rate(struct table *t, const struct gaze_record *r)
{
    char words[GAZE_REASON_SIZE];
    gaze_rate_words(r, words);
    table_cell(t, "%s", words[0] ? words : "-");
}

static void who(struct table *t, const struct sample *sample, const struct gaze_record *r)
{
    table_cell(t, "%s", sample->people[r->person].code);
    if (r->session != SAMPLE_NONE)
        table_cell(t, "%" PRId64, sample->sessions[r->session].id);
    table_cell(t, "%s", gaze_eye_words(r->eye));
}

// Prints and frees.
static bool end_table(struct table *t, const char *title)
{
    printf("%s\n", title);
    bool ok = table_print(t, stdout);
    table_finish(t);
    putchar('\n');
    return ok;
}

static bool print_quality(const struct sample *sample, const struct gaze_record *records, size_t count,
                          double share, bool of_sessions)
{
    const char *const headings[] = {"<participant", "<eye", "samples", "Hz",    "not valid %", "missing %",
                                    "accuracy",     "x",    "y",       "RMS h", "RMS v",       "RMS",
                                    "SD h",         "SD v", "SD",      "BCEA",  NULL};
    const char *const with[] = {"<participant", "session",  "<eye",  "samples", "Hz",  "not valid %",
                                "missing %",    "accuracy", "RMS h", "RMS v",   "RMS", "SD h",
                                "SD v",         "SD",       "BCEA",  NULL};
    struct table t;
    table_init(&t, of_sessions ? with : headings);
    for (size_t i = 0; i < count; i++) {
        const struct gaze_quality *q = &records[i].quality;
        const struct gaze_target *accuracy = gaze_accuracy(&records[i]);
        who(&t, sample, &records[i]);
        table_cell(&t, "%" PRId64, q->samples);
        rate(&t, &records[i]);
        number(&t, "%.2f", q->samples ? 100 * (double)q->invalid / (double)q->samples : (double)NAN);
        number(&t, "%.2f", 100 * records[i].missing / gaze_due(&records[i]));
        number(&t, "%.2f", accuracy ? accuracy->error.mean : (double)NAN);
        if (!of_sessions) {
            number(&t, "%+.2f", accuracy ? accuracy->offset.mean_x : (double)NAN);
            number(&t, "%+.2f", accuracy ? accuracy->offset.mean_y : (double)NAN);
        }
        number(&t, "%.3f", gaze_quality_rms_x(q));
        number(&t, "%.3f", gaze_quality_rms_y(q));
        number(&t, "%.3f", gaze_quality_rms(q));
        number(&t, "%.3f", gaze_spread_sd_x(&q->within));
        number(&t, "%.3f", gaze_spread_sd_y(&q->within));
        number(&t, "%.3f", gaze_spread_sd(&q->within));
        number(&t, "%.3f", gaze_spread_bcea(&q->within, share));
    }
    return end_table(&t, of_sessions ? "Quality per session, degrees (BCEA: square degrees)"
                                     : "Quality per person, degrees (BCEA: square degrees)");
}

static bool print_events(const struct sample *sample, const struct gaze_report *gaze)
{
    const char *const headings[] = {"<participant", "<eye",     "fixations", "M ms",   "SD ms",
                                    "cut",          "saccades", "M deg",     "SD deg", "M ms",
                                    "peak deg/s",   "cut",      NULL};
    bool saccades = gaze->options.rules.method == GAZE_IVT;
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < gaze->person_count; i++) {
        const struct gaze_quality *q = &gaze->people[i].quality;
        who(&t, sample, &gaze->people[i]);
        table_cell(&t, "%" PRId64, q->fixation_ms.n + q->fixations_cut);
        number(&t, "%.1f", gaze_running_mean(&q->fixation_ms));
        number(&t, "%.1f", gaze_running_sd(&q->fixation_ms));
        table_cell(&t, "%" PRId64, q->fixations_cut);
        if (saccades)
            table_cell(&t, "%" PRId64, q->saccade_ms.n + q->saccades_cut);
        else
            table_cell(&t, "-");
        number(&t, "%.2f", gaze_running_mean(&q->amplitude_deg));
        number(&t, "%.2f", gaze_running_sd(&q->amplitude_deg));
        number(&t, "%.1f", gaze_running_mean(&q->saccade_ms));
        number(&t, "%.0f", gaze_running_mean(&q->peak_deg_s));
        if (saccades)
            table_cell(&t, "%" PRId64, q->saccades_cut);
        else
            table_cell(&t, "-");
    }
    return end_table(&t, "Fixations and saccades; means are of those that are not cut");
}

static void interval(struct table *t, const char *format, double low, double high)
{
    char a[32], b[32];
    snprintf(a, sizeof a, format, low);
    snprintf(b, sizeof b, format, high);
    if (isnan(low) || isnan(high))
        table_cell(t, "-");
    else
        table_cell(t, "%s to %s", a, b);
}

// A sentence in lines of at most 110 letters.
static void print_folded(const char *text)
{
    enum { WIDTH = 110 };
    while (strlen(text) > WIDTH) {
        int end = WIDTH;
        while (end > 0 && text[end] != ' ')
            end--;
        end = end > 0 ? end : WIDTH;
        printf("%.*s\n", end, text);
        text += end + (text[end] == ' ');
    }
    puts(text);
}

static bool print_sequences(const struct sample *sample, const struct gaze_report *gaze,
                            const struct gaze_over *over)
{
    char ci[32], words[GAZE_WORDS_SIZE];
    snprintf(ci, sizeof ci, "%g %% CI", 100 * gaze->options.conf);
    const char *const headings[] = {
        "<participant", "<eye", "saccades", "of", "Vmax", ci, "c", ci, "k", ci, "b", ci, "<", NULL};
    struct table t;
    table_init(&t, headings);
    for (size_t i = 0; i < gaze->person_count; i++) {
        const struct stat_main_sequence *m = &gaze->people[i].main_sequence;
        who(&t, sample, &gaze->people[i]);
        table_cell(&t, "%zu", m->n);
        table_cell(&t, "%" PRId64, gaze->people[i].quality.saccade_ms.n);
        number(&t, "%.0f", m->vmax.value);
        interval(&t, "%.0f", m->vmax.low, m->vmax.high);
        number(&t, "%.2f", m->c.value);
        interval(&t, "%.2f", m->c.low, m->c.high);
        number(&t, "%.1f", m->k.value);
        interval(&t, "%.1f", m->k.low, m->k.high);
        number(&t, "%.3f", m->b.value);
        interval(&t, "%.3f", m->b.low, m->b.high);
        gaze_sequence_remark(&gaze->people[i], words);
        table_cell(&t, "%s", words);
    }
    bool ok = end_table(&t, "Main sequence: V = Vmax (1 - exp(-A / c)) and V = k A^b; deg/s and degrees");
    for (size_t i = 0; i < over->sequence_count; i++) {
        const struct gaze_over_sequence *s = &over->sequences[i];
        printf("Over %zu people (eye: %s): Vmax %.0f [%.0f, %.0f] deg/s", s->vmax.n, gaze_eye_words(s->eye),
               s->vmax.mean, s->vmax_t.ci_low, s->vmax_t.ci_high);
        if (s->c.n > 1)
            printf("; over %zu: c %.2f [%.2f, %.2f] deg", s->c.n, s->c.mean, s->c_t.ci_low, s->c_t.ci_high);
        puts(".");
    }
    gaze_sequence_words(gaze, words);
    print_folded(words);
    putchar('\n');
    return ok;
}

static bool print_targets(const struct sample *sample, const struct gaze_report *gaze,
                          const struct gaze_over *over)
{
    const char *const headings[] = {"<participant", "<eye",   "<target", "samples",   "M",
                                    "SD",           "median", "outside", "not known", NULL};
    struct table t;
    int64_t flat = gaze_flat_samples(gaze);
    if (over->target_count == 0 && flat == 0)
        puts("No trial that counts had a fixation target: accuracy and distance to it are not estimable.\n");
    if (flat)
        printf(
            "Samples of one eye that cannot be compared with the target, since the file (of an older version)\n"
            "does not tell how far away it was: %" PRId64
            ". Accuracy and distance are not estimable by them.\n\n",
            flat);
    if (over->target_count == 0)
        return true;
    table_init(&t, headings);
    for (size_t i = 0; i < gaze->person_count; i++)
        for (size_t j = 0; j < gaze->people[i].target_count; j++) {
            const struct gaze_target *target = &gaze->people[i].targets[j];
            who(&t, sample, &gaze->people[i]);
            table_cell(&t, "%s", target->fixation);
            table_cell(&t, "%" PRId64, target->samples);
            number(&t, "%.2f", gaze_running_mean(&target->distance));
            number(&t, "%.2f", gaze_running_sd(&target->distance));
            number(&t, "%.2f", gaze_bins_quantile(&target->distances, 0.5));
            table_cell(&t, "%" PRId64, target->outside);
            table_cell(&t, "%" PRId64, target->unknown);
        }
    bool ok = end_table(&t, "Distance to the fixation target, degrees");
    for (size_t i = 0; i < over->target_count; i++) {
        const struct gaze_over_target *o = &over->targets[i];
        printf("%s: all samples M %.2f, SD %.2f, median %.2f deg; ", o->fixation,
               gaze_running_mean(&o->samples), gaze_running_sd(&o->samples), o->median);
        if (isnan(o->t.ci_low))
            printf("over people not estimable (n = %zu).\n", o->people.n);
        else
            printf("over %zu people M %.2f [%.2f, %.2f], SD %.2f.\n", o->people.n, o->people.mean, o->t.ci_low,
                   o->t.ci_high, o->people.sd);
    }
    printf("Here samples within %g deg left and right and %g deg up and down count (Weier et al. 2016, "
           "4.2.2).\n\n",
           gaze->options.region_x_deg, gaze->options.region_y_deg);
    return ok;
}

static bool print_latencies(const struct sample *sample, const struct gaze_report *gaze)
{
    const char *const headings[] = {"<participant", "session",      "frames", "age p50", "p95",
                                    "p99",          "to light p50", "p95",    "p99",     "estimated",
                                    "not known",    "lost",         NULL};
    struct table t;
    if (gaze->latency_count == 0)
        return true;
    table_init(&t, headings);
    for (size_t i = 0; i < gaze->latency_count; i++) {
        const struct gaze_latency *l = &gaze->latencies[i];
        const struct gaze_bins *bins[] = {&l->age, &l->to_light};
        table_cell(&t, "%s", sample->people[sample->sessions[l->session].person].code);
        table_cell(&t, "%" PRId64, sample->sessions[l->session].id);
        table_cell(&t, "%" PRId64, l->frames);
        for (int j = 0; j < 2; j++) {
            number(&t, "%.1f", gaze_bins_quantile(bins[j], 0.5));
            number(&t, "%.1f", gaze_bins_quantile(bins[j], 0.95));
            number(&t, "%.1f", gaze_bins_quantile(bins[j], 0.99));
        }
        table_cell(&t, "%" PRId64, l->estimated);
        table_cell(&t, "%" PRId64, l->unknown);
        table_cell(&t, "%" PRId64, l->lost);
    }
    bool ok = end_table(
        &t, "Age of the gaze in stimulus frames that followed it, ms: from the sample's arrival to the "
            "start of work, and to light\n(time of light: as the display reported it, or estimated)");
    int64_t all, lost = gaze_lost_frames(gaze, &all);
    if (lost)
        printf("Stimulus frames that should follow the gaze and had none: %" PRId64 " of %" PRId64 ".\n\n",
               lost, all);
    return ok;
}

static bool print_checks(const struct sample *sample, const struct gaze_report *gaze)
{
    const char *const headings[] = {"<participant", "session", "<block", "<eye",   "x",       "y",
                                    "accuracy",     "RMS-S2S", "SD",     "loss %", "<passed", NULL};
    struct table t;
    if (gaze->check_count == 0)
        return true;
    table_init(&t, headings);
    for (size_t i = 0; i < gaze->check_count; i++) {
        const struct gaze_check *c = &gaze->checks[i];
        table_cell(&t, "%s", sample->people[sample->sessions[c->session].person].code);
        table_cell(&t, "%" PRId64, sample->sessions[c->session].id);
        table_cell(&t, "%s", c->block);
        table_cell(&t, "%s", gaze_eye_words(c->eye));
        number(&t, "%.1f", c->x_deg);
        number(&t, "%.1f", c->y_deg);
        number(&t, "%.2f", c->accuracy_deg);
        number(&t, "%.3f", c->rms_s2s_deg);
        number(&t, "%.3f", c->sd_deg);
        number(&t, "%.1f", 100 * c->loss);
        table_cell(&t, "%s", c->passed ? "yes" : "no");
    }
    return end_table(&t, "Independent checks of the tracker");
}

bool gaze_print_text(const struct sample *sample, const struct gaze_report *gaze, const struct gaze_over *over)
{
    study_title(sample, "Gaze");
    bool ok = gaze->record_count == 0 ||
              (print_quality(sample, gaze->people, gaze->person_count, gaze->options.bcea_share, false) &&
               (gaze->record_count == gaze->person_count ||
                print_quality(sample, gaze->records, gaze->record_count, gaze->options.bcea_share, true)) &&
               print_events(sample, gaze) &&
               (gaze->options.rules.method == GAZE_IDT || print_sequences(sample, gaze, over)) &&
               print_targets(sample, gaze, over));
    ok = ok && print_latencies(sample, gaze) && print_checks(sample, gaze);
    gaze_print_notes(sample, gaze);
    return ok;
}
