// The outputs of fovstats gaze; shared by gaze*.c of this room only.
#ifndef ANALYSIS_TOOLS_GAZE_PARTS_H
#define ANALYSIS_TOOLS_GAZE_PARTS_H

#include "analysis/report/gaze_over.h"
#include "analysis/tools/json.h"

bool gaze_print_text(const struct sample *sample, const struct gaze_report *gaze, const struct gaze_over *over);
void gaze_print_notes(const struct sample *sample, const struct gaze_report *gaze);
void gaze_print_json(const struct sample *sample, const struct gaze_report *gaze, const struct gaze_over *over);

// Events as they are found, in CSV or as an array of JSON objects. They wait in a file without a name until all
// are known: of a study that turns out to be damaged nothing is printed.
struct gaze_events {
    const struct sample *sample;
    bool as_json;
    struct json json; // its file is the waiting one
};
bool gaze_events_begin(struct gaze_events *events); // false where there is no room for that file
void gaze_events_each(void *user, size_t session, int64_t trial_id, char eye, const struct gaze_event *event);
// Prints them to stdout where `print` is true; false where they could not be kept.
bool gaze_events_end(struct gaze_events *events, bool print);

#endif
