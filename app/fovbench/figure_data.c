#include "app/fovbench/figure_data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const figure_place[] = {"device", "scene", "width", "height", "gaze", "ssao", "taa", "rest", NULL};
const char *const figure_mode[] = {"mode", "parameters", NULL};

const char *figure_cell(const struct csv_table *table, size_t row, const char *column)
{
    return csv_cell(table, row, csv_column(table, column));
}

double figure_number(const struct csv_table *table, size_t row, const char *column)
{
    return csv_number(table, row, csv_column(table, column));
}

bool figure_same(const struct csv_table *table, size_t a, size_t b, const char *const *columns)
{
    for (; *columns; columns++)
        if (strcmp(figure_cell(table, a, *columns), figure_cell(table, b, *columns)) != 0)
            return false;
    return true;
}

size_t figure_groups(const struct csv_table *table, const char *const *columns, size_t out_rows[FIGURE_GROUPS])
{
    size_t count = 0;
    for (size_t row = 0; row < table->row_count && count < FIGURE_GROUPS; row++) {
        bool known = false;
        for (size_t i = 0; i < count && !known; i++)
            known = figure_same(table, row, out_rows[i], columns);
        if (!known)
            out_rows[count++] = row;
    }
    return count;
}

// The value of a parameter in the flat object of mode_parameters_json; NULL for none.
static const char *value_of(const char *parameters, const char *name, size_t *out_length)
{
    char key[FIGURE_TEXT];
    snprintf(key, sizeof key, "\"%s\":", name);
    const char *at = strstr(parameters, key);
    if (!at)
        return NULL;
    at += strlen(key);
    *out_length = strcspn(at, ",}");
    return at;
}

double figure_parameter(const struct csv_table *table, size_t row, const char *name)
{
    size_t length = 0;
    const char *value = value_of(figure_cell(table, row, "parameters"), name, &length);
    return value ? strtod(value, NULL) : (double)NAN;
}

static bool differs(const struct csv_table *table, size_t row, const char *name)
{
    static const char *const mode[] = {"mode", NULL};
    size_t own_length = 0, length = 0;
    const char *own = value_of(figure_cell(table, row, "parameters"), name, &own_length);
    for (size_t i = 0; i < table->row_count; i++) {
        const char *value = figure_same(table, i, row, mode)
                                ? value_of(figure_cell(table, i, "parameters"), name, &length)
                                : NULL;
        if (value && (length != own_length || strncmp(value, own, length) != 0))
            return true;
    }
    return false;
}

void figure_mode_name(const struct csv_table *table, size_t row, char out[FIGURE_TEXT])
{
    const char *at = figure_cell(table, row, "parameters");
    snprintf(out, FIGURE_TEXT, "%s", figure_cell(table, row, "mode"));
    while ((at = strchr(at, '"'))) {
        char name[64];
        size_t length = strcspn(at + 1, "\""), value_length = 0;
        snprintf(name, sizeof name, "%.*s", (int)length, at + 1);
        const char *value = value_of(at, name, &value_length);
        if (!value)
            return;
        if (differs(table, row, name)) {
            int quote = value[0] == '"';
            size_t used = strlen(out);
            snprintf(out + used, FIGURE_TEXT - used, " %s=%.*s", name, (int)value_length - 2 * quote,
                     value + quote);
        }
        at = value + value_length;
    }
}

void figure_place_name(const struct csv_table *table, size_t row, char out[FIGURE_TEXT])
{
    snprintf(out, FIGURE_TEXT, "%s, %sx%s, gaze %s%s%s%s", figure_cell(table, row, "scene"),
             figure_cell(table, row, "width"), figure_cell(table, row, "height"),
             figure_cell(table, row, "gaze"), figure_number(table, row, "ssao") > 0 ? ", SSAO" : "",
             figure_number(table, row, "taa") > 0 ? ", TAA" : "",
             figure_number(table, row, "rest") > 0 ? ", at rest" : "");
}
