#include "app/session/recording.h"

#include "app/session/pack.h"

#include <stdlib.h>
#include <string.h>

struct recording *recording_create(uint32_t width, uint32_t height, uint32_t capacity)
{
    struct recording *recording = calloc(1, sizeof *recording);
    size_t pixels = (size_t)width * height;
    if (!recording)
        return NULL;
    *recording = (struct recording){.width = width,
                                    .height = height,
                                    .capacity = capacity,
                                    .frames = calloc(capacity, sizeof *recording->frames),
                                    .scratch = malloc(pack_scratch(pixels)),
                                    .out = malloc(pack_bound(pixels))};
    if (recording->frames && recording->scratch && recording->out)
        return recording;
    recording_destroy(recording);
    return NULL;
}

void recording_destroy(struct recording *recording)
{
    if (!recording)
        return;
    for (uint32_t i = 0; recording->frames && i < recording->capacity; i++)
        for (int eye = 0; eye < EYES; eye++)
            free(recording->frames[i].packed[eye]);
    free(recording->frames);
    free(recording->scratch);
    free(recording->out);
    free(recording);
}

bool recording_add(struct recording *recording, const uint8_t *const rgba[EYES], int64_t shaded_px,
                   int64_t triangles)
{
    size_t pixels = (size_t)recording->width * recording->height;
    if (recording->count == recording->capacity)
        return false;
    struct recording_frame *frame = &recording->frames[recording->count];
    for (int eye = 0; eye < EYES; eye++) {
        size_t size = pack(rgba[eye], pixels, recording->scratch, recording->out, pack_bound(pixels));
        frame->packed[eye] = size ? malloc(size) : NULL;
        if (!frame->packed[eye])
            return false;
        memcpy(frame->packed[eye], recording->out, size);
        frame->size[eye] = size;
        recording->bytes += size;
    }
    frame->shaded_px = shaded_px;
    frame->triangles = triangles;
    recording->count++;
    return true;
}

uint64_t recording_forecast(const struct recording *recording)
{
    return recording->count ? recording->bytes / recording->count * recording->capacity : 0;
}
