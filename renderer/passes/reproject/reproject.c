#include "renderer/passes/reproject/reproject.h"

#include "renderer/shared/shared.h"

#include "resolve.comp.h"
#include "splat.comp.h"

static const struct gpu_binding splat_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // motions
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // keys
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // position, read
};

static const struct gpu_binding resolve_bindings[] = {
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // frame
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // motions
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, // keys
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // position, read
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // colour, read
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // position, written
    {.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},  // colour, written
};

bool reproject_init(struct reproject *r, const struct reproject_desc *desc)
{
    *r = (struct reproject){.gpu = desc->gpu, .width = desc->width, .height = desc->height};
    const struct gpu_kernel_desc splat = {.name = "splat",
                                          .code = {splat_comp, sizeof splat_comp},
                                          .bindings = splat_bindings,
                                          .binding_count = countof(splat_bindings),
                                          .push_bytes = sizeof(float)};
    const struct gpu_kernel_desc resolve = {.name = "resolve",
                                            .code = {resolve_comp, sizeof resolve_comp},
                                            .bindings = resolve_bindings,
                                            .binding_count = countof(resolve_bindings)};
    if (!gpu_buffer_create(r->gpu, "splat keys", 2ull * r->width * r->height * sizeof(uint64_t),
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_DEVICE,
                           &r->keys) ||
        !gpu_kernel_create(r->gpu, &splat, &r->splat) || !gpu_kernel_create(r->gpu, &resolve, &r->resolve))
        return false;
    for (uint32_t from = 0; from < 2; from++) {
        const struct gpu_resource resources[] = {
            {.buffer = desc->frame},          {.buffer = desc->motions},    {.buffer = &r->keys},
            {.view = desc->position[from]},   {.view = desc->colour[from]}, {.view = desc->position[1 - from]},
            {.view = desc->colour[1 - from]},
        };
        r->splat_sets[from] =
            gpu_set_create(r->gpu, r->splat.set_layout, splat_bindings, resources, countof(splat_bindings));
        r->resolve_sets[from] = gpu_set_create(r->gpu, r->resolve.set_layout, resolve_bindings, resources,
                                               countof(resolve_bindings));
        if (!r->splat_sets[from] || !r->resolve_sets[from])
            return false;
    }
    return true;
}

void reproject_finish(struct reproject *r)
{
    if (!r->gpu)
        return;
    for (uint32_t i = 0; i < 2; i++) {
        gpu_set_free(r->gpu, r->splat_sets[i]);
        gpu_set_free(r->gpu, r->resolve_sets[i]);
    }
    gpu_kernel_destroy(r->gpu, &r->splat);
    gpu_kernel_destroy(r->gpu, &r->resolve);
    gpu_buffer_destroy(r->gpu, &r->keys);
    *r = (struct reproject){0};
}

void reproject_record(const struct reproject *r, VkCommandBuffer cmd, uint32_t from, float drop_deg)
{
    const VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    const uint32_t x = (r->width + SHARED_TILE - 1) / SHARED_TILE,
                   y = (r->height + SHARED_TILE - 1) / SHARED_TILE;
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    vkCmdFillBuffer(cmd, r->keys.buffer, 0, VK_WHOLE_SIZE, 0);
    // whether a fill is a clear or a copy is read both ways; all transfers cover it
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, compute);
    gpu_dispatch(cmd, &r->splat, r->splat_sets[from], &drop_deg, sizeof drop_deg, x, y, 2);
    gpu_barrier(cmd, compute, compute);
    gpu_dispatch(cmd, &r->resolve, r->resolve_sets[from], NULL, 0, x, y, 2);
    gpu_barrier(cmd, compute, compute);
}
