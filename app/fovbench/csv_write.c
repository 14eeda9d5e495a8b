#include "app/fovbench/csv.h"

#include "app/fovbench/passes.h"
#include "renderer/renderer.h"

#include <math.h>
#include <string.h>

static void text(FILE *out, const char *value)
{
    if (!strpbrk(value, ",\"\r\n")) {
        fputs(value, out);
        return;
    }
    fputc('"', out);
    for (; *value; value++) {
        if (*value == '"')
            fputc('"', out);
        fputc(*value, out);
    }
    fputc('"', out);
}

static void number(FILE *out, double value)
{
    fputc(',', out);
    if (isinf(value))
        fputs(value > 0 ? "inf" : "-inf", out);
    else if (!isnan(value))
        fprintf(out, "%.6g", value);
}

static void count(FILE *out, double value) // a mean of whole numbers: whole pixels say enough
{
    fprintf(out, ",%.0f", value);
}

void csv_write_header(FILE *out)
{
    fputs("device,scene,mode,parameters,width,height,frames,gpu_ms_median,gpu_ms_p95,gpu_ms_p99,cpu_ms_median,"
          "shaded_px,triangles,memory_mb,psnr_db,ssim,flip,wpsnr_db,flicker_excess,flicker_still,"
          "gaze,ssao,taa,rest,ratio_to_regular,ratio_low,ratio_high,frustum_triangles,submodels,frustum_"
          "submodels,"
          "full_redraws,moving_share",
          out);
    for (int i = 0; i < PASS_GROUPS; i++)
        fprintf(out, ",%s_ms", pass_group_names[i]);
    fputc('\n', out);
}

static void key(FILE *out, const struct row *row)
{
    text(out, row->device);
    fputc(',', out);
    text(out, row->scene);
    fputc(',', out);
    text(out, row->mode);
    fputc(',', out);
    text(out, row->parameters);
    fprintf(out, ",%u,%u", row->width, row->height);
}

void csv_write_row(FILE *out, const struct row *row)
{
    double groups[PASS_GROUPS];
    uint64_t redraws = 0;
    for (int i = FRAME_REDRAW_NONE + 1; i < FRAME_REDRAW_CAUSES; i++)
        redraws += row->work.redraws[i];
    pass_groups(row->passes, row->pass_count, groups);
    key(out, row);
    fprintf(out, ",%llu", (unsigned long long)row->frames);
    const double times[] = {row->times.gpu_ms_median, row->times.gpu_ms_p95, row->times.gpu_ms_p99,
                            row->times.cpu_ms_median};
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++)
        number(out, times[i]);
    count(out, row->work.shaded_px);
    count(out, row->work.triangles);
    const double errors[] = {row->memory_mb,      row->error.psnr_db,        row->error.ssim,   row->error.flip,
                             row->error.wpsnr_db, row->error.flicker_excess, row->flicker_still};
    for (size_t i = 0; i < sizeof errors / sizeof errors[0]; i++)
        number(out, errors[i]);
    fputc(',', out);
    text(out, row->gaze);
    fprintf(out, ",%d,%d,%d", row->ssao, row->taa, row->rest);
    number(out, row->ratio.median);
    number(out, row->ratio.low);
    number(out, row->ratio.high);
    count(out, row->work.frustum_triangles);
    count(out, row->work.submodels);
    count(out, row->work.frustum_submodels);
    fprintf(out, ",%llu", (unsigned long long)redraws);
    number(out, row->work.moving_share);
    for (int i = 0; i < PASS_GROUPS; i++)
        number(out, groups[i]);
    fputc('\n', out);
}

void csv_write_frames_header(FILE *out)
{
    fputs("device,scene,mode,parameters,width,height,gaze,frame,gpu_ms,cpu_ms,shaded_px,triangles,frustum_"
          "triangles,"
          "submodels,frustum_submodels,redraw,moving_share\n",
          out);
}

void csv_write_frame(FILE *out, const struct row *row, uint64_t frame, const struct sample *sample)
{
    const char *redraw = renderer_redraw_name(sample->redraw);
    key(out, row);
    fputc(',', out);
    text(out, row->gaze);
    fprintf(out, ",%llu", (unsigned long long)frame);
    number(out, sample->gpu_ms);
    number(out, sample->cpu_ms);
    const uint64_t counts[] = {sample->shaded_px, sample->triangles, sample->frustum_triangles,
                               sample->submodels, sample->frustum_submodels};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
        fprintf(out, ",%llu", (unsigned long long)counts[i]);
    fprintf(out, ",%s", redraw ? redraw : "");
    number(out, sample->moving_share);
    fputc('\n', out);
}
