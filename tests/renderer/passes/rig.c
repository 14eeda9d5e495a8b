#include "tests/renderer/passes/rig.h"

#include "copy_texels.comp.h"
#include "copy_texels.comp_single.h"
#include "copy_words.comp.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct gpu_binding words_bindings[] = {{.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                                                    {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
static const struct gpu_binding texels_bindings[] = {{.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                                                     {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};

static void hear(void *user, int level, const char *sentence)
{
    struct rig *rig = user;
    (void)level;
    size_t used = strlen(rig->log);
    snprintf(rig->log + used, sizeof rig->log - used, "%s\n", sentence);
}

static void need(const struct rig *rig, bool ok, const char *what)
{
    if (!ok)
        fail_msg("%s: %s", what, rig->log);
}

bool rig_open(struct rig *rig)
{
    *rig = (struct rig){0};
    // the layer also checks that every pass waits for what it reads
    setenv("VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT", 1);
    rig->gpu = gpu_create(&(struct gpu_desc){.log = {hear, rig}, .validation = true});
    if (!rig->gpu) {
        fprintf(stderr, "%s", rig->log);
        return false;
    }
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    need(rig,
         gpu_buffer_create(rig->gpu, "frame", sizeof(struct shared_frame),
                           usage | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, GPU_HOST, &rig->frame) &&
             gpu_buffer_create(rig->gpu, "counters", sizeof(struct shared_counters), usage, GPU_HOST,
                               &rig->counters) &&
             gpu_kernel_create(rig->gpu,
                               &(struct gpu_kernel_desc){.name = "copy words",
                                                         .code = {copy_words_comp, sizeof copy_words_comp},
                                                         .bindings = words_bindings,
                                                         .binding_count = 2,
                                                         .push_bytes = sizeof(uint32_t)},
                               &rig->words) &&
             gpu_kernel_create(rig->gpu,
                               &(struct gpu_kernel_desc){.name = "copy texels",
                                                         .code = {copy_texels_comp, sizeof copy_texels_comp},
                                                         .bindings = texels_bindings,
                                                         .binding_count = 2},
                               &rig->texels) &&
             gpu_kernel_create(
                 rig->gpu,
                 &(struct gpu_kernel_desc){.name = "copy single texels",
                                           .code = {copy_texels_comp_single, sizeof copy_texels_comp_single},
                                           .bindings = texels_bindings,
                                           .binding_count = 2},
                 &rig->single_texels),
         "the rig");
    memset(rig->counters.mapped, 0, sizeof(struct shared_counters));
    return true;
}

void rig_close(struct rig *rig)
{
    gpu_kernel_destroy(rig->gpu, &rig->words);
    gpu_kernel_destroy(rig->gpu, &rig->texels);
    gpu_kernel_destroy(rig->gpu, &rig->single_texels);
    gpu_buffer_destroy(rig->gpu, &rig->frame);
    gpu_buffer_destroy(rig->gpu, &rig->counters);
    const uint32_t messages = rig->gpu->validation_messages;
    const uint64_t left = rig->gpu->allocated;
    gpu_destroy(rig->gpu);
    rig->gpu = NULL;
    need(rig, messages == 0, "the validation layer spoke");
    need(rig, strlen(rig->log) == 0, "the device logged");
    assert_int_equal(left, 0);
}

VkCommandBuffer rig_begin(struct rig *rig)
{
    VkCommandBuffer cmd = gpu_once_begin(rig->gpu);
    need(rig, cmd != VK_NULL_HANDLE, "commands");
    return cmd;
}

void rig_end(struct rig *rig, VkCommandBuffer cmd)
{
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT);
    need(rig, gpu_once_end(rig->gpu, cmd), "commands");
}

struct gpu_image rig_image(struct rig *rig, VkFormat format, uint32_t width, uint32_t height)
{
    struct gpu_image image;
    const VkImageUsageFlags usage =
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const struct gpu_image_desc desc = {.name = "test image",
                                        .format = format,
                                        .width = width,
                                        .height = height,
                                        .layers = EYES,
                                        .array = true,
                                        .usage = usage};
    need(rig, gpu_image_create(rig->gpu, &desc, &image), "an image");
    VkCommandBuffer cmd = rig_begin(rig);
    gpu_image_layout(cmd, &image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    rig_end(rig, cmd);
    return image;
}

static void copy(struct rig *rig, const struct gpu_image *image, VkImageLayout layout, uint32_t texel_bytes,
                 const void *from, void *to)
{
    struct gpu_buffer staging;
    const size_t size = (size_t)image->width * image->height * EYES * texel_bytes;
    need(rig,
         gpu_buffer_create(rig->gpu, "staging", size,
                           VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_HOST,
                           &staging),
         "staging");
    const VkImageAspectFlags aspect =
        image->format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    const VkBufferImageCopy region = {.imageSubresource = {aspect, 0, 0, EYES},
                                      .imageExtent = {image->width, image->height, 1}};
    if (from)
        memcpy(staging.mapped, from, size);
    VkCommandBuffer cmd = rig_begin(rig);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    if (from)
        vkCmdCopyBufferToImage(cmd, staging.buffer, image->image, layout, 1, &region);
    else
        vkCmdCopyImageToBuffer(cmd, image->image, layout, staging.buffer, 1, &region);
    rig_end(rig, cmd);
    if (to)
        memcpy(to, staging.mapped, size);
    gpu_buffer_destroy(rig->gpu, &staging);
}

struct gpu_image rig_sampled(struct rig *rig, VkFormat format, uint32_t width, uint32_t height,
                             uint32_t texel_bytes, const void *texels, VkImageLayout layout)
{
    struct gpu_image image;
    const struct gpu_image_desc desc = {.name = "test image, sampled",
                                        .format = format,
                                        .width = width,
                                        .height = height,
                                        .layers = EYES,
                                        .array = true,
                                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    need(rig, gpu_image_create(rig->gpu, &desc, &image), "a sampled image");
    VkCommandBuffer cmd = rig_begin(rig);
    gpu_image_layout(cmd, &image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    rig_end(rig, cmd);
    copy(rig, &image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, texel_bytes, texels, NULL);
    cmd = rig_begin(rig);
    gpu_image_layout(cmd, &image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
    rig_end(rig, cmd);
    return image;
}

void rig_upload(struct rig *rig, const struct gpu_image *image, uint32_t texel_bytes, const void *texels)
{
    copy(rig, image, VK_IMAGE_LAYOUT_GENERAL, texel_bytes, texels, NULL);
}

void rig_download(struct rig *rig, const struct gpu_image *image, uint32_t texel_bytes, void *out_texels)
{
    copy(rig, image, VK_IMAGE_LAYOUT_GENERAL, texel_bytes, NULL, out_texels);
}

static void dispatch_into(struct rig *rig, const struct gpu_kernel *kernel, const struct gpu_binding *bindings,
                          struct gpu_resource source, size_t bytes, const uint32_t *count,
                          const uint32_t groups[3], void *out)
{
    struct gpu_buffer to;
    need(rig,
         gpu_buffer_create(rig->gpu, "read back", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, GPU_HOST, &to),
         "a buffer");
    const struct gpu_resource resources[] = {source, {.buffer = &to}};
    VkDescriptorSet set = gpu_set_create(rig->gpu, kernel->set_layout, bindings, resources, 2);
    need(rig, set != VK_NULL_HANDLE, "a set");
    VkCommandBuffer cmd = rig_begin(rig);
    gpu_barrier(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    gpu_dispatch(cmd, kernel, set, count, count ? sizeof *count : 0, groups[0], groups[1], groups[2]);
    rig_end(rig, cmd);
    memcpy(out, to.mapped, bytes);
    gpu_set_free(rig->gpu, set);
    gpu_buffer_destroy(rig->gpu, &to);
}

void rig_read_level(struct rig *rig, const struct gpu_image *image, uint32_t level, float *out_rgba)
{
    const uint32_t width = image->width >> level ? image->width >> level : 1;
    const uint32_t height = image->height >> level ? image->height >> level : 1;
    VkImageView view = gpu_image_level_view(rig->gpu, image, level);
    need(rig, view != VK_NULL_HANDLE, "a view");
    const struct gpu_kernel *kernel =
        image->format == VK_FORMAT_R32_SFLOAT ? &rig->single_texels : &rig->texels;
    dispatch_into(rig, kernel, texels_bindings, (struct gpu_resource){.view = view},
                  (size_t)width * height * EYES * 4 * sizeof(float), NULL,
                  (const uint32_t[]){(width + 7) / 8, (height + 7) / 8, EYES}, out_rgba);
    vkDestroyImageView(rig->gpu->device, view, NULL);
}

void rig_read_words(struct rig *rig, const struct gpu_buffer *buffer, uint32_t count, void *out_words)
{
    dispatch_into(rig, &rig->words, words_bindings, (struct gpu_resource){.buffer = buffer},
                  count * sizeof(uint32_t), &count, (const uint32_t[]){(count + 63) / 64, 1, 1}, out_words);
}

struct rig_view rig_view_default(uint32_t width, uint32_t height)
{
    const struct pose head = {.orientation = {0, 0, 0, 1}};
    struct rig_view view = {.width = width, .height = height};
    for (int eye = 0; eye < EYES; eye++)
        view.eyes[eye] = (struct rig_eye){.pose = viewing_eye_pose(&head, eye, VIEWING_DEFAULT_IPD_M),
                                          .fov = viewing_symmetric_fov(VIEWING_DEFAULT_FOV_DEG, width, height)};
    return view;
}

static void store(float *out, struct dvec3 v, double w)
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
    out[3] = (float)w;
}

static void fill_eye(struct shared_eye *out, const struct rig_eye *eye, struct dvec3 origin)
{
    const struct viewing_fov *f = &eye->fov;
    const struct dvec3 position = dvec3_sub(eye->pose.position, origin);
    const struct dmat4 world = dmat4_compose(position, eye->pose.orientation, (struct dvec3){1, 1, 1});
    for (int i = 0; i < 16; i++)
        out->world_from_eye[i] = (float)world.m[i];
    const double tangents[] = {f->tan_left, f->tan_right, f->tan_down, f->tan_up};
    for (int i = 0; i < 4; i++)
        out->tangents[i] = (float)tangents[i];
    const struct fmat4 projection =
        geometry_projection(f->tan_left, f->tan_right, f->tan_down, f->tan_up, VIEWING_NEAR_M);
    const struct fmat4 view = geometry_view(&eye->pose, origin), clip = fmat4_multiply(&projection, &view);
    memcpy(out->clip_from_world, clip.m, sizeof clip.m);
    const bool gaze = isfinite(eye->gaze_x_deg) && isfinite(eye->gaze_y_deg);
    if (gaze)
        store(out->gaze, viewing_direction(eye->gaze_x_deg, eye->gaze_y_deg), 1);
    // a side's plane holds the eye and the two corner rays of that side
    const struct dvec3 inward[4] = {
        {1, 0, -f->tan_left}, {-1, 0, -f->tan_right}, {0, 1, -f->tan_down}, {0, -1, -f->tan_up}};
    for (int i = 0; i < 4; i++) {
        struct dvec3 n = dquat_rotate(eye->pose.orientation, dvec3_normalise(inward[i]));
        store(out->planes[i], n, -dvec3_dot(n, position));
    }
    struct dvec3 forward = dquat_rotate(eye->pose.orientation, (struct dvec3){0, 0, -1});
    store(out->forward, forward, -dvec3_dot(forward, position));
}

void rig_frame(struct rig *rig, const struct rig_view *view)
{
    struct shared_frame *out = rig->frame.mapped;
    *out = (struct shared_frame){
        .width = view->width, .height = view->height, .near_m = (float)VIEWING_NEAR_M, .moving = 1};
    for (int eye = 0; eye < EYES; eye++)
        fill_eye(&out->eyes[eye], &view->eyes[eye], view->origin);
    store(out->origin_shift, dvec3_sub(view->last_origin, view->origin), 0);
}

uint64_t rig_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

double rig_uniform(uint64_t *state, double low, double high)
{
    return low + (high - low) * ((double)(rig_random(state) >> 11) * 0x1p-53);
}

uint64_t rig_below(uint64_t *state, uint64_t bound)
{
    return rig_random(state) % bound;
}

struct dquat rig_turn(uint64_t *state, double most_rad)
{
    struct dvec3 axis = {rig_uniform(state, -1, 1), rig_uniform(state, -1, 1), rig_uniform(state, -1, 1)};
    const double half = rig_uniform(state, -0.5, 0.5) * most_rad;
    axis = dvec3_scale(dvec3_normalise(axis), sin(half));
    return dquat_normalise((struct dquat){axis.x, axis.y, axis.z, cos(half)});
}
