#include "app/fovbench/sweep.h"

#include "app/command/options.h"
#include "app/command/output.h"
#include "app/fovbench/csv.h"
#include "app/fovbench/group.h"
#include "app/fovbench/json_write.h"
#include "app/fovbench/plot.h"
#include "app/fovbench/table.h"

#include <stdlib.h>
#include <string.h>

enum { ERROR_SIZE = 4608 };

enum file { FILE_CSV, FILE_JSON, FILE_PLOT, FILE_FRAMES, FILES };

// A built-in scene keeps its specification; a file is called as it is without folder and ending, so that
// results of two machines name it alike.
static void name_scene(const char *spec, char *out, size_t size)
{
    const char *slash = strrchr(spec, '/');
    snprintf(out, size, "%s", slash ? slash + 1 : spec);
    char *dot = strrchr(out, '.');
    if (dot && (strcmp(dot, ".gltf") == 0 || strcmp(dot, ".glb") == 0))
        *dot = '\0';
}

static bool open_files(const struct request *r, struct output files[FILES])
{
    const char *const paths[FILES] = {[FILE_CSV] = r->outputs.csv,
                                      [FILE_JSON] = r->outputs.json,
                                      [FILE_PLOT] = r->outputs.plot,
                                      [FILE_FRAMES] = r->outputs.frames_csv};
    char error[ERROR_SIZE];
    for (int i = 0; i < FILES; i++)
        if (!output_open(&files[i], paths[i], error, sizeof error)) {
            fprintf(stderr, "fovbench: %s\n", error);
            return false;
        }
    return true;
}

static bool close_files(struct output files[FILES], bool keep)
{
    char error[ERROR_SIZE];
    bool ok = true;
    for (int i = 0; i < FILES; i++)
        if (!output_close(&files[i], keep, error, sizeof error)) {
            fprintf(stderr, "fovbench: %s\n", error);
            ok = false;
        }
    return ok;
}

static bool table_wanted(const struct output files[FILES])
{
    for (int i = 0; i < FILES; i++)
        if (files[i].file == stdout)
            return false;
    return true;
}

static bool measure_scene(const struct request *r, const struct scene *scene, const char *name,
                          struct output files[FILES], struct row *rows)
{
    for (size_t s = 0; s < r->size_count; s++)
        for (size_t z = 0; z < r->gaze_count; z++) {
            char progress[512];
            const struct group_desc desc = {.request = r,
                                            .scene = scene,
                                            .scene_name = name,
                                            .size = r->sizes[s],
                                            .gaze = &r->gazes[z],
                                            .frames_csv = files[FILE_FRAMES].file,
                                            .progress_name = progress};
            snprintf(progress, sizeof progress, "%.256s %ux%u %.64s", name, desc.size.width, desc.size.height,
                     desc.gaze->text);
            if (!group_measure(&desc, rows))
                return false;
            if (table_wanted(files))
                table_write(stdout, rows, r->mode_count);
            rows += r->mode_count;
        }
    return true;
}

static bool measure_all(const struct request *r, struct output files[FILES], char (*names)[256],
                        struct row *rows)
{
    char error[1024];
    for (size_t i = 0; i < r->scene_count; i++) {
        struct scene *scene = scene_open(r->scenes[i], error, sizeof error);
        if (!scene) {
            fprintf(stderr, "fovbench: %s\n", error);
            return false;
        }
        name_scene(r->scenes[i], names[i], sizeof names[i]);
        bool ok =
            measure_scene(r, scene, names[i], files, rows + i * r->size_count * r->gaze_count * r->mode_count);
        scene_destroy(scene);
        if (!ok)
            return false;
    }
    return true;
}

static bool write_files(const struct request *r, struct output files[FILES], const struct row *rows,
                        size_t count)
{
    if (files[FILE_CSV].file)
        csv_write_header(files[FILE_CSV].file);
    for (size_t i = 0; files[FILE_CSV].file && i < count; i++)
        csv_write_row(files[FILE_CSV].file, &rows[i]);
    if (files[FILE_JSON].file)
        json_write(files[FILE_JSON].file, r, rows, count);
    if (!files[FILE_PLOT].file || plot_write(files[FILE_PLOT].file, rows, count / r->mode_count, r->mode_count))
        return true;
    fprintf(stderr, "fovbench: out of memory\n");
    return false;
}

int sweep(const struct request *r)
{
    struct output files[FILES] = {0};
    char names[REQUEST_SCENES][256];
    const size_t count = r->scene_count * r->size_count * r->gaze_count * r->mode_count;
    struct row *rows = calloc(count, sizeof *rows);
    bool ok = rows && open_files(r, files);
    if (!rows)
        fprintf(stderr, "fovbench: out of memory\n");
    if (ok && files[FILE_FRAMES].file)
        csv_write_frames_header(files[FILE_FRAMES].file);
    ok = ok && measure_all(r, files, names, rows);
    ok = ok && write_files(r, files, rows, count);
    ok = close_files(files, ok) && ok;
    free(rows);
    return ok ? EXIT_DONE : EXIT_FAILED;
}
