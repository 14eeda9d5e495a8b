#include "renderer/renderer_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void renderer_relay(void *user, int level, const char *sentence)
{
    const struct renderer *r = user;
    if (r->log.write)
        r->log.write(r->log.user, (enum renderer_log_level)level, sentence);
}

struct renderer *renderer_create(const struct renderer_desc *desc)
{
    struct renderer *r = calloc(1, sizeof *r);
    if (!r)
        return NULL;
    r->log = desc->log;
    r->width = desc->width;
    r->height = desc->height;
    if (r->width < 16 || r->height < 16 || r->width > 16384 || r->height > 16384) {
        renderer_relay(r, RENDERER_ERROR, "an eye's size must be from 16x16 to 16384x16384 pixels");
        goto error;
    }
    r->gpu = gpu_create(&(struct gpu_desc){.log = {renderer_relay, r},
                                           .device = desc->device,
                                           .validation = desc->validation,
                                           .anisotropy = desc->anisotropy,
                                           .create_surface = desc->create_surface,
                                           .surface_user = desc->surface_user,
                                           .instance_extensions = desc->instance_extensions,
                                           .instance_extension_count = desc->instance_extension_count});
    if (!r->gpu)
        goto error;
    snprintf(r->device.name, sizeof r->device.name, "%s", r->gpu->properties.deviceName);
    snprintf(r->device.driver, sizeof r->device.driver, "%s %s", r->gpu->driver.driverName,
             r->gpu->driver.driverInfo);
    r->device.software = r->gpu->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (!gpu_frame_init(&r->frame, r->gpu, desc->pass_times) ||
        !screen_init(&r->screen, r->gpu, r->width, r->height))
        goto error;
    if (desc->create_surface && !(r->present = gpu_present_create(r->gpu)))
        goto error;
    return r;
error:
    renderer_destroy(r);
    return NULL;
}

void renderer_destroy(struct renderer *r)
{
    if (!r)
        return;
    gpu_present_destroy(r->present);
    screen_finish(&r->screen);
    gpu_frame_finish(&r->frame);
    gpu_destroy(r->gpu);
    free(r);
}

const struct renderer_device *renderer_device(const struct renderer *r)
{
    return &r->device;
}

uint32_t renderer_validation_messages(const struct renderer *r)
{
    return r->gpu->validation_messages;
}

struct renderer_scene *renderer_scene_create(struct renderer *r, const struct scene *scene)
{
    struct renderer_scene *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->renderer = r;
    s->gpu = scene_gpu_create(r->gpu, scene);
    if (s->gpu && shadow_init(&s->shadow, r->gpu, s->gpu))
        return s;
    renderer_scene_destroy(s);
    return NULL;
}

void renderer_scene_destroy(struct renderer_scene *scene)
{
    if (!scene)
        return;
    shadow_finish(&scene->shadow);
    scene_gpu_destroy(scene->gpu);
    free(scene);
}

static void explain_textures(struct renderer_option *o)
{
    const struct scene *scene = o->scene->gpu->scene;
    const double anisotropy = (double)o->renderer->gpu->anisotropy;
    if (scene->texture_count && anisotropy > 1)
        mode_explain(&o->explanation, 0, "textures are filtered anisotropically, %g to 1", anisotropy);
    else if (scene->texture_count)
        mode_explain(
            &o->explanation, 0,
            "textures are filtered isotropically, since the device is a software driver or 1 was asked for");
}

static void explain_shadow(struct renderer_option *o)
{
    const struct shadow *s = &o->scene->shadow;
    if (s->map.view)
        mode_explain(&o->explanation, s->map.bytes,
                     "sun shadows of what stands still, drawn once with the scene, %ux%u texels of %.1f cm",
                     s->map.width, s->map.height, 100 * s->texel_m);
    else
        mode_explain(&o->explanation, 0, "no sun shadows, there is no sun or nothing stands still");
}

struct renderer_option *renderer_option_create(struct renderer *r, struct renderer_scene *scene,
                                               const struct mode_choice *choice,
                                               const struct renderer_settings *settings)
{
    char why[512];
    if ((choice->mode->supported && !choice->mode->supported(r->gpu, choice->values, why, sizeof why)) ||
        !mode_check(choice, why, sizeof why)) {
        renderer_relay(r, RENDERER_ERROR, why);
        return NULL;
    }
    struct renderer_option *o = calloc(1, sizeof *o);
    if (!o)
        return NULL;
    o->renderer = r;
    o->scene = scene;
    o->mode = choice->mode;
    memcpy(o->values, choice->values, sizeof o->values);
    o->settings = settings ? *settings : (struct renderer_settings){0};
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const struct mode_setup setup = {.gpu = r->gpu,
                                     .scene = scene->gpu,
                                     .shadow_map = scene->shadow.map.view,
                                     .width = r->width,
                                     .height = r->height,
                                     .values = choice->values,
                                     .settings = o->settings,
                                     .frame = &o->constants,
                                     .counters = &o->counters,
                                     .explanation = &o->explanation};
    explain_shadow(o);
    explain_textures(o);
    if (gpu_buffer_create(r->gpu, "frame constants", sizeof(struct shared_frame),
                          usage | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, GPU_HOST, &o->constants) &&
        gpu_buffer_create(r->gpu, "counters", sizeof(struct shared_counters), usage, GPU_HOST, &o->counters) &&
        (o->state = choice->mode->create(&setup)))
        return o;
    renderer_option_destroy(o);
    return NULL;
}

static bool can_set(const struct renderer_option *o, const struct mode_choice *choice, char *why,
                    size_t why_size)
{
    if (choice->mode != o->mode || !o->mode->set || !o->settings.adjustable) {
        snprintf(why, why_size, "an option of mode '%s' that was not made to be changed is to be",
                 o->mode->name);
        return false;
    }
    for (uint32_t i = 0; i < o->mode->parameter_count; i++) {
        const struct mode_parameter *p = &o->mode->parameters[i];
        const double value = choice->values[i];
        const bool same = !(value < o->values[i]) && !(value > o->values[i]);
        if (!(value >= p->min && value <= p->max) || (p->choices && !same)) {
            snprintf(why, why_size, "%s of mode '%s' cannot become %g while it runs", p->name, o->mode->name,
                     value);
            return false;
        }
    }
    return mode_check(choice, why, why_size);
}

bool renderer_option_set(struct renderer_option *o, const struct mode_choice *choice)
{
    char why[512];
    if (!can_set(o, choice, why, sizeof why)) {
        renderer_relay(o->renderer, RENDERER_ERROR, why);
        return false;
    }
    if (!o->mode->set(o->state, choice->values))
        return false;
    memcpy(o->values, choice->values, sizeof o->values);
    return true;
}

void renderer_option_destroy(struct renderer_option *o)
{
    if (!o)
        return;
    vkDeviceWaitIdle(o->renderer->gpu->device);
    o->mode->destroy(o->state);
    gpu_buffer_destroy(o->renderer->gpu, &o->constants);
    gpu_buffer_destroy(o->renderer->gpu, &o->counters);
    free(o);
}

bool renderer_option_explain(const struct renderer_option *o, char *out, size_t out_size)
{
    int n = snprintf(out, out_size, "%s%9.2f MiB  in all, %s\n", o->explanation.text,
                     (double)o->explanation.bytes / 1048576, o->mode->name);
    return n >= 0 && (size_t)n < out_size;
}

uint64_t renderer_option_memory(const struct renderer_option *o)
{
    return o->explanation.bytes;
}

uint64_t renderer_memory(const struct renderer *r)
{
    return r->gpu->allocated;
}
