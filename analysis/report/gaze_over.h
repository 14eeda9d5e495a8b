// What a gaze report says over people: each counts once, both eyes together where a target is concerned.
#ifndef ANALYSIS_REPORT_GAZE_OVER_H
#define ANALYSIS_REPORT_GAZE_OVER_H

#include "analysis/report/gaze.h"
#include "analysis/stats/moments.h"
#include "analysis/stats/ttest.h"

struct gaze_over_target {
    const char *fixation;
    // Of all samples together, as Weier et al. 2016 report it; neither SD nor median is one of people.
    struct gaze_running samples;
    double median; // to 0.01 degrees; infinite beyond 60
    // Of people's means.
    struct stat_moments people;
    struct stat_ttest t; // its interval is the mean's
};

struct gaze_over_sequence {
    char eye;
    struct stat_moments vmax, c; // of people whose own are estimable; fewer may have a c
    struct stat_ttest vmax_t, c_t;
};

enum { GAZE_EYES = 3 };

struct gaze_over {
    size_t target_count, sequence_count;
    struct gaze_over_target targets[GAZE_TARGETS];
    struct gaze_over_sequence sequences[GAZE_EYES];
};

bool gaze_over_people(struct gaze_over *out, const struct gaze_report *report); // false where memory ran out

#endif
