// What the file has and we do not draw, one sentence a kind.
#include "stimuli/gltf/build.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void note(struct scene *scene, uint32_t count, const char *format, ...)
{
    size_t used = strlen(scene->notes);
    char line[160];
    if (count == 0)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    // A file's own words may stand in the line.
    for (char *c = line; *c != '\0'; c++)
        if ((unsigned char)*c < 32)
            *c = ' ';
    if (used + strlen(line) + 2 <= sizeof scene->notes)
        snprintf(scene->notes + used, sizeof scene->notes - used, "%s\n", line);
}

static void note_materials(struct scene *scene, const struct gltf_document *d)
{
    uint32_t blended = 0, extended = 0, imageless = 0;
    for (uint32_t i = 0; i < d->material_count; i++) {
        blended += d->materials[i].blend;
        extended += d->materials[i].extended;
    }
    for (uint32_t i = 0; i < d->texture_count; i++)
        imageless += d->textures[i].image < 0;
    note(scene, blended, "%u blended material(s) drawn opaque.", blended);
    note(scene, extended, "%u material(s) drawn without their KHR_materials extensions.", extended);
    note(scene, imageless, "%u texture(s) without a PNG or JPEG image not drawn.", imageless);
}

static void note_meshes(struct scene *scene, const struct gltf_document *d)
{
    uint32_t points = 0, lines = 0, morphs = 0, skinned = 0;
    for (uint32_t i = 0; i < d->primitive_count; i++) {
        points += d->primitives[i].mode == 0;
        lines += d->primitives[i].mode >= 1 && d->primitives[i].mode <= 3;
        morphs += d->primitives[i].morph;
    }
    for (uint32_t i = 0; i < d->node_count; i++)
        skinned += d->nodes[i].skin >= 0;
    note(scene, points, "%u primitive(s) of points not drawn.", points);
    note(scene, lines, "%u primitive(s) of lines not drawn.", lines);
    note(scene, morphs, "%u primitive(s) drawn without their morph targets.", morphs);
    note(scene, skinned, "%u skinned node(s) drawn without their skin.", skinned);
}

static void note_extensions(struct scene *scene, const struct gltf_document *d)
{
    static const char *const known[] = {"KHR_lights_punctual", "KHR_texture_transform",
                                        "KHR_mesh_quantization"};
    uint32_t unknown = 0;
    const char *first = "";
    for (uint32_t i = 0; i < d->extension_used_count; i++) {
        bool found = strncmp(d->extensions_used[i], "KHR_materials_", 14) == 0; // note_materials
        for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
            found = found || strcmp(d->extensions_used[i], known[k]) == 0;
        if (!found && unknown++ == 0)
            first = d->extensions_used[i];
    }
    note(scene, unknown, "%u extension(s) not read, first %.60s.", unknown, first);
}

void gltf_write_notes(struct gltf_build *build)
{
    const struct gltf_document *d = build->document;
    struct scene *scene = build->scene;
    note_meshes(scene, d);
    note_materials(scene, d);
    note(scene, build->high_uv_sets, "%u texture(s) on TEXCOORD_2 or higher not drawn.", build->high_uv_sets);
    note(scene, build->further_suns, "%u further directional light(s) not drawn; the brightest is the sun.",
         build->further_suns);
    note(scene, d->animation_count > 1 ? 1 : 0, "%u further animation(s) not played; the first is.",
         d->animation_count - 1);
    note(scene, build->ignored_channels, "%u animation channel(s) of morph weights not played.",
         build->ignored_channels);
    note(scene, d->scene_count > 1 ? 1 : 0, "%u further scene(s) not drawn.", d->scene_count - 1);
    note(scene, build->unused_cameras, "%u camera(s) not used.", build->unused_cameras);
    note_extensions(scene, d);
}
