// What the page says of the gaze in sentences: methods, checks of the tracker, limits exceeded.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

void report_gaze_limits(const struct report *r)
{
    const struct gaze_report *g = &r->gaze;
    FILE *out = r->out;
    size_t named = 0, failed = 0;
    struct gaze_running accuracy = {.n = 0};
    double worst = 0;
    for (size_t i = 0; i < g->check_count; i++) {
        failed += !g->checks[i].passed;
        if (isnan(g->checks[i].accuracy_deg))
            continue;
        gaze_running_add(&accuracy, g->checks[i].accuracy_deg);
        worst = fmax(worst, g->checks[i].accuracy_deg);
    }
    if (g->check_count)
        fprintf(out, "<p>Independent checks of the tracker at %zu point%s, %zu of them not passed.",
                g->check_count, g->check_count == 1 ? "" : "s", failed);
    if (accuracy.n)
        fprintf(out, " Mean distance from the points: %.2f\u00b0, at worst %.2f\u00b0.", accuracy.mean, worst);
    fputs(g->check_count ? "</p>\n" : "", out);
    for (size_t i = 0; i < g->silent_count; i++) {
        fputs("<p class=\"note\">", out);
        html_printf(
            out, "Session %" PRId64 " had a tracker and no sample in any trial: all its samples are missing.",
            r->sample->sessions[g->silent[i].session].id);
        fputs("</p>\n", out);
    }
    for (size_t i = 0; i < r->sample->exclusion_count; i++) {
        const struct sample_exclusion *e = &r->sample->exclusions[i];
        if (strncmp(e->rule, "gaze_", 5) != 0)
            continue;
        fputs(named++ ? "" : "<p>The protocol\u2019s limits for the gaze were exceeded:</p>\n<ul>\n", out);
        fputs("<li>", out);
        html_printf(out, "%s, trial %" PRId64 ", %s (%s): %s", e->code, e->trial_id, e->rule, e->rule_set,
                    e->reason);
        fputs("</li>\n", out);
    }
    fputs(named ? "</ul>\n" : "", out);
}

void report_gaze_methods(const struct report *r)
{
    const struct gaze_options *o = &r->gaze.options;
    FILE *out = r->out;
    fputs("<p>", out);
    html_printf(
        out,
        "Degrees of visual angle in the head\u2019s frame, right and up positive; samples of the last attempt "
        "of each trial. Not valid: of the samples that came; missing: of those due at the measured rate. "
        "Accuracy: mean distance of all valid samples from a target at rest, wherever they lie and saccades "
        "included; of one eye, from where that eye sees the target. RMS from sample to sample, SD and BCEA "
        "(square degrees, P = %g, Crossland & Rubin 2002) within fixations, in trials without a moving target; "
        "where the eyes look freely, following slowly what moves counts as fixation. Saccades are faster than "
        "%g\u00b0/s over "
        "%g ms (I-VT, Salvucci & Goldberg 2000; Olsen 2012), fixations last %g ms or more; gaps over %g ms "
        "break them, and what touches one is cut: counted, not measured. ",
        o->bcea_share, o->rules.velocity_deg_s, o->rules.window_ms, o->rules.min_fixation_ms, o->gap_ms);
    fputs("Main sequence, of peak velocity V and amplitude A: V = V<sub>max</sub> (1 \u2212 e<sup>\u2212A / "
          "c</sup>) and "
          "V\u00a0=\u00a0k\u00a0A<sup>b</sup>. ",
          out);
    html_printf(
        out,
        "Distance to the target as Weier et al. 2016, section 4.2.2: samples within %g\u00b0 left and right "
        "and "
        "%g\u00b0 up and down. Age: from a sample\u2019s arrival to the start of work on the frame, and to "
        "light.",
        o->region_x_deg, o->region_y_deg);
    fputs("</p>\n", out);
}
