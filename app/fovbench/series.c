#include "app/fovbench/series.h"

#include "analysis/stats/quantile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool series_init(struct series *series, size_t capacity)
{
    *series = (struct series){.samples = calloc(capacity, sizeof *series->samples), .capacity = capacity};
    return series->samples != NULL;
}

void series_finish(struct series *series)
{
    free(series->samples);
    *series = (struct series){0};
}

void series_add(struct series *series, const struct frame_stats *stats)
{
    if (series->count == series->capacity)
        return;
    series->samples[series->count++] = (struct sample){.gpu_ms = stats->gpu_ms,
                                                       .cpu_ms = stats->cpu_ms,
                                                       .shaded_px = stats->shaded_px,
                                                       .triangles = stats->triangles,
                                                       .frustum_triangles = stats->frustum_triangles,
                                                       .submodels = stats->submodels,
                                                       .frustum_submodels = stats->frustum_submodels,
                                                       .redraw = stats->redraw,
                                                       .moving_share = (double)NAN};
}

bool series_times(const struct series *series, struct series_times *out)
{
    const size_t n = series->count;
    double *gpu = malloc((2 * n + 1) * sizeof *gpu), *cpu = gpu ? gpu + n : NULL;
    if (!gpu)
        return false;
    for (size_t i = 0; i < n; i++) {
        gpu[i] = series->samples[i].gpu_ms;
        cpu[i] = series->samples[i].cpu_ms;
    }
    stat_sort(gpu, n);
    stat_sort(cpu, n);
    *out = (struct series_times){.gpu_ms_median = stat_quantile(gpu, n, 0.5),
                                 .gpu_ms_p95 = stat_quantile(gpu, n, 0.95),
                                 .gpu_ms_p99 = stat_quantile(gpu, n, 0.99),
                                 .cpu_ms_median = stat_quantile(cpu, n, 0.5)};
    free(gpu);
    return true;
}

void series_work(const struct series *series, struct series_work *out)
{
    const double n = (double)series->count;
    double share = 0, shares = 0;
    *out = (struct series_work){0};
    for (size_t i = 0; i < series->count; i++) {
        const struct sample *s = &series->samples[i];
        out->shaded_px += (double)s->shaded_px / n;
        out->triangles += (double)s->triangles / n;
        out->frustum_triangles += (double)s->frustum_triangles / n;
        out->submodels += (double)s->submodels / n;
        out->frustum_submodels += (double)s->frustum_submodels / n;
        out->redraws[s->redraw]++;
        share += isnan(s->moving_share) ? 0 : s->moving_share;
        shares += !isnan(s->moving_share);
    }
    out->moving_share = share / shares;
}

// The largest k >= 1 with P(B < k) <= 0.025 for B of n tosses: x(k)..x(n + 1 - k) then misses the median with
// at most 5 %. 0: none.
static size_t median_rank(size_t n)
{
    double log_term = -(double)n * log(2), below = 0;
    size_t k = 0;
    for (; k < n; k++) {
        below += exp(log_term);
        if (below > 0.025)
            break;
        log_term += log((double)(n - k)) - log((double)(k + 1));
    }
    return k;
}

struct series_ratio series_median_interval(const double *sorted, size_t count)
{
    size_t k = median_rank(count);
    return (struct series_ratio){.median = stat_quantile(sorted, count, 0.5),
                                 .low = k ? sorted[k - 1] : (double)NAN,
                                 .high = k ? sorted[count - k] : (double)NAN};
}

bool series_ratio(const struct series *reference, const struct series *own, struct series_ratio *out)
{
    const size_t n = reference->count < own->count ? reference->count : own->count;
    double *ratios = malloc((n + 1) * sizeof *ratios);
    if (!ratios)
        return false;
    for (size_t i = 0; i < n; i++)
        ratios[i] = reference->samples[i].gpu_ms / own->samples[i].gpu_ms;
    stat_sort(ratios, n);
    *out = series_median_interval(ratios, n);
    free(ratios);
    return true;
}

bool pass_series_init(struct pass_series *passes, size_t capacity)
{
    *passes = (struct pass_series){.ms = calloc(FRAME_TIMERS * capacity + 1, sizeof *passes->ms),
                                   .capacity = capacity};
    return passes->ms != NULL;
}

void pass_series_finish(struct pass_series *passes)
{
    free(passes->ms);
    *passes = (struct pass_series){0};
}

static size_t pass_of(struct pass_series *passes, const char *name)
{
    for (size_t i = 0; i < passes->pass_count; i++)
        if (strcmp(passes->names[i], name) == 0)
            return i;
    if (passes->pass_count < FRAME_TIMERS)
        passes->names[passes->pass_count++] = name;
    return passes->pass_count - 1;
}

void pass_series_add(struct pass_series *passes, const struct frame_stats *stats)
{
    if (passes->count == passes->capacity)
        return;
    for (uint32_t i = 0; i < stats->timer_count; i++)
        passes->ms[pass_of(passes, stats->timers[i].name) * passes->capacity + passes->count] +=
            stats->timers[i].ms;
    passes->count++;
}

double pass_series_median_ms(struct pass_series *passes, size_t pass)
{
    double *ms = passes->ms + pass * passes->capacity;
    stat_sort(ms, passes->count);
    return stat_quantile(ms, passes->count, 0.5);
}
