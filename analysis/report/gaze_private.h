// Shared by gaze*.c of this room only.
#ifndef ANALYSIS_REPORT_GAZE_PRIVATE_H
#define ANALYSIS_REPORT_GAZE_PRIVATE_H

#include "analysis/report/gaze.h"

bool gaze_record_init(struct gaze_record *record);
void gaze_record_finish(struct gaze_record *record);
// The kind's entry, made where it is new; NULL where memory ran out or there are GAZE_TARGETS others.
struct gaze_target *gaze_record_target(struct gaze_record *record, const char *fixation);
void gaze_record_close(struct gaze_record *record, const struct gaze_options *options);
bool gaze_record_join(struct gaze_record *to, const struct gaze_record *from);

// One file's gaze: fills records and silent.
bool gaze_read_samples(struct gaze_report *out, struct sample *sample, size_t file, char *error,
                       size_t error_size);
// All files' frames and checks: fills latencies; opens the files anew, since a reader belongs to one thread.
bool gaze_read_uses(struct gaze_report *out, const struct sample *sample, char *error, size_t error_size);

#endif
