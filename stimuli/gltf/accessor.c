#include "stimuli/gltf/accessor.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool gltf_fail(const struct gltf_report *report, const char *format, ...)
{
    char what[384];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    snprintf(report->error, report->error_size, "%s: %s", report->where, what);
    return false;
}

void gltf_at(struct gltf_report *report, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(report->where, sizeof report->where, format, arguments);
    va_end(arguments);
}

static uint32_t component_size(int32_t component)
{
    switch (component) {
    case GLTF_INT8:
    case GLTF_UINT8:
        return 1;
    case GLTF_INT16:
    case GLTF_UINT16:
        return 2;
    case GLTF_UINT32:
    case GLTF_FLOAT:
        return 4;
    default:
        return 0;
    }
}

// Elements of `size` bytes, `count` of them from `offset` in a view. No sum can wrap: gltf_scan keeps every
// number in the file below 2^31 and strides are at most 252.
static bool check_bytes(const struct gltf_document *d, int32_t view_index, uint64_t offset, uint64_t count,
                        uint32_t size, uint32_t alignment, const struct gltf_report *report, const char *part)
{
    if (view_index < 0 || (uint32_t)view_index >= d->view_count)
        return gltf_fail(report, "%s names bufferView %d, the file has %u", part, view_index, d->view_count);
    const struct gltf_view *view = &d->views[view_index];
    if (view->buffer < 0 || (uint32_t)view->buffer >= d->buffer_count)
        return gltf_fail(report, "bufferView %d names buffer %d, the file has %u", view_index, view->buffer,
                         d->buffer_count);
    uint64_t held = d->buffers[view->buffer].size;
    if (view->offset > held || view->length > held - view->offset)
        return gltf_fail(report, "bufferView %d reaches %" PRIu64 " bytes past buffer %d", view_index,
                         view->offset + view->length - held, view->buffer);
    uint64_t stride = view->stride != 0 ? view->stride : size;
    if (view->stride != 0 && (view->stride < 4 || view->stride > 252 || view->stride % 4 != 0))
        return gltf_fail(report, "bufferView %d has a byteStride of %" PRIu64 ", not a multiple of 4 up to 252",
                         view_index, view->stride);
    if (stride < size)
        return gltf_fail(report, "bufferView %d has a byteStride of %" PRIu64 " for elements of %u bytes",
                         view_index, stride, size);
    if (offset % alignment != 0 || (view->offset + offset) % alignment != 0 || stride % alignment != 0)
        return gltf_fail(report, "%s is not aligned to its components of %u bytes in bufferView %d", part,
                         alignment, view_index);
    uint64_t end = offset + stride * (count - 1) + size;
    if (end > view->length)
        return gltf_fail(report, "%s reaches %" PRIu64 " bytes past bufferView %d", part, end - view->length,
                         view_index);
    return true;
}

static bool check_sparse(const struct gltf_document *d, const struct gltf_accessor *a, uint32_t size,
                         uint32_t alignment, const struct gltf_report *report)
{
    if (a->sparse_count < 1 || (uint64_t)a->sparse_count > a->count)
        return gltf_fail(report, "sparse.count is %d, the accessor has %" PRIu64 " elements", a->sparse_count,
                         a->count);
    uint32_t index_size = component_size(a->sparse_index_component);
    bool is_unsigned = a->sparse_index_component == GLTF_UINT8 || a->sparse_index_component == GLTF_UINT16 ||
                       a->sparse_index_component == GLTF_UINT32;
    if (!is_unsigned)
        return gltf_fail(report, "sparse.indices have component type %d, not 5121, 5123 or 5125",
                         a->sparse_index_component);
    if (a->sparse_index_offset < 0 || a->sparse_value_offset < 0)
        return gltf_fail(report, "a negative byteOffset in sparse");
    uint64_t count = (uint64_t)a->sparse_count;
    return check_bytes(d, a->sparse_index_view, (uint64_t)a->sparse_index_offset, count, index_size, index_size,
                       report, "sparse.indices") &&
           check_bytes(d, a->sparse_value_view, (uint64_t)a->sparse_value_offset, count, size, alignment,
                       report, "sparse.values");
}

static bool check_type(const struct gltf_accessor *a, int32_t index, const struct gltf_rule *rule,
                       const struct gltf_report *report)
{
    if (component_size(a->component) == 0)
        return gltf_fail(report, "accessor %d has component type %d, which we do not read", index,
                         a->component);
    if (a->width < rule->min_width || a->width > rule->max_width)
        return gltf_fail(report, "accessor %d has %u numbers an element (0: a matrix), not %u%s", index,
                         a->width, rule->min_width, rule->max_width > rule->min_width ? " or one more" : "");
    uint32_t allowed = a->normalised ? rule->normalised : rule->plain;
    if ((allowed & GLTF_BIT(a->component)) == 0)
        return gltf_fail(report, "accessor %d has component type %d%s, which is not allowed here", index,
                         a->component, a->normalised ? " normalized" : "");
    return true;
}

bool gltf_check_accessor(const struct gltf_document *d, int32_t index, const struct gltf_rule *rule,
                         const struct gltf_report *report)
{
    if (index < 0 || (uint32_t)index >= d->accessor_count)
        return gltf_fail(report, "names accessor %d, the file has %u", index, d->accessor_count);
    const struct gltf_accessor *a = &d->accessors[index];
    if (!check_type(a, index, rule, report))
        return false;
    if (a->count < 1 || a->count > INT32_MAX)
        return gltf_fail(report, "accessor %d has %" PRIu64 " elements", index, a->count);
    uint32_t alignment = component_size(a->component), size = alignment * a->width;
    char part[32];
    snprintf(part, sizeof part, "accessor %d", index);
    if (a->view != -1 && !check_bytes(d, a->view, a->offset, a->count, size, alignment, report, part))
        return false;
    // Without a view the elements are zeros, and their number is held against no bytes at all.
    if (a->view == -1 && a->count > GLTF_MAX_VERTICES)
        return gltf_fail(report, "accessor %d has %" PRIu64 " elements without bytes, our limit is 20,000,000",
                         index, a->count);
    return !a->sparse || check_sparse(d, a, size, alignment, report);
}

