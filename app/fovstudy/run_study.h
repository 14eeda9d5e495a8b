// The parts of `fovstudy run` before the first frame: what is to be shown (study), where (view), and its rows.
//
// Each part is made by its init and freed by its finish, in the reverse order; finish of a zeroed part is fine.
// What can be refused is refused before the study file is opened, so that a mistake writes nothing.
#ifndef APP_FOVSTUDY_RUN_STUDY_H
#define APP_FOVSTUDY_RUN_STUDY_H

#include "app/display/display.h"
#include "app/fovstudy/run_options.h"
#include "app/gaze/gaze_source.h"
#include "app/session/record.h"
#include "app/session/stage.h"
#include "studies/engine/observer.h"
#include "studies/store/resume.h"
#include "studies/store/store.h"

enum { RUN_ERROR = 1024, RUN_JSON = 4096 };

// The protocol as read, and who answers.
struct run_study {
    struct study_names names;
    struct protocol *protocol;
    struct observer_parameters observer;
    char attributes[RUN_JSON]; // JSON object
    bool wrong_usage;          // what failed is a value of the command line
};
bool run_study_init(struct run_study *study, const struct run_options *options, char *error, size_t error_size);
// The same for a session that a study file holds; the options are complete.
bool run_study_init_stored(struct run_study *study, const struct run_options *options,
                           const struct store_session_start *start, char *error, size_t error_size);
void run_study_finish(struct run_study *study);

// Display, renderer and scenes; all zero with --display none but for the gaze source.
struct run_view {
    struct display *display;
    struct renderer *renderer;
    struct stage_scene scenes[PROTOCOL_SCENES]; // scene owned
    size_t scene_count;
    struct viewing_fov fov;
    struct gaze_source *gaze;
    const char *gaze_name;          // "none" where there is none
    char renderer_error[RUN_ERROR]; // the renderer's last error
};
// `seed` is the gaze's.
bool run_view_init(struct run_view *view, const struct run_options *options, const struct protocol *protocol,
                   char *error, size_t error_size);
bool run_view_gaze(struct run_view *view, const struct run_options *options, uint64_t seed, char *error,
                   size_t error_size);
void run_view_finish(struct run_view *view);

// The session in the study file.
struct run_rows {
    struct store *store;
    struct plan *plan;
    struct store_session_ids ids; // its arrays are owned
    int64_t reference_id;
    int64_t origin_ns;
    // Of a resumed session: where the machine begins; the arrays are owned.
    bool *done;
    uint32_t *attempts, *answers, *repeats;
    int32_t *outcomes;
    double (*adjusted)[PROTOCOL_ADJUSTED];
    uint32_t repeat_count, capacity;
    uint32_t done_count;
};
bool run_rows_open(struct run_rows *rows, const struct run_options *options, const struct run_study *study,
                   char *error, size_t error_size);
bool run_rows_create(struct run_rows *rows, const struct run_options *options, const struct run_study *study,
                     const struct run_view *view, char *error, size_t error_size);
// The segment of this run of the program, its texts in `words`; sets rows->origin_ns.
struct run_words {
    char now[RECORD_TIME], boot_id[64];
};
struct store_segment run_rows_segment(struct run_rows *rows, const struct run_view *view, const char *reason,
                                      struct run_words *words);
// A plan and room for its ids. False with a sentence.
bool run_rows_plan(struct run_rows *rows, const struct protocol *protocol, uint64_t seed, int64_t number,
                   char *error, size_t error_size);
bool run_rows_reference(struct run_rows *rows, const struct run_study *study, char *error, size_t error_size);
// False with a sentence where logs were lost at the end.
bool run_rows_finish(struct run_rows *rows, char *error, size_t error_size);

// The protocol's reference as an option to draw.
void run_reference(const struct protocol *protocol, struct mode_choice *out);

#endif
