#include "renderer/passes/motion/motion.h"

#include "motion.comp.h"
#include "motion.comp_id.h"

bool motion_init(struct motion *m, const struct motion_desc *desc)
{
    *m = (struct motion){.gpu = desc->gpu,
                         .width = desc->width,
                         .height = desc->height,
                         .motion_count = desc->scene->motion_count};
    const struct gpu_binding bindings[] = {
        {.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},                              // frame
        {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},                              // motions
        {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},                      // depth
        {.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, .absent = !desc->id}, // id
        {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},                               // motion
        {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},                              // counters
    };
    const struct gpu_kernel_desc kernel = {
        .name = "motion vectors",
        .code = desc->id ? (struct gpu_code){motion_comp_id, sizeof motion_comp_id}
                         : (struct gpu_code){motion_comp, sizeof motion_comp},
        .bindings = bindings,
        .binding_count = countof(bindings),
        .push_bytes = sizeof(uint32_t)};
    const struct gpu_image_desc image = {.name = "motion vectors",
                                         .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                         .width = desc->width,
                                         .height = desc->height,
                                         .layers = 2,
                                         .array = true,
                                         .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    m->sampler = gpu_sampler_create_plain(m->gpu);
    if (!m->sampler || !gpu_image_create(m->gpu, &image, &m->image) ||
        !gpu_kernel_create(m->gpu, &kernel, &m->kernel))
        return false;
    const struct gpu_resource resources[] = {
        {.buffer = desc->frame},
        {.buffer = &desc->scene->motions},
        {.view = desc->depth, .sampler = m->sampler, .layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
        {.view = desc->id, .sampler = m->sampler, .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
        {.view = m->image.view},
        {.buffer = desc->counters}};
    m->set = gpu_set_create(m->gpu, m->kernel.set_layout, bindings, resources, countof(bindings));
    return m->set;
}

void motion_finish(struct motion *m)
{
    if (!m->gpu)
        return;
    gpu_set_free(m->gpu, m->set);
    gpu_kernel_destroy(m->gpu, &m->kernel);
    gpu_image_destroy(m->gpu, &m->image);
    vkDestroySampler(m->gpu->device, m->sampler, NULL);
    *m = (struct motion){0};
}

void motion_record(const struct motion *m, VkCommandBuffer cmd)
{
    gpu_image_layout(cmd, &m->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    gpu_dispatch(cmd, &m->kernel, m->set, &m->motion_count, sizeof m->motion_count,
                 (m->width + SHARED_TILE - 1) / SHARED_TILE, (m->height + SHARED_TILE - 1) / SHARED_TILE, 2);
}
