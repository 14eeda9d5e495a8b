// Materials, and which textures they need: an image becomes one texture for each way it is stored and sampled.
#include "stimuli/gltf/build.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// OpenGL's numbers, as glTF uses them.
enum { GL_NEAREST = 9728, GL_CLAMP_TO_EDGE = 33071, GL_MIRRORED_REPEAT = 33648 };

struct texture_list {
    uint32_t *images;
    float *cutoffs;
};

static enum scene_wrap wrap(int32_t mode)
{
    if (mode == GL_CLAMP_TO_EDGE)
        return SCENE_CLAMP;
    return mode == GL_MIRRORED_REPEAT ? SCENE_MIRROR : SCENE_REPEAT;
}

static int32_t find_texture(struct scene *scene, struct texture_list *list, uint32_t image,
                            const struct scene_texture *like, float cutoff)
{
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        const struct scene_texture *t = &scene->textures[i];
        if (list->images[i] == image && t->srgb == like->srgb && t->nearest == like->nearest &&
            t->wrap_u == like->wrap_u && t->wrap_v == like->wrap_v && list->cutoffs[i] == cutoff)
            return (int32_t)i;
    }
    list->images[scene->texture_count] = image;
    list->cutoffs[scene->texture_count] = cutoff;
    scene->textures[scene->texture_count] = *like;
    return (int32_t)scene->texture_count++;
}

// KHR_texture_transform: translation * rotation * scale, the rotation counter-clockwise with v down.
static void write_transform(const struct gltf_texture_use *use, float out[6])
{
    double c = cos(use->rotation), s = sin(use->rotation);
    const double t[6] = {use->scale[0] * c,  use->scale[1] * s, use->offset[0],
                         -use->scale[0] * s, use->scale[1] * c, use->offset[1]};
    for (int k = 0; k < 6; k++)
        out[k] = (float)t[k];
}

static struct scene_texture_use take_use(struct gltf_build *build, struct texture_list *list,
                                         const struct gltf_texture_use *use, enum scene_slot slot, float cutoff)
{
    const struct gltf_document *d = build->document;
    struct scene_texture_use out = {.texture = -1, .transform = {1, 0, 0, 0, 1, 0}};
    if (use->texture < 0 || d->textures[use->texture].image < 0)
        return out;
    if (use->uv_set > 1) {
        build->high_uv_sets++;
        return out;
    }
    const struct gltf_texture *texture = &d->textures[use->texture];
    struct scene_texture like = {.srgb = slot == SCENE_BASE_COLOUR || slot == SCENE_EMISSIVE};
    if (texture->sampler >= 0) {
        const struct gltf_sampler *sampler = &d->samplers[texture->sampler];
        like.nearest = sampler->mag_filter == GL_NEAREST;
        like.wrap_u = wrap(sampler->wrap_u);
        like.wrap_v = wrap(sampler->wrap_v);
    }
    out.texture = find_texture(build->scene, list, (uint32_t)texture->image, &like, cutoff);
    out.uv_set = (uint32_t)use->uv_set;
    write_transform(use, out.transform);
    return out;
}

static void take_material(struct gltf_build *build, struct texture_list *list, const struct gltf_material *m,
                          struct scene_material *out)
{
    snprintf(out->name, sizeof out->name, "%s", m->name);
    for (int k = 0; k < 4; k++)
        out->base_colour[k] = (float)m->base_colour[k];
    for (int k = 0; k < 3; k++)
        out->emissive[k] = (float)m->emissive[k];
    out->metallic = (float)m->metallic;
    out->roughness = (float)m->roughness;
    out->normal_scale = (float)m->normal_scale;
    out->occlusion_strength = (float)m->occlusion_strength;
    out->alpha_cutoff = (float)m->alpha_cutoff;
    out->alpha_mask = m->mask;
    out->double_sided = m->double_sided;
    for (int slot = 0; slot < SCENE_SLOTS; slot++) {
        // The texture's alpha is tested after the factor.
        float cutoff = m->mask && slot == SCENE_BASE_COLOUR && m->base_colour[3] > 0.0
                           ? (float)(m->alpha_cutoff / m->base_colour[3])
                           : 0.0f;
        out->use[slot] = take_use(build, list, &m->use[slot], (enum scene_slot)slot, cutoff);
    }
}

static bool needs_default(const struct gltf_document *d)
{
    for (uint32_t i = 0; i < d->primitive_count; i++)
        if (d->primitives[i].material < 0)
            return true;
    return d->material_count == 0;
}

// glTF 2.0, section 3.9.6, except that an all-metal default would be black under our sky: a matt light gray.
static const struct gltf_material default_material = {.name = "default",
                                                      .base_colour = {1, 1, 1, 1},
                                                      .metallic = 0,
                                                      .roughness = 1,
                                                      .normal_scale = 1,
                                                      .occlusion_strength = 1,
                                                      .alpha_cutoff = 0.5,
                                                      .use = {{.texture = -1, .scale = {1, 1}},
                                                              {.texture = -1, .scale = {1, 1}},
                                                              {.texture = -1, .scale = {1, 1}},
                                                              {.texture = -1, .scale = {1, 1}},
                                                              {.texture = -1, .scale = {1, 1}}}};

bool gltf_build_materials(struct gltf_build *build)
{
    const struct gltf_document *d = build->document;
    struct scene *scene = build->scene;
    size_t most = (size_t)d->material_count * SCENE_SLOTS + 1;
    struct texture_list list = {malloc(most * sizeof *list.images), malloc(most * sizeof *list.cutoffs)};
    scene->materials = calloc(d->material_count + 1u, sizeof *scene->materials);
    scene->textures = calloc(most, sizeof *scene->textures);
    gltf_at(&build->report, "materials");
    bool ok =
        list.images != NULL && list.cutoffs != NULL && scene->materials != NULL && scene->textures != NULL;
    if (!ok)
        gltf_fail(&build->report, "out of memory");
    for (uint32_t i = 0; ok && i < d->material_count; i++)
        take_material(build, &list, &d->materials[i], &scene->materials[scene->material_count++]);
    // Primitives without a material use the last one; see mesh.c.
    if (ok && needs_default(d))
        take_material(build, &list, &default_material, &scene->materials[scene->material_count++]);
    ok = ok && gltf_load_images(build, list.images, list.cutoffs);
    free(list.images);
    free(list.cutoffs);
    return ok;
}
