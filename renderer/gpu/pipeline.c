#include "renderer/gpu/gpu.h"

VkDescriptorSetLayout gpu_set_layout_create(struct gpu *gpu, const struct gpu_binding *bindings, uint32_t count)
{
    VkDescriptorSetLayoutBinding list[GPU_BINDINGS];
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!bindings[i].absent)
            list[used++] = (VkDescriptorSetLayoutBinding){
                .binding = i,
                .descriptorType = bindings[i].type,
                .descriptorCount = 1,
                .stageFlags = bindings[i].stages ? bindings[i].stages : VK_SHADER_STAGE_COMPUTE_BIT};
    }
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = used, .pBindings = list};
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    return VK(gpu, vkCreateDescriptorSetLayout(gpu->device, &info, NULL, &layout)) ? layout : VK_NULL_HANDLE;
}

static VkShaderModule make_module(struct gpu *gpu, struct gpu_code code)
{
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = code.bytes, .pCode = code.words};
    VkShaderModule module = VK_NULL_HANDLE;
    return VK(gpu, vkCreateShaderModule(gpu->device, &info, NULL, &module)) ? module : VK_NULL_HANDLE;
}

struct specialisation {
    VkSpecializationMapEntry entries[GPU_BINDINGS];
    VkSpecializationInfo info;
};

static const VkSpecializationInfo *specialise(struct specialisation *s, const int32_t *constants,
                                              uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        s->entries[i] = (VkSpecializationMapEntry){i, i * (uint32_t)sizeof(int32_t), sizeof(int32_t)};
    s->info = (VkSpecializationInfo){count, s->entries, count * sizeof(int32_t), constants};
    return &s->info;
}

VkSampler gpu_sampler_create_plain(struct gpu *gpu)
{
    return gpu_sampler_create(gpu, VK_FILTER_NEAREST, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                              VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 1);
}

bool gpu_kernel_create(struct gpu *gpu, const struct gpu_kernel_desc *desc, struct gpu_kernel *out)
{
    *out = (struct gpu_kernel){0};
    VkShaderModule module = make_module(gpu, desc->code);
    out->set_layout = gpu_set_layout_create(gpu, desc->bindings, desc->binding_count);
    if (!module || !out->set_layout)
        goto error;
    const VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &out->set_layout,
        .pushConstantRangeCount = desc->push_bytes ? 1 : 0,
        .pPushConstantRanges = &(VkPushConstantRange){VK_SHADER_STAGE_COMPUTE_BIT, 0, desc->push_bytes},
    };
    if (!VK(gpu, vkCreatePipelineLayout(gpu->device, &layout, NULL, &out->layout)))
        goto error;
    struct specialisation specialisation;
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = specialise(&specialisation, desc->constants, desc->constant_count)},
        .layout = out->layout,
    };
    if (!VK(gpu, vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &out->pipeline)))
        goto error;
    gpu_name(gpu, VK_OBJECT_TYPE_PIPELINE, (uint64_t)out->pipeline, desc->name);
    vkDestroyShaderModule(gpu->device, module, NULL);
    return true;
error:
    vkDestroyShaderModule(gpu->device, module, NULL);
    gpu_kernel_destroy(gpu, out);
    return false;
}

void gpu_kernel_destroy(struct gpu *gpu, struct gpu_kernel *kernel)
{
    vkDestroyPipeline(gpu->device, kernel->pipeline, NULL);
    vkDestroyPipelineLayout(gpu->device, kernel->layout, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, kernel->set_layout, NULL);
    *kernel = (struct gpu_kernel){0};
}

