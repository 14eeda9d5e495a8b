#include "studies/store/exclusions.h"

#include "studies/store/rows.h"
#include "studies/store/sql.h"

static enum store_result add(struct store *store, const struct store_exclusion *exclusion, size_t *added,
                             struct store_error *error)
{
    const struct sql_value values[] = {sql_id(exclusion->trial_id),       sql_id(exclusion->session_id),
                                       sql_id(exclusion->participant_id), sql_text(exclusion->rule),
                                       sql_text(exclusion->rule_set),     sql_text(exclusion->reason),
                                       sql_text(exclusion->by),           sql_text(exclusion->applied_at)};
    enum store_result result = sql_run(store, SQL_INSERT_NEW_EXCLUSION, values, countof(values), NULL, error);
    if (result == STORE_OK)
        *added += (size_t)sqlite3_changes(store->db);
    return result;
}

enum store_result store_apply_exclusions(struct store *store, const struct store_exclusion *exclusions,
                                         size_t count, const struct store_event *events, size_t event_count,
                                         size_t *out_added, struct store_error *error)
{
    size_t added = 0;
    enum store_result result = sql_begin(store, error);
    for (size_t i = 0; result == STORE_OK && i < count; i++)
        result = add(store, &exclusions[i], &added, error);
    for (size_t i = 0; result == STORE_OK && i < event_count; i++) {
        struct sql_value values[ROWS_EVENT_COLUMNS];
        rows_event(&events[i], events[i].kind, events[i].detail, values);
        result = sql_run(store, SQL_INSERT_EVENT, values, countof(values), NULL, error);
    }
    result = sql_end(store, result, error);
    *out_added = result == STORE_OK ? added : 0;
    return result;
}
