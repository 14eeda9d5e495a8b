#include "app/fovstudy/check_scenes.h"

#include "stimuli/builtin/builtin.h"
#include "studies/protocol/read.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct checked {
    const char *path; // of the protocol
    const struct protocol *protocol;
    struct text *remarks;
    char *error;
    size_t error_size;
};

// A stand-in is a built-in scene with valid parameters, whatever is bound today.
static bool stand_in_check(const struct checked *c, uint32_t scene, struct camera_path *out)
{
    const struct protocol_place at = c->protocol->stand_in_places[scene];
    const char *spec = c->protocol->stand_ins[scene], *names[16] = {NULL};
    char why[512], name[PROTOCOL_NAME];
    if (builtin_scene_check(spec, out, why, sizeof why))
        return true;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(spec, ":"), spec);
    for (size_t i = 0; builtin_scenes[i].name && i < 15; i++)
        names[i] = builtin_scenes[i].name;
    const char *nearest = builtin_scene_known(spec) ? NULL : read_nearest(name, names);
    if (nearest)
        snprintf(c->error, c->error_size, "%s:%u:%u: stand_in '%s' is not known here; did you mean '%s'?",
                 c->path, at.line, at.column, name, nearest);
    else
        snprintf(c->error, c->error_size, "%s:%u:%u: stand_in: %s", c->path, at.line, at.column, why);
    return false;
}

// As scene_open takes it.
static bool is_file(const char *spec)
{
    const char *end = strrchr(spec, '.');
    return strchr(spec, '/') || (end && (strcmp(end, ".gltf") == 0 || strcmp(end, ".glb") == 0));
}

static bool is_folder(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

// A binding is a built-in scene or a file; of a file the path is known only once it is loaded (*out_known).
static bool binding_check(const struct checked *c, const char *name, const char *spec, bool load,
                          struct camera_path *out, bool *out_known)
{
    char why[512];
    *out_known = true;
    if (!is_file(spec)) {
        if (builtin_scene_check(spec, out, why, sizeof why))
            return true;
        snprintf(c->error, c->error_size, "--scene %s: %s", name, why);
        return false;
    }
    *out_known = load;
    if (access(spec, R_OK) != 0) {
        snprintf(c->error, c->error_size, "--scene %s: %s cannot be opened: %s", name, spec, strerror(errno));
        return false;
    }
    if (is_folder(spec)) {
        snprintf(c->error, c->error_size, "--scene %s: %s is a folder; name a .gltf or .glb file", name, spec);
        return false;
    }
    if (!load)
        return true;
    struct scene *scene = scene_open(spec, why, sizeof why);
    if (!scene) {
        snprintf(c->error, c->error_size, "--scene %s: %s", name, why);
        return false;
    }
    *out = scene->path;
    scene_destroy(scene);
    return true;
}

// How long a trial flies on, as far as the clock ends it.
static double flight_s(const struct protocol_block *block, const struct protocol_settings *settings)
{
    bool clock = block->kind == PROTOCOL_SEQUENTIAL || !protocol_kind_is_pair(block->kind);
    return (double)settings->path_start_ns / 1e9 + (clock ? (double)settings->view_ns / 1e9 : 0);
}

static bool visits(const struct protocol_block *block, const struct protocol_cell *cell, uint32_t scene)
{
    if (cell->scene >= 0)
        return cell->scene == (int32_t)scene;
    for (uint32_t i = 0; i < block->scene_count; i++)
        if (block->scenes[i] == scene)
            return true;
    return false;
}

static void flight_remark(const struct checked *c, uint32_t scene, const struct camera_path *path)
{
    for (uint32_t b = 0; b < c->protocol->block_count; b++) {
        const struct protocol_block *block = &c->protocol->blocks[b];
        const struct protocol_place at = c->protocol->block_places[b];
        const struct protocol_settings *longest = NULL;
        for (uint32_t i = 0; i < block->cell_count; i++) {
            const struct protocol_settings *s = &block->cells[i].settings;
            if (visits(block, &block->cells[i], scene) && s->camera == PROTOCOL_CAMERA_PATH &&
                (!longest || flight_s(block, s) > flight_s(block, longest)))
                longest = s;
        }
        if (!longest)
            continue;
        if (path->knot_count < 2)
            text_add(
                c->remarks,
                "%s:%u:%u: scene '%s' has no camera path, so in block '%s' the camera stands still; give it "
                "three cameras or more, or set 'camera: still'\n",
                c->path, at.line, at.column, c->protocol->scenes[scene], block->name);
        else if (flight_s(block, longest) > path->duration_s)
            text_add(
                c->remarks,
                "%s:%u:%u: block '%s' flies to %g s of scene '%s', whose path is one round of %.1f s: what is "
                "beyond repeats its beginning; lower path_start_s or view_s\n",
                c->path, at.line, at.column, block->name, flight_s(block, longest), c->protocol->scenes[scene],
                path->duration_s);
    }
}

bool check_scenes(const char *path, const struct protocol *protocol, const struct bound_scene *bound,
                  size_t count, bool load, struct text *remarks, char *error, size_t error_size)
{
    const struct checked c = {path, protocol, remarks, error, error_size};
    struct camera_path *flight = malloc(sizeof *flight); // too large for some stacks
    bool ok = flight != NULL;
    if (!ok)
        snprintf(error, error_size, "out of memory");
    for (uint32_t i = 0; i < protocol->scene_count && ok; i++) {
        const char *name = protocol->scenes[i], *spec = study_scene_spec(bound, count, name);
        bool known = builtin_scene_known(spec), stands_in = *protocol->stand_ins[i] != '\0';
        char unused[256];
        if (stands_in)
            ok = stand_in_check(&c, i, flight);
        if (ok && spec != name)
            ok = binding_check(&c, name, spec, load, flight, &known);
        else if (ok && !stands_in)
            known = builtin_scene_check(spec, flight, unused, sizeof unused);
        else
            known = stands_in;
        if (ok && known)
            flight_remark(&c, i, flight);
    }
    free(flight);
    return ok;
}