VkDescriptorSet gpu_set_create(struct gpu *gpu, VkDescriptorSetLayout layout,
                               const struct gpu_binding *bindings, const struct gpu_resource *resources,
                               uint32_t count)
{
    const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = gpu->descriptors,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    if (!VK(gpu, vkAllocateDescriptorSets(gpu->device, &info, &set)))
        return VK_NULL_HANDLE;
    VkWriteDescriptorSet writes[GPU_BINDINGS];
    VkDescriptorBufferInfo buffers[GPU_BINDINGS];
    VkDescriptorImageInfo images[GPU_BINDINGS];
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct gpu_resource *r = &resources[i];
        if (bindings[i].absent)
            continue;
        if (r->buffer)
            buffers[i] = (VkDescriptorBufferInfo){r->buffer->buffer, 0, VK_WHOLE_SIZE};
        else
            images[i] =
                (VkDescriptorImageInfo){r->sampler, r->view, r->layout ? r->layout : VK_IMAGE_LAYOUT_GENERAL};
        writes[used++] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                                .dstSet = set,
                                                .dstBinding = i,
                                                .descriptorCount = 1,
                                                .descriptorType = bindings[i].type,
                                                .pImageInfo = &images[i],
                                                .pBufferInfo = &buffers[i]};
    }
    vkUpdateDescriptorSets(gpu->device, used, writes, 0, NULL);
    return set;
}

void gpu_set_free(struct gpu *gpu, VkDescriptorSet set)
{
    if (set)
        vkFreeDescriptorSets(gpu->device, gpu->descriptors, 1, &set);
}

static void bind_kernel(VkCommandBuffer cmd, const struct gpu_kernel *kernel, VkDescriptorSet set,
                        const void *push, uint32_t push_bytes)
{
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, kernel->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, kernel->layout, 0, 1, &set, 0, NULL);
    if (push_bytes)
        vkCmdPushConstants(cmd, kernel->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes, push);
}

void gpu_dispatch(VkCommandBuffer cmd, const struct gpu_kernel *kernel, VkDescriptorSet set, const void *push,
                  uint32_t push_bytes, uint32_t groups_x, uint32_t groups_y, uint32_t groups_z)
{
    bind_kernel(cmd, kernel, set, push, push_bytes);
    vkCmdDispatch(cmd, groups_x, groups_y, groups_z);
}

void gpu_dispatch_indirect(VkCommandBuffer cmd, const struct gpu_kernel *kernel, VkDescriptorSet set,
                           const void *push, uint32_t push_bytes, const struct gpu_buffer *groups)
{
    bind_kernel(cmd, kernel, set, push, push_bytes);
    vkCmdDispatchIndirect(cmd, groups->buffer, 0);
}

