// Cutting a mesh into submodels: halves along the longest axis of the triangles' centres until a piece is small
// enough (a k-d tree, whose leaves are compact and nearly full), then each piece in an order that suits the
// vertex cache (meshoptimizer).
#include "stimuli/scene.h"

#include <math.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

enum {
    PIECE_INDICES = SCENE_SUBMODEL_TRIANGLES * 3,
    STACK = 64, // halving 2^32 triangles needs 32 levels
};

struct piece_triangle {
    float centre[3];
    uint32_t index[3];
};

struct piece {
    uint32_t first, count; // triangles
};

static int longest_axis(const struct piece_triangle *triangles, uint32_t count)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], triangles[i].centre[k]);
            high[k] = fmaxf(high[k], triangles[i].centre[k]);
        }
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (high[k] - low[k] > high[axis] - low[axis])
            axis = k;
    return axis;
}

static void swap_triangles(struct piece_triangle *a, struct piece_triangle *b)
{
    struct piece_triangle t = *a;
    *a = *b;
    *b = t;
}

// Hoare's selection: afterwards no triangle before `nth` lies beyond one at or after it.
static void select_nth(struct piece_triangle *t, uint32_t count, uint32_t nth, int axis)
{
    int64_t low = 0, high = (int64_t)count - 1;
    while (low < high) {
        float pivot = t[low + (high - low) / 2].centre[axis];
        int64_t i = low, j = high;
        while (i <= j) {
            while (t[i].centre[axis] < pivot)
                i++;
            while (t[j].centre[axis] > pivot)
                j--;
            if (i <= j)
                swap_triangles(&t[i++], &t[j--]);
        }
        if ((int64_t)nth <= j)
            high = j;
        else if ((int64_t)nth >= i)
            low = i;
        else
            return;
    }
}

static int compare_uint32(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

// meshoptimizer works on tables as long as the vertex array, so the piece gets its own small numbering first.
static void order_for_cache(uint32_t *indices, uint32_t count)
{
    uint32_t sorted[PIECE_INDICES], local[PIECE_INDICES], ordered[PIECE_INDICES];
    memcpy(sorted, indices, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, compare_uint32);
    uint32_t unique = 0;
    for (uint32_t i = 0; i < count; i++)
        if (unique == 0 || sorted[i] != sorted[unique - 1])
            sorted[unique++] = sorted[i];
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *at = bsearch(&indices[i], sorted, unique, sizeof *sorted, compare_uint32);
        local[i] = (uint32_t)(at - sorted);
    }
    meshopt_optimizeVertexCache(ordered, local, count, unique);
    for (uint32_t i = 0; i < count; i++)
        indices[i] = sorted[ordered[i]];
}

static struct scene_box measure(const struct scene_vertex *vertices, const uint32_t *indices, uint32_t count)
{
    struct scene_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            box.min[k] = fminf(box.min[k], vertices[indices[i]].position[k]);
            box.max[k] = fmaxf(box.max[k], vertices[indices[i]].position[k]);
        }
    return box;
}

// Halves a piece at a multiple of SCENE_SUBMODEL_TRIANGLES, so that all leaves but one are full.
static uint32_t halve(struct piece_triangle *triangles, uint32_t count)
{
    uint32_t leaves = (count + SCENE_SUBMODEL_TRIANGLES - 1) / SCENE_SUBMODEL_TRIANGLES;
    uint32_t half = leaves / 2 * SCENE_SUBMODEL_TRIANGLES;
    select_nth(triangles, count, half, longest_axis(triangles, count));
    return half;
}

static bool load_triangles(const struct scene_vertex *vertices, const uint32_t *indices, uint32_t count,
                           struct piece_triangle *out)
{
    for (uint32_t i = 0; i < count; i++) {
        memcpy(out[i].index, indices + (size_t)i * 3, sizeof out[i].index);
        for (int k = 0; k < 3; k++) {
            float sum = 0.0f;
            for (int corner = 0; corner < 3; corner++)
                sum += vertices[out[i].index[corner]].position[k] / 3.0f;
            if (!isfinite(sum))
                return false;
            out[i].centre[k] = sum;
        }
    }
    return true;
}

static void cut(struct piece_triangle *triangles, uint32_t count, uint32_t *indices)
{
    struct piece stack[STACK] = {{0, count}};
    for (int depth = 1; depth > 0;) {
        struct piece piece = stack[--depth];
        if (piece.count > SCENE_SUBMODEL_TRIANGLES) {
            uint32_t half = halve(triangles + piece.first, piece.count);
            stack[depth++] = (struct piece){piece.first + half, piece.count - half};
            stack[depth++] = (struct piece){piece.first, half};
        }
    }
    for (uint32_t i = 0; i < count; i++)
        memcpy(indices + (size_t)i * 3, triangles[i].index, sizeof triangles[i].index);
}

uint32_t scene_split(const struct scene_vertex *vertices, uint32_t vertex_count, uint32_t *indices,
                     uint32_t index_count, uint32_t first_index, uint32_t material, struct scene_submodel *out)
{
    (void)vertex_count;
    uint32_t count = index_count / 3;
    if (count > SCENE_SUBMODEL_TRIANGLES) {
        // Without memory, or with coordinates that have no order, the file's own order is cut.
        struct piece_triangle *triangles = malloc((size_t)count * sizeof *triangles);
        if (triangles != NULL && load_triangles(vertices, indices, count, triangles))
            cut(triangles, count, indices);
        free(triangles);
    }
    uint32_t pieces = 0;
    for (uint32_t first = 0; first < count; first += SCENE_SUBMODEL_TRIANGLES) {
        uint32_t size = count - first < SCENE_SUBMODEL_TRIANGLES ? count - first : SCENE_SUBMODEL_TRIANGLES;
        uint32_t *piece = indices + (size_t)first * 3;
        order_for_cache(piece, size * 3);
        out[pieces++] = (struct scene_submodel){.first_index = first_index + first * 3,
                                                .index_count = size * 3,
                                                .material = material,
                                                .bounds = measure(vertices, piece, size * 3)};
    }
    return pieces;
}
