// Reading fovbench's CSV (RFC 4180). Files put together repeat their heading, which is passed over.
#include "analysis/report/bench_private.h"

#include "analysis/report/sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FIELDS = 128, LINE = 16384 };

enum column { DEVICE, SCENE, MODE, PARAMETERS, GPU_MS, PSNR, WPSNR, FLIP, NEEDED };
// What a group has in common beside device and scene; a file without one says nothing of it.
enum { WIDTH = NEEDED, HEIGHT, GAZE, SSAO, TAA, REST, COLUMNS };
static const char *const columns[COLUMNS] = {"device",  "scene",    "mode", "parameters", "gpu_ms_median",
                                             "psnr_db", "wpsnr_db", "flip", "width",      "height",
                                             "gaze",    "ssao",     "taa",  "rest"};

struct reading {
    struct bench *bench;
    size_t at[COLUMNS], fields; // places of the columns; `fields`: there is none
    char heading[LINE];
};

// Splits a line in place; quotes are doubled within quoted fields (RFC 4180, section 2). 0: a quote is not
// closed.
static size_t split(char *line, char *fields[FIELDS])
{
    size_t count = 0;
    char *from = line;
    for (bool more = true; more && count < FIELDS;) {
        bool quoted = *from == '"';
        char *to = from;
        fields[count++] = to;
        from += quoted;
        while (*from && (quoted || *from != ',')) {
            if (quoted && from[0] == '"' && from[1] != '"')
                break;
            from += quoted && from[0] == '"';
            *to++ = *from++;
        }
        if (quoted && *from != '"')
            return 0;
        from += quoted;
        if (*from && *from != ',')
            return 0;
        more = *from == ',';
        from += more;
        *to = '\0';
    }
    return count;
}

// An empty field is a measure that was not taken.
static bool number(const char *text, double *out)
{
    char *end;
    *out = text[0] ? strtod(text, &end) : (double)NAN;
    return !text[0] || (!*end && !isnan(*out) && *out != -(double)INFINITY);
}

// {"epsilon":0.2,"splat":"atomic"} as epsilon 0.2, splat atomic
static void keep_parameters(char *out, size_t size, const char *json)
{
    size_t used = 0;
    for (; *json && used + 2 < size; json++) {
        if (strchr("{}\"", *json))
            continue;
        out[used++] = *json == ':' ? ' ' : *json;
        if (*json == ',')
            out[used++] = ' ';
    }
    out[used] = '\0';
}

static void append(char out[BENCH_WORD], const char *before, const char *text)
{
    size_t used = strlen(out);
    snprintf(out + used, BENCH_WORD - used, "%s%s%s", used ? ", " : "", before, text);
}

static void setting_of(const struct reading *r, char *fields[], char out[BENCH_WORD])
{
    static const char *const effects[] = {"SSAO", "TAA", "moving objects at rest"};
    out[0] = '\0';
    if (r->at[WIDTH] < r->fields && r->at[HEIGHT] < r->fields)
        snprintf(out, BENCH_WORD, "%.20s \u00d7 %.20s px per eye", fields[r->at[WIDTH]], fields[r->at[HEIGHT]]);
    if (r->at[GAZE] < r->fields)
        append(out, "gaze ", fields[r->at[GAZE]]);
    for (size_t i = 0; i < 3; i++)
        if (r->at[SSAO + i] < r->fields && strcmp(fields[r->at[SSAO + i]], "1") == 0)
            append(out, "", effects[i]);
}

static bool find_group(struct reading *r, char *fields[], size_t *out)
{
    struct bench *b = r->bench;
    struct bench_group group = {0};
    snprintf(group.device, sizeof group.device, "%s", fields[r->at[DEVICE]]);
    snprintf(group.scene, sizeof group.scene, "%s", fields[r->at[SCENE]]);
    setting_of(r, fields, group.setting);
    for (*out = 0; *out < b->group_count; ++*out)
        if (strcmp(b->groups[*out].device, group.device) == 0 &&
            strcmp(b->groups[*out].scene, group.scene) == 0 &&
            strcmp(b->groups[*out].setting, group.setting) == 0)
            return true;
    if (!sample_grow(&b->groups, b->group_count, sizeof b->groups[0]))
        return false;
    b->groups[b->group_count++] = group;
    return true;
}