VkPipeline gpu_raster_create(struct gpu *gpu, const struct gpu_raster_desc *desc)
{
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkShaderModule vertex = make_module(gpu, desc->vertex);
    VkShaderModule fragment = desc->fragment.words ? make_module(gpu, desc->fragment) : VK_NULL_HANDLE;
    struct specialisation specialisation;
    const VkSpecializationInfo *special = specialise(&specialisation, desc->constants, desc->constant_count);
    const VkPipelineShaderStageCreateInfo stages[] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main",
         .pSpecializationInfo = special},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main",
         .pSpecializationInfo = special},
    };
    VkPipelineColorBlendAttachmentState blends[GPU_ATTACHMENTS];
    for (uint32_t i = 0; i < desc->colour_count; i++)
        blends[i] = (VkPipelineColorBlendAttachmentState){.colorWriteMask = 0xf};
    const VkDynamicState dynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                      VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};
    const VkPipelineRenderingCreateInfo rendering = {.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                     .viewMask = desc->view_mask,
                                                     .colorAttachmentCount = desc->colour_count,
                                                     .pColorAttachmentFormats = desc->colour_formats,
                                                     .depthAttachmentFormat = desc->depth_format};
    const VkPipelineFragmentShadingRateStateCreateInfoKHR rate = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_FRAGMENT_SHADING_RATE_STATE_CREATE_INFO_KHR,
        .pNext = &rendering,
        .fragmentSize = {1, 1},
        .combinerOps = {VK_FRAGMENT_SHADING_RATE_COMBINER_OP_KEEP_KHR,
                        VK_FRAGMENT_SHADING_RATE_COMBINER_OP_REPLACE_KHR}};
    const VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = desc->shading_rate ? (const void *)&rate : &rendering,
        .flags = desc->shading_rate ? VK_PIPELINE_CREATE_RENDERING_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR : 0,
        .stageCount = fragment ? 2 : 1,
        .pStages = stages,
        .pVertexInputState =
            &(VkPipelineVertexInputStateCreateInfo){
                .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                .vertexBindingDescriptionCount = desc->vertex_binding ? 1 : 0,
                .pVertexBindingDescriptions = desc->vertex_binding,
                .vertexAttributeDescriptionCount = desc->attribute_count,
                .pVertexAttributeDescriptions = desc->attributes},
        .pInputAssemblyState =
            &(VkPipelineInputAssemblyStateCreateInfo){
                .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
                .topology =
                    desc->points ? VK_PRIMITIVE_TOPOLOGY_POINT_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST},
        .pViewportState =
            &(VkPipelineViewportStateCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                                 .viewportCount = 1,
                                                 .scissorCount = 1},
        .pRasterizationState =
            &(VkPipelineRasterizationStateCreateInfo){
                .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
                .polygonMode = VK_POLYGON_MODE_FILL,
                .depthBiasEnable = desc->slope_bias != 0,
                .depthBiasSlopeFactor = desc->slope_bias,
                .lineWidth = 1},
        .pMultisampleState =
            &(VkPipelineMultisampleStateCreateInfo){
                .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT},
        .pDepthStencilState =
            &(VkPipelineDepthStencilStateCreateInfo){
                .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                .depthTestEnable = desc->depth_format != VK_FORMAT_UNDEFINED,
                .depthWriteEnable = desc->depth_format != VK_FORMAT_UNDEFINED && !desc->keep_depth,
                .depthCompareOp = desc->depth_compare},
        .pColorBlendState =
            &(VkPipelineColorBlendStateCreateInfo){.sType =
                                                       VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                   .attachmentCount = desc->colour_count,
                                                   .pAttachments = blends},
        .pDynamicState =
            &(VkPipelineDynamicStateCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                .dynamicStateCount = countof(dynamic),
                                                .pDynamicStates = dynamic},
        .layout = desc->layout,
    };
    if (vertex && (fragment || !desc->fragment.words) &&
        VK(gpu, vkCreateGraphicsPipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline)))
        gpu_name(gpu, VK_OBJECT_TYPE_PIPELINE, (uint64_t)pipeline, desc->name);
    vkDestroyShaderModule(gpu->device, vertex, NULL);
    vkDestroyShaderModule(gpu->device, fragment, NULL);
    return pipeline;
}

VkSampler gpu_sampler_create(struct gpu *gpu, VkFilter min, VkFilter mag, VkSamplerAddressMode u,
                             VkSamplerAddressMode v, float anisotropy)
{
    const VkSamplerCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = mag,
        .minFilter = min,
        .mipmapMode = min == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST,
        .addressModeU = u,
        .addressModeV = v,
        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        .anisotropyEnable = anisotropy > 1,
        .maxAnisotropy = anisotropy,
        .maxLod = VK_LOD_CLAMP_NONE,
    };
    VkSampler sampler = VK_NULL_HANDLE;
    return VK(gpu, vkCreateSampler(gpu->device, &info, NULL, &sampler)) ? sampler : VK_NULL_HANDLE;
}

VkSampler gpu_sampler_create_compare(struct gpu *gpu)
{
    VkFormatProperties format;
    vkGetPhysicalDeviceFormatProperties(gpu->physical, VK_FORMAT_D32_SFLOAT, &format);
    const bool blends = format.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    const VkSamplerCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = blends ? VK_FILTER_LINEAR : VK_FILTER_NEAREST,
        .minFilter = blends ? VK_FILTER_LINEAR : VK_FILTER_NEAREST,
        .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
        .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
        .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
        .compareEnable = VK_TRUE,
        .compareOp = VK_COMPARE_OP_LESS_OR_EQUAL,
        .borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE,
    };
    VkSampler sampler = VK_NULL_HANDLE;
    return VK(gpu, vkCreateSampler(gpu->device, &info, NULL, &sampler)) ? sampler : VK_NULL_HANDLE;
}
