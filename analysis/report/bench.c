#include "analysis/report/bench.h"

#include "analysis/report/bench_private.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// With other parameters `regular` is a mode like others.
static bool is_regular(const struct bench_row *row, const struct bench_row *first)
{
    return strcmp(row->mode, "regular") == 0 && (!first || strcmp(row->parameters, first->parameters) == 0);
}

static const struct bench_row *find_regular(struct bench *bench, size_t group)
{
    const struct bench_row *first = NULL;
    for (size_t i = 0; i < bench->count; i++) {
        if (bench->rows[i].group != group || !is_regular(&bench->rows[i], first))
            continue;
        first = first ? first : &bench->rows[i];
        bench->groups[group].regulars++;
    }
    return first;
}

static bool known(const struct bench_row *row)
{
    return !isnan(row->speed) && !isnan(row->wpsnr_db);
}

static bool beaten(const struct bench *bench, const struct bench_row *row)
{
    for (size_t i = 0; i < bench->count; i++) {
        const struct bench_row *o = &bench->rows[i];
        if (o->group == row->group && known(o) && o->speed >= row->speed && o->wpsnr_db >= row->wpsnr_db &&
            (o->speed > row->speed || o->wpsnr_db > row->wpsnr_db))
            return true;
    }
    return false;
}

static void compare(struct bench *bench, size_t group)
{
    const struct bench_row *regular = find_regular(bench, group);
    bool speeds = bench->groups[group].regulars == 1;
    for (size_t i = 0; i < bench->count; i++) {
        struct bench_row *row = &bench->rows[i];
        if (row->group != group)
            continue;
        row->speed = speeds ? regular->gpu_ms / row->gpu_ms : (double)NAN;
        row->number = known(row) && isfinite(row->wpsnr_db) ? ++bench->groups[group].drawn : 0;
    }
    for (size_t i = 0; i < bench->count; i++)
        if (bench->rows[i].group == group)
            bench->rows[i].front = known(&bench->rows[i]) && !beaten(bench, &bench->rows[i]);
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
    bool ok = bench_read(out, file, path, error, error_size);
    fclose(file);
    for (size_t group = 0; ok && group < out->group_count; group++)
        compare(out, group);
    if (!ok)
        bench_free(out);
    return ok;
}

void bench_free(struct bench *bench)
{
    free(bench->rows);
    free(bench->groups);
    *bench = (struct bench){0};
}
