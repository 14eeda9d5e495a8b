#include "app/fovbench/json_write.h"

#include "app/command/json.h"
#include "renderer/renderer.h"

#include <math.h>

static void pair(FILE *out, const char *name, double value)
{
    json_key(out, name, false);
    json_number(out, value);
}

static void word(FILE *out, const char *name, const char *value)
{
    json_key(out, name, false);
    json_string(out, value);
}

static void flag(FILE *out, const char *name, bool value)
{
    json_key(out, name, false);
    fputs(value ? "true" : "false", out);
}

static void write_error(FILE *out, const struct row_error *error, bool first)
{
    json_key(out, "psnr_db", first);
    json_number(out, error->psnr_db);
    pair(out, "ssim", error->ssim);
    pair(out, "flip", error->flip);
    pair(out, "wpsnr_db", error->wpsnr_db);
}

static void write_rings(FILE *out, const struct row *row)
{
    static const double limits_deg[ROW_RINGS + 1] = {0, 5, 15, 30, INFINITY};
    json_key(out, "rings", false);
    fputc('[', out);
    for (int i = 0; i < ROW_RINGS; i++) {
        fprintf(out, "%s{\"from_deg\":%g", i ? "," : "", limits_deg[i]);
        pair(out, "to_deg", limits_deg[i + 1]);
        fputc(',', out);
        write_error(out, &row->rings[i], true);
        pair(out, "flicker_excess", row->rings[i].flicker_excess);
        fputc('}', out);
    }
    fputc(']', out);
}

static void write_passes(FILE *out, const struct row *row)
{
    word(out, "pass_source", row->pass_source);
    json_key(out, "passes", false);
    fputc('[', out);
    for (uint32_t i = 0; i < row->pass_count; i++) {
        fprintf(out, "%s{\"name\":", i ? "," : "");
        json_string(out, row->passes[i].name);
        pair(out, "ms_median", row->passes[i].median_ms);
        fputc('}', out);
    }
    fputc(']', out);
}

static void write_redraws(FILE *out, const struct row *row)
{
    json_key(out, "full_redraws", false);
    fputc('{', out);
    for (int i = FRAME_REDRAW_NONE + 1; i < FRAME_REDRAW_CAUSES; i++) {
        json_key(out, renderer_redraw_name((enum frame_redraw)i), i == FRAME_REDRAW_NONE + 1);
        fprintf(out, "%llu", (unsigned long long)row->work.redraws[i]);
    }
    fputc('}', out);
}

static void write_supersampled(FILE *out, const struct row *row)
{
    json_key(out, "supersampled", false);
    if (!row->supersampled_factor) {
        fputs("null", out);
        return;
    }
    fprintf(out, "{\"samples_per_pixel\":%u,\"frames\":%llu,",
            row->supersampled_factor * row->supersampled_factor, (unsigned long long)row->supersampled_frames);
    write_error(out, &row->supersampled, true);
    fputc('}', out);
}

static void write_times(FILE *out, const struct row *row)
{
    pair(out, "gpu_ms_median", row->times.gpu_ms_median);
    pair(out, "gpu_ms_p95", row->times.gpu_ms_p95);
    pair(out, "gpu_ms_p99", row->times.gpu_ms_p99);
    pair(out, "cpu_ms_median", row->times.cpu_ms_median);
    pair(out, "ratio_to_regular", row->ratio.median);
    pair(out, "ratio_low", row->ratio.low);
    pair(out, "ratio_high", row->ratio.high);
}

static void write_work(FILE *out, const struct row *row)
{
    pair(out, "shaded_px", row->work.shaded_px);
    pair(out, "shaded_share", row->work.shaded_px / (2.0 * row->width * row->height));
    pair(out, "triangles", row->work.triangles);
    pair(out, "frustum_triangles", row->work.frustum_triangles);
    pair(out, "submodels", row->work.submodels);
    pair(out, "frustum_submodels", row->work.frustum_submodels);
    pair(out, "culled_submodels", row->work.frustum_submodels - row->work.submodels);
    pair(out, "moving_share", row->work.moving_share);
    pair(out, "memory_mb", row->memory_mb);
}

static void write_row(FILE *out, const struct row *row)
{
    json_key(out, "scene", true);
    json_string(out, row->scene);
    word(out, "mode", row->mode);
    json_key(out, "parameters", false);
    fputs(row->parameters, out);
    pair(out, "width", row->width);
    pair(out, "height", row->height);
    word(out, "gaze", row->gaze);
    flag(out, "ssao", row->ssao);
    flag(out, "taa", row->taa);
    flag(out, "rest", row->rest);
    pair(out, "frames", (double)row->frames);
    write_times(out, row);
    write_work(out, row);
    pair(out, "error_frames", (double)row->error_frames);
    fputc(',', out);
    write_error(out, &row->error, true);
    pair(out, "flicker_excess", row->error.flicker_excess);
    pair(out, "flicker_still", row->flicker_still);
    write_redraws(out, row);
    write_rings(out, row);
    write_passes(out, row);
    write_supersampled(out, row);
}

void json_write(FILE *out, const struct request *r, const struct row *rows, size_t count)
{
    fprintf(out, "{\"program\":\"fovbench\",\"version\":\"%s\"", FOVSTUDY_VERSION);
    word(out, "device", rows[0].device);
    word(out, "driver", rows[0].driver);
    pair(out, "warm_up_frames", REQUEST_WARM_UP);
    pair(out, "error_every", (double)r->error_every);
    pair(out, "still_frames", (double)r->still_frames);
    pair(out, "fov_deg", r->fov_deg);
    pair(out, "start_s", r->start_s);
    fputs(",\n\"rows\":[", out);
    for (size_t i = 0; i < count; i++) {
        fputs(i ? ",\n{" : "\n{", out);
        write_row(out, &rows[i]);
        fputc('}', out);
    }
    fputs("\n]}\n", out);
}