// *wrong: the column that holds no number it can be.
static bool read_row(struct reading *r, char *fields[], const char **wrong)
{
    struct bench_row row = {.speed = (double)NAN};
    snprintf(row.mode, sizeof row.mode, "%s", fields[r->at[MODE]]);
    keep_parameters(row.parameters, sizeof row.parameters, fields[r->at[PARAMETERS]]);
    double *values[] = {&row.gpu_ms, &row.psnr_db, &row.wpsnr_db, &row.flip};
    for (size_t i = 0; i < 4; i++)
        if (!number(fields[r->at[GPU_MS + i]], values[i]))
            *wrong = columns[GPU_MS + i];
    if (!*wrong && (row.gpu_ms <= 0 || isinf(row.gpu_ms)))
        *wrong = columns[GPU_MS];
    if (!*wrong && (row.flip < 0 || isinf(row.flip)))
        *wrong = columns[FLIP];
    struct bench *b = r->bench;
    if (!find_group(r, fields, &row.group) || !sample_grow(&b->rows, b->count, sizeof b->rows[0]))
        return false;
    b->rows[b->count++] = row;
    return true;
}

// Which needed column the heading lacks; NULL: none.
static const char *find_columns(struct reading *r, char *fields[], size_t count)
{
    const char *lacking = NULL;
    r->fields = count;
    for (size_t c = COLUMNS; c-- > 0;) {
        for (r->at[c] = 0; r->at[c] < count && strcmp(fields[r->at[c]], columns[c]) != 0;)
            r->at[c]++;
        if (r->at[c] == count && c < NEEDED)
            lacking = columns[c];
    }
    return lacking;
}

// False with a sentence's part from the line's number on; an empty one: no memory.
static bool read_line(struct reading *r, char *line, char *fields[], char *says, size_t size)
{
    says[0] = '\0';
    if (!line[0] || strcmp(line, r->heading) == 0)
        return true;
    bool first = !r->heading[0];
    if (first)
        snprintf(r->heading, sizeof r->heading, "%s", line);
    size_t count = split(line, fields);
    const char *wrong = first ? find_columns(r, fields, count) : NULL;
    if (wrong)
        snprintf(says, size, "has no column '%s'; name a file of fovbench --csv", wrong);
    if (first || wrong)
        return !wrong;
    if (count && strcmp(fields[0], r->heading) != 0 && strcmp(fields[0], columns[DEVICE]) == 0)
        snprintf(says, size, "begins other columns; put together only files with the same heading");
    else if (count != r->fields)
        snprintf(says, size, "has %zu fields where the heading has %zu, or an open quote", count, r->fields);
    else if (!read_row(r, fields, &wrong))
        return false;
    else if (wrong)
        snprintf(says, size, "%s is not a number that it can be", wrong);
    return !says[0];
}

bool bench_read(struct bench *bench, FILE *file, const char *path, char *error, size_t error_size)
{
    struct reading *r = calloc(1, sizeof *r);
    char *line = malloc(LINE), *fields[FIELDS], says[160] = "";
    size_t lines = 0;
    bool ok = r && line;
    if (r)
        r->bench = bench;
    while (ok && fgets(line, LINE, file)) {
        lines++;
        line[strcspn(line, "\r\n")] = '\0';
        ok = read_line(r, line, fields, says, sizeof says);
    }
    if (says[0])
        snprintf(error, error_size, "%s:%zu: %s", path, lines, says);
    if (ok && !bench->count) {
        snprintf(error, error_size, "%s: holds no measurement", path);
        ok = false;
    }
    free(line);
    free(r);
    return ok;
}
