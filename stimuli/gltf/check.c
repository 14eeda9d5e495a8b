#include "stimuli/gltf/check.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

bool gltf_uses(const struct gltf_document *d, const char *extension)
{
    for (uint32_t i = 0; i < d->extension_used_count; i++)
        if (strcmp(d->extensions_used[i], extension) == 0)
            return true;
    return false;
}

bool gltf_check_index(int32_t index, uint32_t count, const char *table, const struct gltf_report *report)
{
    if (index == -1 || (index >= 0 && (uint32_t)index < count))
        return true;
    return gltf_fail(report, "names %s %d, the file has %u", table, index, count);
}

static bool check_extensions(const struct gltf_document *d, struct gltf_report *report)
{
    static const char *const known[] = {"KHR_lights_punctual", "KHR_texture_transform", "KHR_mesh_quantization",
                                        "KHR_materials_emissive_strength"};
    gltf_at(report, "extensionsRequired");
    for (uint32_t i = 0; i < d->extension_required_count; i++) {
        bool found = false;
        for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
            found = found || strcmp(d->extensions_required[i], known[k]) == 0;
        if (!found)
            return gltf_fail(report, "the file cannot be shown without '%.80s', which we do not read",
                             d->extensions_required[i]);
    }
    return true;
}

static bool check_views(const struct gltf_document *d, struct gltf_report *report)
{
    for (uint32_t i = 0; i < d->view_count; i++) {
        const struct gltf_view *view = &d->views[i];
        gltf_at(report, "bufferViews[%u]", i);
        if (view->buffer < 0 || (uint32_t)view->buffer >= d->buffer_count)
            return gltf_fail(report, "names buffer %d, the file has %u", view->buffer, d->buffer_count);
        uint64_t held = d->buffers[view->buffer].size;
        if (view->length == 0)
            return gltf_fail(report, "has no bytes");
        if (view->offset > held || view->length > held - view->offset)
            return gltf_fail(report, "reaches %" PRIu64 " bytes past buffer %d",
                             view->offset + view->length - held, view->buffer);
    }
    return true;
}

static bool check_images(const struct gltf_document *d, struct gltf_report *report)
{
    for (uint32_t i = 0; i < d->texture_count; i++) {
        gltf_at(report, "textures[%u]", i);
        if (!gltf_check_index(d->textures[i].image, d->image_count, "image", report) ||
            !gltf_check_index(d->textures[i].sampler, d->sampler_count, "sampler", report))
            return false;
    }
    for (uint32_t i = 0; i < d->image_count; i++) {
        const struct gltf_image *image = &d->images[i];
        gltf_at(report, "images[%u]", i);
        if (!gltf_check_index(image->view, d->view_count, "bufferView", report))
            return false;
        if (image->view == -1 && image->bytes.size == 0)
            return gltf_fail(report, "uri '%.200s' gives no bytes", image->uri);
    }
    return true;
}

static bool in_range(double value, double low, double high)
{
    return value >= low && value <= high;
}

static bool check_numbers(const struct gltf_material *m, const struct gltf_report *report)
{
    for (int i = 0; i < 4; i++)
        if (!in_range(m->base_colour[i], 0.0, 1.0))
            return gltf_fail(report, "baseColorFactor[%d] is %g, not from 0 to 1", i, m->base_colour[i]);
    for (int i = 0; i < 3; i++)
        if (!in_range(m->emissive[i], 0.0, 1e9))
            return gltf_fail(report, "emissiveFactor[%d] is %g, not from 0 to 1e9", i, m->emissive[i]);
    if (!in_range(m->metallic, 0.0, 1.0) || !in_range(m->roughness, 0.0, 1.0))
        return gltf_fail(report, "metallicFactor %g or roughnessFactor %g is not from 0 to 1", m->metallic,
                         m->roughness);
    if (!in_range(m->alpha_cutoff, 0.0, 1e6))
        return gltf_fail(report, "alphaCutoff is %g, not 0 or more", m->alpha_cutoff);
    if (!in_range(m->normal_scale, -1e3, 1e3))
        return gltf_fail(report, "normalTexture.scale is %g, not from -1000 to 1000", m->normal_scale);
    if (!in_range(m->occlusion_strength, 0.0, 1.0))
        return gltf_fail(report, "occlusionTexture.strength is %g, not from 0 to 1", m->occlusion_strength);
    return true;
}

static bool check_materials(const struct gltf_document *d, struct gltf_report *report)
{
    for (uint32_t i = 0; i < d->material_count; i++) {
        gltf_at(report, "materials[%u]", i);
        if (!check_numbers(&d->materials[i], report))
            return false;
        for (int slot = 0; slot < 5; slot++) {
            const struct gltf_texture_use *use = &d->materials[i].use[slot];
            if (!gltf_check_index(use->texture, d->texture_count, "texture", report))
                return false;
            if (use->uv_set < 0)
                return gltf_fail(report, "texCoord is %d", use->uv_set);
            const double transform[5] = {use->offset[0], use->offset[1], use->scale[0], use->scale[1],
                                         use->rotation};
            for (int k = 0; k < 5; k++)
                if (!in_range(transform[k], -1e6, 1e6))
                    return gltf_fail(report, "KHR_texture_transform has the number %g, not from -1e6 to 1e6",
                                     transform[k]);
        }
    }
    return true;
}

static bool check_lights(const struct gltf_document *d, struct gltf_report *report)
{
    for (uint32_t i = 0; i < d->light_count; i++) {
        const struct gltf_light *light = &d->lights[i];
        gltf_at(report, "extensions.KHR_lights_punctual.lights[%u]", i);
        if (strcmp(light->type, "directional") != 0 && strcmp(light->type, "point") != 0 &&
            strcmp(light->type, "spot") != 0)
            return gltf_fail(report, "type '%.40s' is not directional, point or spot", light->type);
        for (int k = 0; k < 3; k++)
            if (!in_range(light->colour[k], 0.0, 1e6))
                return gltf_fail(report, "color[%d] is %g, not 0 or more", k, light->colour[k]);
        if (!in_range(light->intensity, 0.0, 1e12))
            return gltf_fail(report, "intensity is %g, not 0 or more", light->intensity);
        if (!in_range(light->range, 0.0, 1e9))
            return gltf_fail(report, "range is %g, not above 0", light->range);
        if (!in_range(light->inner_angle, 0.0, light->outer_angle) ||
            !in_range(light->outer_angle, 0.0, 1.5707964))
            return gltf_fail(report, "spot angles %g and %g are not rising within 0 to pi / 2",
                             light->inner_angle, light->outer_angle);
    }
    return true;
}

bool gltf_check(const struct gltf_document *document, char *error, size_t error_size)
{
    struct gltf_report report = {.error = error, .error_size = error_size};
    return check_extensions(document, &report) && check_views(document, &report) &&
           check_images(document, &report) && check_materials(document, &report) &&
           check_lights(document, &report) && gltf_check_nodes(document, &report) &&
           gltf_check_meshes(document, &report) && gltf_check_animation(document, &report);
}
