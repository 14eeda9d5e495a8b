#include "app/gaze/gaze_source.h"

#include <stdio.h>
#include <string.h>

const struct gaze_kind *const gaze_kinds[] = {&gaze_mouse, &gaze_simulated, NULL};

static void refuse(const char *spec, char *error, size_t error_size)
{
    int used = snprintf(error, error_size, "gaze source '%s' is not known here; choose", spec);
    for (size_t i = 0; gaze_kinds[i] && used > 0 && (size_t)used < error_size; i++)
        used += snprintf(error + used, error_size - (size_t)used, "%s %s", i ? " or" : "", gaze_kinds[i]->name);
}

struct gaze_source *gaze_open(const char *spec, const struct gaze_desc *desc, char *error, size_t error_size)
{
    size_t length = strcspn(spec, ":");
    for (size_t i = 0; gaze_kinds[i]; i++) {
        const char *name = gaze_kinds[i]->name;
        if (strlen(name) != length || strncmp(name, spec, length) != 0)
            continue;
        struct gaze_desc full = *desc;
        full.detail = spec[length] ? spec + length + 1 : NULL;
        if (full.detail) {
            snprintf(error, error_size, "gaze source '%s' takes nothing after its name", name);
            return NULL;
        }
        return gaze_kinds[i]->create(&full, error, error_size);
    }
    refuse(spec, error, error_size);
    return NULL;
}

size_t gaze_poll(struct gaze_source *source, int64_t now_ns, struct gaze_sample *out, size_t capacity)
{
    return source->kind->poll(source, now_ns, out, capacity);
}

void gaze_close(struct gaze_source *source)
{
    if (source)
        source->kind->destroy(source);
}
