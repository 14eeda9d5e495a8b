#include "app/fovbench/table.h"

#include <math.h>
#include <string.h>

static void number(FILE *out, int width, int digits, double value)
{
    if (isnan(value))
        fprintf(out, " %*s", width, "-");
    else if (isinf(value))
        fprintf(out, " %*s", width, "inf");
    else
        fprintf(out, " %*.*f", width, digits, value);
}

static void write_ratio(FILE *out, const struct series_ratio *ratio)
{
    char interval[32] = "";
    if (!isnan(ratio->low))
        snprintf(interval, sizeof interval, "[%.2f, %.2f]", ratio->low, ratio->high);
    fprintf(out, " %7.2f %-14s", ratio->median, interval);
}

static void write_row(FILE *out, const struct row *row, int label_width)
{
    const double all_px = 2.0 * row->width * row->height;
    fprintf(out, "%-*s", label_width, row->label);
    number(out, 8, 2, row->times.gpu_ms_median);
    number(out, 8, 2, row->times.gpu_ms_p95);
    number(out, 8, 2, row->times.gpu_ms_p99);
    write_ratio(out, &row->ratio);
    number(out, 6, 2, row->times.cpu_ms_median);
    number(out, 7, 2, 100 * row->work.shaded_px / all_px);
    number(out, 9, 0, row->work.triangles);
    number(out, 6, 1, 100 * row->work.triangles / row->work.frustum_triangles);
    number(out, 7, 1, row->memory_mb);
    number(out, 7, 2, row->error.psnr_db);
    number(out, 7, 2, row->error.wpsnr_db);
    number(out, 6, 4, row->error.ssim);
    number(out, 6, 4, row->error.flip);
    number(out, 7, 3, row->error.flicker_excess);
    number(out, 8, 5, row->flicker_still);
    fputc('\n', out);
}

void table_write(FILE *out, const struct row *rows, size_t count)
{
    int label_width = 12;
    for (size_t i = 0; i < count; i++)
        if ((int)strlen(rows[i].label) > label_width)
            label_width = (int)strlen(rows[i].label);
    fprintf(out, "\n%s, %ux%u per eye, gaze %s%s%s%s; %llu frames on %s\n", rows[0].scene, rows[0].width,
            rows[0].height, rows[0].gaze, rows[0].ssao ? ", SSAO" : "", rows[0].taa ? ", TAA" : "",
            rows[0].rest ? ", objects at rest" : "", (unsigned long long)rows[0].frames, rows[0].device);
    fprintf(out,
            "%-*s   GPU ms      p95      p99 regular/mode [95 %%]      CPU shaded triangles     of  memory    "
            "PSNR    "
            "ecc-w   SSIM   FLIP flicker flicker\n",
            label_width, "mode");
    fprintf(out,
            "%-*s   median                          per frame         ms    %%              seen %%   MB      "
            "dB    PSNR"
            "                excess  still\n",
            label_width, "");
    for (size_t i = 0; i < count; i++)
        write_row(out, &rows[i], label_width);
    fflush(out);
}
