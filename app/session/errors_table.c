#include "app/session/errors_table.h"

#include "renderer/mode.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 1024, LINES = 4096 };

struct known {
    char *place;  // SPEC or SCENE, then ";" and the settings that follow "wrmse" in the metric; owned
    bool by_name; // of a line
    struct mode_choice choice;
    double error;
};

struct errors_table {
    struct known *rows; // owned
    size_t count, capacity;
};

static bool add(struct errors_table *table, const char *scene, const char *settings, const struct known *known)
{
    if (table->count == table->capacity) {
        size_t capacity = table->capacity ? 2 * table->capacity : 64;
        struct known *rows = realloc(table->rows, capacity * sizeof *rows);
        if (!rows)
            return false;
        table->rows = rows;
        table->capacity = capacity;
    }
    struct known *row = &table->rows[table->count];
    size_t size = strlen(scene) + strlen(settings) + 1;
    *row = *known;
    row->place = malloc(size);
    if (!row->place)
        return false;
    snprintf(row->place, size, "%s%s", scene, settings);
    table->count++;
    return true;
}

// --- the study file ---

// Whether the metric is ours; where its settings begin.
static const char *settings_of(const char *metric)
{
    static const char name[] = "wrmse";
    size_t length = sizeof name - 1;
    return strncmp(metric, name, length) == 0 && (!metric[length] || metric[length] == ';') ? metric + length
                                                                                            : NULL;
}

// {"epsilon":0.1,"splat":"atomic"} as MODE:epsilon=0.1,splat=atomic. False: not of this program's modes.
static bool parse_stored(const char *mode, const char *parameters, struct mode_choice *out)
{
    char spec[LINE + PLAN_JSON], why[256];
    int used = snprintf(spec, sizeof spec, "%s:", mode);
    if (used < 0 || strlen(parameters) + (size_t)used >= sizeof spec)
        return false;
    char *to = spec + used;
    for (const char *c = parameters; *c; c++)
        if (!strchr("{}\"", *c))
            *to++ = *c == ':' ? '=' : *c;
    *to = '\0';
    if (spec[used] == '\0')
        spec[used - 1] = '\0'; // no parameters
    return mode_parse(spec, out, why, sizeof why);
}

struct reading {
    struct errors_table *table;
    bool failed;
};

static bool take_stored(void *user, const struct store_measured *measured)
{
    struct reading *reading = user;
    struct known known = {.error = measured->value};
    const char *settings = settings_of(measured->metric);
    if (!settings || !parse_stored(measured->mode, measured->parameters, &known.choice))
        return true; // another program's; it is missed where it is needed
    reading->failed = !add(reading->table, measured->scene, settings, &known);
    return !reading->failed;
}

// --- the file of errors ---

static bool read_line(struct errors_table *table, const char *file, int number, char *text, char *error,
                      size_t error_size)
{
    char why[256] = "";
    struct known known = {.by_name = true};
    char *scene = text, *value = strchr(text, ','), *option = value ? strchr(value + 1, ',') : NULL,
         *end = NULL;
    if (!option) {
        snprintf(error, error_size, "%s:%d: a line is SCENE[;SETTING=VALUE...],ERROR,MODE[:p=v,...]", file,
                 number);
        return false;
    }
    *value++ = *option++ = '\0';
    known.error = strtod(value, &end);
    if (end == value || *end || !(known.error >= 0.0 && known.error <= 1.0)) {
        snprintf(error, error_size, "%s:%d: '%s' is no error; it is a number from 0 to 1 (black against white)",
                 file, number, value);
        return false;
    }
    if (!mode_parse(option, &known.choice, why, sizeof why)) {
        snprintf(error, error_size, "%s:%d: %s", file, number, why);
        return false;
    }
    if (add(table, scene, "", &known))
        return true;
    snprintf(error, error_size, "out of memory");
    return false;
}

