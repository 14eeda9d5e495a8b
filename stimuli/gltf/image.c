// PNG and JPEG files as textures with mip maps, on two threads: decoding is most of a large scene's loading
// time.
//
// Only these two formats reach stb_image; its readers of other formats have known faults with hostile files.
#include "stimuli/gltf/build.h"

#include <inttypes.h>
#include <pthread.h>
#include <stb_image.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORKERS = 2 };

struct jobs {
    const struct gltf_document *document;
    struct scene *scene;
    const uint32_t *images;
    const float *cutoffs;
    atomic_uint next;
    atomic_uint first_failed; // texture; scene->texture_count for none
};

static struct gltf_span image_bytes(const struct gltf_document *d, const struct gltf_image *image)
{
    if (image->view < 0)
        return image->bytes;
    const struct gltf_view *view = &d->views[image->view];
    return (struct gltf_span){d->buffers[view->buffer].bytes + view->offset, (size_t)view->length};
}

static bool known_format(struct gltf_span span)
{
    static const uint8_t png[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    static const uint8_t jpeg[3] = {0xff, 0xd8, 0xff};
    return (span.size > 8 && memcmp(span.bytes, png, 8) == 0) ||
           (span.size > 3 && memcmp(span.bytes, jpeg, 3) == 0);
}

static bool measure(struct gltf_build *build, uint32_t image, struct scene_texture *texture, uint64_t *texels)
{
    struct gltf_span span = image_bytes(build->document, &build->document->images[image]);
    gltf_at(&build->report, "images[%u]", image);
    if (!known_format(span))
        return gltf_fail(&build->report, "is neither a PNG nor a JPEG file");
    int width = 0, height = 0, channels = 0;
    // stb_image's own limit is the same 2^24 pixels a side for all of its formats: far past ours.
    if (span.size > INT32_MAX || !stbi_info_from_memory(span.bytes, (int)span.size, &width, &height, &channels))
        return gltf_fail(&build->report, "its header cannot be read: %s",
                         stbi_failure_reason() != NULL ? stbi_failure_reason() : "damaged");
    if (width < 1 || height < 1 || width > GLTF_MAX_IMAGE_SIZE || height > GLTF_MAX_IMAGE_SIZE)
        return gltf_fail(&build->report, "has %d x %d pixels, our limit is 16384 a side", width, height);
    *texels += (uint64_t)width * (uint64_t)height;
    if (*texels > GLTF_MAX_TEXELS)
        return gltf_fail(&build->report,
                         "the images up to here have %" PRIu64 " pixels, our limit is 268,435,456", *texels);
    texture->width = (uint32_t)width;
    texture->height = (uint32_t)height;
    return true;
}

static bool decode(const struct jobs *jobs, uint32_t at)
{
    struct scene_texture *texture = &jobs->scene->textures[at];
    struct gltf_span span = image_bytes(jobs->document, &jobs->document->images[jobs->images[at]]);
    int width = 0, height = 0, channels = 0;
    uint8_t *rgba = stbi_load_from_memory(span.bytes, (int)span.size, &width, &height, &channels, 4);
    if (rgba == NULL)
        return false;
    texture->rgba = rgba; // stb_image's memory is malloc's
    texture->levels = 1;
    if ((uint32_t)width != texture->width || (uint32_t)height != texture->height)
        return false;
    return scene_make_mips(texture, jobs->cutoffs[at]);
}

static void *work(void *argument)
{
    struct jobs *jobs = argument;
    for (;;) {
        uint32_t at = atomic_fetch_add(&jobs->next, 1);
        if (at >= jobs->scene->texture_count)
            return NULL;
        if (decode(jobs, at))
            continue;
        unsigned failed = atomic_load(&jobs->first_failed);
        while (at < failed && !atomic_compare_exchange_weak(&jobs->first_failed, &failed, at)) {
        }
    }
}

bool gltf_load_images(struct gltf_build *build, const uint32_t *images, const float *cutoffs)
{
    struct scene *scene = build->scene;
    uint64_t texels = 0;
    for (uint32_t i = 0; i < scene->texture_count; i++)
        if (!measure(build, images[i], &scene->textures[i], &texels))
            return false;
    struct jobs jobs = {build->document, scene, images, cutoffs, 0, scene->texture_count};
    pthread_t threads[WORKERS - 1];
    int started = 0;
    while (scene->texture_count > 1 && started < WORKERS - 1 &&
           pthread_create(&threads[started], NULL, work, &jobs) == 0)
        started++;
    work(&jobs);
    for (int i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    uint32_t failed = atomic_load(&jobs.first_failed);
    if (failed == scene->texture_count)
        return true;
    gltf_at(&build->report, "images[%u]", images[failed]);
    return gltf_fail(&build->report, "cannot be decoded; it is damaged, or memory ran out");
}
