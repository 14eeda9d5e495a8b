#include "stimuli/gltf.h"

#include "stimuli/gltf/build.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool check_world(struct gltf_build *build, const struct dmat4 *world)
{
    const struct gltf_document *d = build->document;
    for (uint32_t i = 0; i < d->node_count; i++) {
        int32_t at = build->scene_node[i];
        for (int k = 0; at >= 0 && k < 16; k++)
            // Beyond 1e12 even double positions lose the millimetre.
            if (!(world[at].m[k] >= -1e12 && world[at].m[k] <= 1e12)) {
                gltf_at(&build->report, "nodes[%u]", i);
                return gltf_fail(&build->report, "its transform with those of its ancestors passes 1e12");
            }
    }
    return true;
}

static bool build_scene(struct gltf_build *build)
{
    if (!gltf_build_materials(build) || !gltf_build_meshes(build) || !gltf_build_nodes(build) ||
        !gltf_build_animation(build))
        return false;
    struct scene *scene = build->scene;
    scene_finish(scene);
    struct dmat4 *world = malloc((scene->node_count + 1u) * sizeof *world);
    if (world == NULL) {
        gltf_at(&build->report, "nodes");
        return gltf_fail(&build->report, "out of memory");
    }
    scene_pose(scene, 0.0, false, world);
    bool ok = check_world(build, world) && gltf_build_lights(build, world) && gltf_build_path(build, world);
    free(world);
    gltf_write_notes(build);
    return ok;
}

static struct scene *scene_from(const struct gltf_document *document, char *error, size_t error_size)
{
    struct gltf_build build = {.document = document,
                               .scene = calloc(1, sizeof(struct scene)),
                               .scene_node = malloc((document->node_count + 1u) * sizeof(int32_t)),
                               .report = {.error = error, .error_size = error_size}};
    bool ok = false;
    if (build.scene == NULL || build.scene_node == NULL)
        snprintf(error, error_size, "out of memory");
    else
        ok = build_scene(&build);
    free(build.scene_node);
    if (!ok) {
        scene_destroy(build.scene);
        return NULL;
    }
    return build.scene;
}

static void name_scene(struct scene *scene, const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    snprintf(scene->name, sizeof scene->name, "%.*s", (int)strcspn(name, "."), name);
}

// "path: sentence", or "path:line:column: sentence" where the sentence begins with a place in the text.
static void write_error(const char *path, const char *sentence, char *error, size_t error_size)
{
    size_t digits = strspn(sentence, "0123456789");
    bool place = digits > 0 && sentence[digits] == ':';
    snprintf(error, error_size, "%s:%s%s", path, place ? "" : " ", sentence);
}

struct scene *gltf_open(const char *path, char *error, size_t error_size)
{
    char sentence[640] = "";
    struct gltf_file file;
    struct gltf_document *document = NULL;
    struct scene *scene = NULL;
    if (gltf_file_read(&file, path, sentence, sizeof sentence) && gltf_scan(&file, sentence, sizeof sentence) &&
        (document = gltf_parse(&file, sentence, sizeof sentence)) != NULL) {
        // An image that cannot be read is only a warning to the parser.
        if (file.problem[0] != '\0')
            snprintf(sentence, sizeof sentence, "images: %s", file.problem);
        else if (gltf_check(document, sentence, sizeof sentence))
            scene = scene_from(document, sentence, sizeof sentence);
    }
    if (scene != NULL)
        name_scene(scene, path);
    else
        write_error(path, sentence, error, error_size);
    gltf_document_destroy(document);
    gltf_file_finish(&file);
    return scene;
}
