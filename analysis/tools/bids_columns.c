// What the columns mean: the dictionary of the Psych-DS export where a column stands there under the same name.
#include "analysis/tools/bids_private.h"
#include "analysis/tools/psych_ds.h"

#include <inttypes.h>
#include <string.h>

#define RUN "seconds since time 0 of the run, on the clock of the run (segment)"

static const struct psych_ds_column own[] = {
    {"onset", "Begin: " RUN ".", "s", NULL},
    {"duration", "How long it took.", "s", NULL},
    {"trial_type", "What happened.", NULL,
     "trial: the last attempt of a trial; exposure: a stretch of one option on the screen; adjust_step: a "
     "parameter was changed"},
    {"answer", "What was answered.", NULL,
     "choice; rating; response: a count or a final adjustment; staircase_step: the level that was shown and "
     "what came of it"},
    {"answer_time", "When the answer came: " RUN ".", "s", NULL},
    {"response_time", "From the moment an answer was allowed to the answer.", "s", NULL},
    {NULL, NULL, NULL, NULL},
};

static const struct psych_ds_column *find(const struct psych_ds_column *list, const char *name)
{
    while (list->name && strcmp(list->name, name) != 0)
        list++;
    return list->name ? list : NULL;
}

static bool is_condition(const char *name)
{
    size_t size = strlen(name);
    return (size >= 12 && strcmp(name + size - 12, "condition_id") == 0) || strcmp(name, "option_a") == 0 ||
           strcmp(name, "option_b") == 0;
}

static void write_conditions(const struct bids *bids, struct json *json)
{
    json_open(json, "Levels", '{');
    for (size_t i = 0; i < bids->condition_count; i++) {
        char id[32];
        snprintf(id, sizeof id, "%" PRId64, bids->conditions[i].id);
        json_text(json, id, bids->conditions[i].text);
    }
    json_close(json, '}');
}

void bids_describe(const struct bids *bids, struct json *json, const char *const *columns, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct psych_ds_column *column = find(own, columns[i]);
        if (!column)
            column = find(psych_ds_columns(), columns[i]);
        if (!column)
            continue;
        char text[512];
        snprintf(text, sizeof text, "%s%s%s%s", column->description, column->levels ? " Values: " : "",
                 column->levels ? column->levels : "", column->levels ? "." : "");
        json_open(json, columns[i], '{');
        json_text(json, "Description", text);
        if (column->unit)
            json_text(json, "Units", column->unit);
        if (is_condition(columns[i]))
            write_conditions(bids, json);
        json_close(json, '}');
    }
}
