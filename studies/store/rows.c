#include "studies/store/rows.h"
#include "studies/store/queue.h"

#include <math.h>

static enum store_result write_gaze(struct store *store, const struct queue_gaze *gaze,
                                    struct store_error *error)
{
    const struct gaze_sample *sample = &gaze->row.sample;
    const struct sql_value values[] = {
        sql_integer(gaze->id),      sql_id(gaze->row.session_id),   sql_id(gaze->row.segment_id),
        sql_id(gaze->row.trial_id), sql_integer(sample->device_ns), sql_integer(sample->host_ns),
        sql_eye(sample->eye),       sql_real(sample->x_deg),        sql_real(sample->y_deg),
        sql_real(sample->pupil_mm), sql_truth(sample->valid),       sql_real(sample->confidence)};
    return sql_run(store, SQL_INSERT_GAZE, values, countof(values), NULL, error);
}

// SQLite's printf: the same digits in every locale. JSON has no NaN and no infinity.
static void append_number(sqlite3_str *json, const char *before, double value)
{
    sqlite3_str_appendall(json, before);
    if (isfinite(value))
        sqlite3_str_appendf(json, "%!.12g", value);
    else
        sqlite3_str_appendall(json, "null");
}

// The text is SQLite's to free; NULL where there is no fovea.
static char *fovea_json(const struct store_frame *frame)
{
    const double(*fovea)[2] = frame->fovea_deg;
    if (isnan(fovea[EYE_LEFT][0]) && isnan(fovea[EYE_LEFT][1]) && isnan(fovea[EYE_RIGHT][0]) &&
        isnan(fovea[EYE_RIGHT][1]))
        return NULL;
    sqlite3_str *json = sqlite3_str_new(NULL);
    append_number(json, "{\"left\":[", fovea[EYE_LEFT][0]);
    append_number(json, ",", fovea[EYE_LEFT][1]);
    append_number(json, "],\"right\":[", fovea[EYE_RIGHT][0]);
    append_number(json, ",", fovea[EYE_RIGHT][1]);
    sqlite3_str_appendall(json, "]}");
    return sqlite3_str_finish(json);
}

static char *pose_json(const struct pose *pose)
{
    const struct dquat *q = &pose->orientation;
    if (!(fabs(q->x) + fabs(q->y) + fabs(q->z) + fabs(q->w) > 0))
        return NULL;
    sqlite3_str *json = sqlite3_str_new(NULL);
    append_number(json, "{\"position\":[", pose->position.x);
    append_number(json, ",", pose->position.y);
    append_number(json, ",", pose->position.z);
    append_number(json, "],\"orientation\":[", q->x);
    append_number(json, ",", q->y);
    append_number(json, ",", q->z);
    append_number(json, ",", q->w);
    sqlite3_str_appendall(json, "]}");
    return sqlite3_str_finish(json);
}

static const char *phase_word(enum store_phase phase)
{
    static const char *const words[] = {[STORE_STIMULUS] = "stimulus",
                                        [STORE_FADE] = "fade",
                                        [STORE_QUESTION] = "question",
                                        [STORE_REST] = "rest"};
    return (size_t)phase < countof(words) ? words[phase] : "?";
}

static const char *fovea_word(enum store_fovea fovea)
{
    static const char *const words[] = {[STORE_FOVEA_GAZE] = "gaze",
                                        [STORE_FOVEA_TARGET] = "target",
                                        [STORE_FOVEA_FIXED] = "fixed",
                                        [STORE_FOVEA_LOST] = "lost"};
    return (size_t)fovea < countof(words) ? words[fovea] : "?";
}

static enum store_result write_frame(struct store *store, const struct queue_log *entry,
                                     struct store_error *error)
{
    const struct store_frame *frame = &entry->row.frame;
    char *fovea = fovea_json(frame);
    char *pose = pose_json(&frame->head_pose);
    const struct sql_value values[] = {sql_id(frame->session_id),
                                       sql_id(frame->segment_id),
                                       sql_id(frame->trial_id),
                                       sql_id(frame->attempt),
                                       sql_integer((int64_t)frame->number),
                                       sql_slot(frame->option),
                                       sql_id(frame->condition_id),
                                       sql_text(phase_word(frame->phase)),
                                       sql_real(frame->fade_level),
                                       sql_integer(frame->start_ns),
                                       sql_real(frame->cpu_us),
                                       sql_real(frame->gpu_us),
                                       sql_integer(frame->present_ns),
                                       sql_truth(frame->present_estimated),
                                       sql_integer(frame->late),
                                       sql_id(frame->gaze_id),
                                       sql_real(frame->gaze_age_us),
                                       sql_text(fovea),
                                       sql_text(fovea_word(frame->fovea_source)),
                                       sql_text(entry->has_text ? entry->text : NULL),
                                       sql_real(frame->target_x_deg),
                                       sql_real(frame->target_y_deg),
                                       sql_text(pose),
                                       sql_integer(frame->shaded_px),
                                       sql_integer(frame->triangles),
                                       sql_real(frame->target_m)};
    enum store_result result = sql_run(store, SQL_INSERT_FRAME, values, countof(values), NULL, error);
    sqlite3_free(fovea);
    sqlite3_free(pose);
    return result;
}