static bool read_file(struct errors_table *table, const char *path, char *error, size_t error_size)
{
    char text[LINE];
    FILE *file = fopen(path, "r");
    if (!file) {
        snprintf(error, error_size, "the errors file '%s' cannot be read: %s", path, strerror(errno));
        return false;
    }
    bool good = true;
    int taken = 0;
    for (int number = 1; good && fgets(text, sizeof text, file); number++) {
        text[strcspn(text, "\r\n")] = '\0';
        if (!*text || *text == '#')
            continue;
        if (taken++ == LINES) {
            snprintf(error, error_size, "%s:%d: more than %d lines", path, number, LINES);
            good = false;
        } else {
            good = read_line(table, path, number, text, error, error_size);
        }
    }
    fclose(file);
    return good;
}

struct errors_table *errors_table_read(struct store *store, int64_t reference_id, const char *file, char *error,
                                       size_t error_size)
{
    struct store_error why;
    struct reading reading = {.table = calloc(1, sizeof *reading.table)};
    snprintf(error, error_size, "out of memory");
    if (!reading.table)
        return NULL;
    bool good = store_read_measured_errors(store, reference_id, take_stored, &reading, &why) == STORE_OK;
    if (!good)
        snprintf(error, error_size, "%s", why.text);
    if (good && !reading.failed && (!*file || read_file(reading.table, file, error, error_size)))
        return reading.table;
    errors_table_destroy(reading.table);
    return NULL;
}

void errors_table_destroy(struct errors_table *table)
{
    for (size_t i = 0; table && i < table->count; i++)
        free(table->rows[i].place);
    if (table)
        free(table->rows);
    free(table);
}

// --- what is known ---

static bool is_place(const struct known *known, const struct errors_place *place)
{
    const char *scene = known->by_name ? place->scene : place->spec;
    size_t length = strlen(scene);
    return strncmp(known->place, scene, length) == 0 &&
           strcmp(known->place + length, settings_of(place->metric)) == 0;
}

// Numbers that were written and read again differ by less.
static bool same_value(double a, double b)
{
    return fabs(a - b) <= 1e-9 * fmax(fabs(a), fabs(b));
}

// but: a parameter that may differ; parameter_count: none may.
static bool same_but(const struct mode_choice *a, const struct mode_choice *b, uint32_t but)
{
    if (a->mode != b->mode)
        return false;
    for (uint32_t i = 0; i < a->mode->parameter_count; i++)
        if (i != but && !same_value(a->values[i], b->values[i]))
            return false;
    return true;
}

double errors_table_find(const struct errors_table *table, const struct errors_place *place,
                         const struct mode_choice *choice)
{
    for (size_t i = 0; i < table->count; i++)
        if (same_but(&table->rows[i].choice, choice, MODE_PARAMETERS) && is_place(&table->rows[i], place))
            return table->rows[i].error;
    return (double)NAN;
}

// The nearest known row on one side of a value (at it counts as both).
struct side {
    double at, error;
    bool known;
};

static void take_side(struct side *side, double at, double error, bool nearer)
{
    if (!side->known || (nearer && !same_value(at, side->at)))
        *side = (struct side){at, error, true}; // the first of equals holds
}

double errors_table_between(const struct errors_table *table, const struct errors_place *place,
                            const struct mode_choice *choice, uint32_t parameter, double value,
                            uint32_t *out_count)
{
    struct side below = {0}, above = {0}, first = {0};
    uint32_t count = 0;
    for (size_t i = 0; i < table->count; i++) {
        const struct known *row = &table->rows[i];
        if (!same_but(&row->choice, choice, parameter) || !is_place(row, place))
            continue;
        double at = row->choice.values[parameter];
        count += !first.known || (count < 2 && !same_value(at, first.at));
        take_side(&first, at, row->error, false);
        if (at <= value || same_value(at, value))
            take_side(&below, at, row->error, at > below.at);
        if (at >= value || same_value(at, value))
            take_side(&above, at, row->error, at < above.at);
    }
    if (out_count)
        *out_count = count;
    if (count < 2)
        return (double)NAN;
    if (!below.known || !above.known)
        return below.known ? below.error : above.error;
    if (!(above.at > below.at))
        return below.error;
    return below.error + (above.error - below.error) * (value - below.at) / (above.at - below.at);
}
