// Shared by gaze*.c of this room only.
#ifndef ANALYSIS_REPORT_GAZE_PRIVATE_H
#define ANALYSIS_REPORT_GAZE_PRIVATE_H

#include "analysis/report/gaze.h"
#include "studies/store/gaze.h"

bool gaze_record_init(struct gaze_record *record);
void gaze_record_finish(struct gaze_record *record);
// The kind's entry, made where it is new; NULL where memory ran out or there are GAZE_TARGETS others.
struct gaze_target *gaze_record_target(struct gaze_record *record, const char *fixation);
// Missing samples, spans and peaks, once nominal_hz is known.
void gaze_record_close(struct gaze_record *record, const struct gaze_options *options);
bool gaze_record_join(struct gaze_record *to, const struct gaze_record *from);
bool gaze_silent_init(struct gaze_silent *silent, size_t session);
// Fills people from records and silent; sorts both.
bool gaze_join_people(struct gaze_report *out, const struct sample *sample); // false where memory ran out

// Where the target of one trial was, frame by frame.
struct gaze_place;
struct gaze_places {
    struct gaze_place *all; // owned
    size_t count, at;
    bool no_memory;
};
bool gaze_places_read(struct gaze_places *places, struct store_reader *reader, int64_t trial_id);
void gaze_places_finish(struct gaze_places *places);
// Adds a valid sample to what is known of its target.
void gaze_compare(struct gaze_places *places, const struct gaze_options *options, double ipd_m,
                  const struct store_gaze_sample *row, struct gaze_target *target);

// One file's gaze: fills records and silent.
bool gaze_read_samples(struct gaze_report *out, struct sample *sample, size_t file, char *error,
                       size_t error_size);
// All files' frames and checks: fills latencies; opens the files anew, since a reader belongs to one thread.
bool gaze_read_uses(struct gaze_report *out, const struct sample *sample, char *error, size_t error_size);

#endif