static enum store_result write_exposure(struct store *store, const struct store_exposure *exposure,
                                        struct store_error *error)
{
    const struct sql_value values[] = {
        sql_id(exposure->trial_id),           sql_id(exposure->segment_id),      sql_id(exposure->attempt),
        sql_slot(exposure->option),           sql_integer(exposure->start_ns),   sql_integer(exposure->end_ns),
        sql_integer(exposure->full_start_ns), sql_integer(exposure->full_end_ns)};
    return sql_run(store, SQL_INSERT_EXPOSURE, values, countof(values), NULL, error);
}

static enum store_result write_adjust_step(struct store *store, const struct queue_log *entry,
                                           struct store_error *error)
{
    const struct store_adjust_step *step = &entry->row.adjust_step;
    const struct sql_value values[] = {sql_id(step->trial_id), sql_id(step->segment_id),
                                       sql_integer(step->at_ns), sql_text(entry->name), sql_real(step->value)};
    return sql_run(store, SQL_INSERT_ADJUST_STEP, values, countof(values), NULL, error);
}

void rows_event(const struct store_event *event, const char *kind, const char *detail,
                struct sql_value out[ROWS_EVENT_COLUMNS])
{
    out[0] = sql_id(event->session_id);
    out[1] = sql_id(event->segment_id);
    out[2] = sql_id(event->trial_id);
    out[3] = sql_integer(event->at_ns);
    out[4] = sql_text(kind);
    out[5] = sql_text(detail);
}

// Where a row belongs, for the event that reports it.
struct row_origin {
    const char *table;
    int64_t segment_id, at_ns;
};

static enum store_result write_log(struct store *store, const struct queue_log *entry,
                                   struct row_origin *out_origin, struct store_error *error)
{
    struct sql_value values[ROWS_EVENT_COLUMNS];
    switch (entry->kind) {
    case QUEUE_FRAME:
        *out_origin = (struct row_origin){"frame", entry->row.frame.segment_id, entry->row.frame.start_ns};
        return write_frame(store, entry, error);
    case QUEUE_EXPOSURE:
        *out_origin =
            (struct row_origin){"exposure", entry->row.exposure.segment_id, entry->row.exposure.start_ns};
        return write_exposure(store, &entry->row.exposure, error);
    case QUEUE_EVENT:
        *out_origin = (struct row_origin){"event", entry->row.event.segment_id, entry->row.event.at_ns};
        rows_event(&entry->row.event, entry->name, entry->has_text ? entry->text : NULL, values);
        return sql_run(store, SQL_INSERT_EVENT, values, countof(values), NULL, error);
    case QUEUE_ADJUST_STEP:
        *out_origin =
            (struct row_origin){"adjust_step", entry->row.adjust_step.segment_id, entry->row.adjust_step.at_ns};
        return write_adjust_step(store, entry, error);
    case QUEUE_KINDS:
        break;
    }
    return STORE_OK;
}

// The event needs a segment that exists; without one only the count in store_status tells.
static enum store_result report_refused(struct store *store, const struct row_origin *origin,
                                        const struct store_error *why, struct store_error *error)
{
    store->queue->span.refused++;
    const struct sql_value values[] = {sql_id(origin->segment_id), sql_integer(origin->at_ns),
                                       sql_text(origin->table), sql_text(why->text)};
    enum store_result result = sql_run(store, SQL_INSERT_REFUSED, values, countof(values), NULL, error);
    return result == STORE_REFUSED ? STORE_OK : result;
}

static enum store_result report_drops(struct store *store, struct store_error *error)
{
    const struct queue_drops *drops = &store->queue->span.drops;
    const struct sql_value values[] = {sql_id(drops->segment_id),
                                       sql_integer(drops->at_ns),
                                       sql_integer((int64_t)drops->gaze),
                                       sql_integer((int64_t)drops->log[QUEUE_FRAME]),
                                       sql_integer((int64_t)drops->log[QUEUE_EXPOSURE]),
                                       sql_integer((int64_t)drops->log[QUEUE_EVENT]),
                                       sql_integer((int64_t)drops->log[QUEUE_ADJUST_STEP])};
    uint64_t count = drops->gaze;
    for (int kind = 0; kind < QUEUE_KINDS; kind++)
        count += drops->log[kind];
    if (count == 0)
        return STORE_OK;
    enum store_result result = sql_run(store, SQL_INSERT_OVERFLOW, values, countof(values), NULL, error);
    return result == STORE_REFUSED ? STORE_OK : result;
}

enum store_result rows_write(struct store *store, struct store_error *error)
{
    struct queue *queue = store->queue;
    const struct queue_span *span = &queue->span;
    struct store_error why = {""};
    enum store_result result = STORE_OK;
    // Gaze first: a frame names a sample that was pushed before it.
    for (uint64_t i = span->gaze_tail; result == STORE_OK && i < span->gaze_head; i++) {
        const struct queue_gaze *gaze = &queue->gaze[i % queue->gaze_capacity];
        result = write_gaze(store, gaze, &why);
        if (result == STORE_REFUSED) {
            struct row_origin origin = {"gaze", gaze->row.segment_id, gaze->row.sample.host_ns};
            result = report_refused(store, &origin, &why, &why);
        }
    }
    for (uint64_t i = span->log_tail; result == STORE_OK && i < span->log_head; i++) {
        struct row_origin origin = {"", 0, 0};
        result = write_log(store, &queue->log[i % queue->log_capacity], &origin, &why);
        if (result == STORE_REFUSED)
            result = report_refused(store, &origin, &why, &why);
    }
    if (result == STORE_OK)
        result = report_drops(store, &why);
    if (result != STORE_OK)
        sql_say(error, "%s", why.text);
    return result;
}