static uint64_t element_stride(const struct gltf_document *d, int32_t view, uint32_t size)
{
    return d->views[view].stride != 0 ? d->views[view].stride : size;
}

static const uint8_t *element(const struct gltf_document *d, int32_t view, uint64_t offset, uint64_t at,
                              uint32_t size)
{
    const struct gltf_view *v = &d->views[view];
    return d->buffers[v->buffer].bytes + v->offset + offset + element_stride(d, view, size) * at;
}

static uint32_t read_unsigned(const uint8_t *at, int32_t component)
{
    if (component == GLTF_UINT8)
        return at[0];
    if (component == GLTF_UINT16)
        return (uint32_t)at[0] | (uint32_t)at[1] << 8;
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

// glTF 2.0, section 3.11: f = c / 255, max(c / 127, -1), c / 65535, max(c / 32767, -1).
static float read_float(const uint8_t *at, int32_t component, bool normalised)
{
    float value;
    switch (component) {
    case GLTF_INT8:
        value = (float)(int8_t)at[0];
        return normalised ? fmaxf(value / 127.0f, -1.0f) : value;
    case GLTF_UINT8:
        value = (float)at[0];
        return normalised ? value / 255.0f : value;
    case GLTF_INT16:
        value = (float)(int16_t)read_unsigned(at, GLTF_UINT16);
        return normalised ? fmaxf(value / 32767.0f, -1.0f) : value;
    case GLTF_UINT16:
        value = (float)read_unsigned(at, GLTF_UINT16);
        return normalised ? value / 65535.0f : value;
    case GLTF_UINT32:
        return (float)read_unsigned(at, GLTF_UINT32);
    default: {
        uint32_t bits = read_unsigned(at, GLTF_UINT32);
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    }
}

static bool read_element(const struct gltf_accessor *a, const uint8_t *at, float *out)
{
    uint32_t step = component_size(a->component);
    bool finite = true;
    for (uint32_t i = 0; i < a->width; i++) {
        out[i] = read_float(at + i * step, a->component, a->normalised);
        finite = finite && isfinite(out[i]);
    }
    return finite;
}

// The element that the n-th sparse value replaces; -1 with a sentence where they do not rise or lie outside.
static int64_t sparse_target(const struct gltf_document *d, const struct gltf_accessor *a, uint32_t n,
                             int64_t previous, const struct gltf_report *report)
{
    uint32_t size = component_size(a->sparse_index_component);
    uint32_t target = read_unsigned(element(d, a->sparse_index_view, (uint64_t)a->sparse_index_offset, n, size),
                                    a->sparse_index_component);
    if (target >= a->count || (int64_t)target <= previous) {
        gltf_fail(report, "sparse.indices[%u] is %u, which is out of range or not above the one before", n,
                  target);
        return -1;
    }
    return target;
}

bool gltf_read_floats(const struct gltf_document *d, int32_t index, float *out,
                      const struct gltf_report *report)
{
    const struct gltf_accessor *a = &d->accessors[index];
    uint32_t size = component_size(a->component) * a->width;
    if (a->view == -1)
        memset(out, 0, a->count * a->width * sizeof *out);
    for (uint64_t i = 0; a->view != -1 && i < a->count; i++)
        if (!read_element(a, element(d, a->view, a->offset, i, size), out + i * a->width))
            return gltf_fail(report, "element %" PRIu64 " of accessor %d is infinite or not a number", i,
                             index);
    int64_t target = -1;
    for (uint32_t n = 0; a->sparse && n < (uint32_t)a->sparse_count; n++) {
        target = sparse_target(d, a, n, target, report);
        if (target < 0)
            return false;
        const uint8_t *at = element(d, a->sparse_value_view, (uint64_t)a->sparse_value_offset, n, size);
        if (!read_element(a, at, out + (uint64_t)target * a->width))
            return gltf_fail(report, "sparse value %u of accessor %d is infinite or not a number", n, index);
    }
    return true;
}

bool gltf_read_indices(const struct gltf_document *d, int32_t index, uint64_t limit, uint32_t *out,
                       const struct gltf_report *report)
{
    const struct gltf_accessor *a = &d->accessors[index];
    uint32_t size = component_size(a->component);
    for (uint64_t i = 0; i < a->count; i++)
        out[i] = a->view != -1 ? read_unsigned(element(d, a->view, a->offset, i, size), a->component) : 0;
    int64_t target = -1;
    for (uint32_t n = 0; a->sparse && n < (uint32_t)a->sparse_count; n++) {
        target = sparse_target(d, a, n, target, report);
        if (target < 0)
            return false;
        out[target] = read_unsigned(element(d, a->sparse_value_view, (uint64_t)a->sparse_value_offset, n, size),
                                    a->component);
    }
    for (uint64_t i = 0; i < a->count; i++)
        if (out[i] >= limit)
            return gltf_fail(report,
                             "index %" PRIu64 " of accessor %d is %u, the primitive has %" PRIu64 " vertices",
                             i, index, out[i], limit);
    return true;
}
