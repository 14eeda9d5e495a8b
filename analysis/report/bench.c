#include "analysis/report/bench.h"

#include "analysis/report/sample.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIELDS = 128, LINE = 16384 };

enum column { DEVICE, SCENE, MODE, PARAMETERS, GPU_MS, PSNR, WPSNR, FLIP, COLUMNS };
static const char *const columns[COLUMNS] = {"device",        "scene",   "mode",     "parameters",
                                             "gpu_ms_median", "psnr_db", "wpsnr_db", "flip"};

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

static bool number(const char *text, double *out)
{
    char *end;
    *out = strtod(text, &end);
    return text[0] && !*end && !isnan(*out);
}

static void keep(char *out, size_t size, const char *text)
{
    snprintf(out, size, "%s", text);
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

static bool read_row(struct bench *bench, char *fields[], const size_t at[COLUMNS], const char **wrong)
{
    if (!sample_grow(&bench->rows, bench->count, sizeof bench->rows[0]))
        return false;
    struct bench_row *row = &bench->rows[bench->count];
    *row = (struct bench_row){0};
    keep(row->device, sizeof row->device, fields[at[DEVICE]]);
    keep(row->scene, sizeof row->scene, fields[at[SCENE]]);
    keep(row->mode, sizeof row->mode, fields[at[MODE]]);
    keep_parameters(row->parameters, sizeof row->parameters, fields[at[PARAMETERS]]);
    double *values[] = {&row->gpu_ms, &row->psnr_db, &row->wpsnr_db, &row->flip};
    for (size_t i = 0; i < 4; i++)
        if (!number(fields[at[GPU_MS + i]], values[i]))
            *wrong = columns[GPU_MS + i];
    if (!*wrong && !(row->gpu_ms > 0 && isfinite(row->gpu_ms)))
        *wrong = columns[GPU_MS];
    bench->count++;
    return true;
}

static bool read_lines(struct bench *bench, FILE *file, const char *path, char *error, size_t error_size)
{
    char *line = malloc(LINE), *fields[FIELDS];
    size_t at[COLUMNS], heading = 0, lines = 0;
    bool ok = line != NULL;
    while (ok && fgets(line, LINE, file)) {
        lines++;
        line[strcspn(line, "\r\n")] = '\0';
        const char *wrong = NULL;
        size_t count = split(line, fields);
        if (lines == 1) {
            heading = count;
            for (size_t c = 0; ok && c < COLUMNS; c++) {
                for (at[c] = 0; at[c] < count && strcmp(fields[at[c]], columns[c]) != 0;)
                    at[c]++;
                ok = at[c] < count;
                if (!ok)
                    snprintf(error, error_size, "%s:1: has no column '%s'; name a file of fovbench --csv", path,
                             columns[c]);
            }
        } else if (count != heading) {
            snprintf(error, error_size, "%s:%zu: has %zu fields where the heading has %zu, or an open quote",
                     path, lines, count, heading);
            ok = false;
        } else if (ok = read_row(bench, fields, at, &wrong), wrong) {
            snprintf(error, error_size, "%s:%zu: %s is not a number that it can be", path, lines, wrong);
            ok = false;
        }
    }
    if (ok && !bench->count) {
        snprintf(error, error_size, "%s: holds no measurement", path);
        ok = false;
    }
    free(line);
    return ok;
}

static const struct bench_row *regular_of(const struct bench *bench, const struct bench_row *row)
{
    for (size_t i = 0; i < bench->count; i++)
        if (strcmp(bench->rows[i].mode, "regular") == 0 && strcmp(bench->rows[i].scene, row->scene) == 0 &&
            strcmp(bench->rows[i].device, row->device) == 0)
            return &bench->rows[i];
    return NULL;
}

static bool beaten(const struct bench *bench, const struct bench_row *row)
{
    for (size_t i = 0; i < bench->count; i++) {
        const struct bench_row *o = &bench->rows[i];
        if (o->number && strcmp(o->scene, row->scene) == 0 && o->speed >= row->speed &&
            o->wpsnr_db >= row->wpsnr_db && (o->speed > row->speed || o->wpsnr_db > row->wpsnr_db))
            return true;
    }
    return false;
}

static bool compare(struct bench *bench, const char *path, char *error, size_t error_size)
{
    for (size_t i = 0; i < bench->count; i++) {
        struct bench_row *row = &bench->rows[i];
        const struct bench_row *regular = regular_of(bench, row);
        if (!regular) {
            snprintf(error, error_size,
                     "%s:%zu: the scene %.80s has no row of 'regular' on its device to compare with", path,
                     i + 2, row->scene);
            return false;
        }
        row->speed = regular->gpu_ms / row->gpu_ms;
        size_t scene = 0, before = 0;
        while (scene < bench->scene_count && strcmp(bench->scenes[scene], row->scene) != 0)
            scene++;
        if (scene == bench->scene_count && scene < BENCH_SCENES)
            bench->scenes[bench->scene_count++] = row->scene;
        for (size_t j = 0; j < i; j++)
            if (strcmp(bench->rows[j].scene, row->scene) == 0 && bench->rows[j].number > before)
                before = bench->rows[j].number;
        row->number = row == regular || isinf(row->wpsnr_db) ? 0 : before + 1;
    }
    for (size_t i = 0; i < bench->count; i++)
        bench->rows[i].front = bench->rows[i].number && !beaten(bench, &bench->rows[i]);
    return true;
}

bool bench_load(struct bench *out, const char *path, char *error, size_t error_size)
{
    *out = (struct bench){0};
    FILE *file = fopen(path, "r");
    if (!file) {
        snprintf(error, error_size, "%s: cannot be read: %s", path, strerror(errno));
        return false;
    }
    snprintf(error, error_size, "%s: not enough memory", path);
    bool ok = read_lines(out, file, path, error, error_size) && compare(out, path, error, error_size);
    fclose(file);
    if (!ok)
        bench_free(out);
    return ok;
}

void bench_free(struct bench *bench)
{
    free(bench->rows);
    *bench = (struct bench){0};
}
