#include "renderer/scene/draw_list.h"

#include <stdlib.h>
#include <string.h>

static bool plain_uv(const struct scene_material *m)
{
    static const float identity[6] = {1, 0, 0, 0, 1, 0};
    for (uint32_t slot = 0; slot < SCENE_SLOTS; slot++) {
        const struct scene_texture_use *use = &m->use[slot];
        if (use->texture >= 0 && (use->uv_set != 0 || memcmp(use->transform, identity, sizeof identity) != 0))
            return false;
    }
    return true;
}

static uint32_t features_of(const struct scene_material *m)
{
    uint32_t features = (m->alpha_mask ? SCENE_GPU_MASK : 0) | (plain_uv(m) ? SCENE_GPU_PLAIN_UV : 0) |
                        (m->sky_in_alpha ? SCENE_GPU_SKY : 0);
    for (uint32_t slot = 0; slot < SCENE_SLOTS; slot++)
        features |= m->use[slot].texture >= 0 ? 1u << slot : 0;
    bool glows = m->emissive[0] > 0 || m->emissive[1] > 0 || m->emissive[2] > 0;
    if (glows)
        features |= SCENE_GPU_EMISSIVE;
    else
        features &= ~(1u << SCENE_EMISSIVE);
    return features;
}

// Moving instances first, so that a frame's update copies one range.
static bool order_objects(struct scene_gpu *s)
{
    const struct scene *scene = s->scene;
    s->object_instance = malloc((scene->instance_count + 1) * sizeof *s->object_instance);
    if (!s->object_instance)
        return false;
    for (int moving = 1; moving >= 0; moving--) {
        for (uint32_t i = 0; i < scene->instance_count; i++) {
            if ((scene->instances[i].moving_id != 0) == moving)
                s->object_instance[s->object_count++] = i;
        }
        if (moving)
            s->moving_object_count = s->object_count;
    }
    return true;
}

struct sortable {
    struct shared_item item;
    uint64_t key; // material, motion, winding, then the order of making, so that the sort is stable
};

static int by_key(const void *a, const void *b)
{
    uint64_t x = ((const struct sortable *)a)->key, y = ((const struct sortable *)b)->key;
    return x < y ? -1 : x > y;
}

static void collect(const struct scene_gpu *s, struct sortable *list)
{
    const struct scene *scene = s->scene;
    uint64_t n = 0;
    for (uint32_t object = 0; object < s->object_count; object++) {
        const struct scene_instance *instance = &scene->instances[s->object_instance[object]];
        const struct scene_mesh *mesh = &scene->meshes[instance->mesh];
        bool moving = object < s->moving_object_count,
             mirrored = dmat4_determinant3(&s->now[instance->node]) < 0;
        for (uint32_t i = 0; i < mesh->submodel_count; i++) {
            const struct scene_submodel *sub = &scene->submodels[mesh->first_submodel + i];
            struct shared_item item = {.object = object,
                                       .material = sub->material,
                                       .first_index = sub->first_index,
                                       .index_count = sub->index_count};
            memcpy(item.box_min, sub->bounds.min, sizeof item.box_min);
            memcpy(item.box_max, sub->bounds.max, sizeof item.box_max);
            list[n] = (struct sortable){item, (uint64_t)sub->material << 34 | (uint64_t)moving << 33 |
                                                  (uint64_t)mirrored << 32 | n};
            n++;
        }
    }
}

static void cut_buckets(struct scene_gpu *s, struct sortable *list)
{
    for (uint32_t i = 0; i < s->item_count; i++) {
        if (i == 0 || list[i].key >> 32 != list[i - 1].key >> 32) {
            const struct scene_material *m = &s->scene->materials[list[i].item.material];
            s->buckets[s->bucket_count++] = (struct scene_bucket){.material = list[i].item.material,
                                                                  .features = features_of(m),
                                                                  .mirrored = list[i].key >> 32 & 1,
                                                                  .moving = list[i].key >> 33 & 1,
                                                                  .double_sided = m->double_sided,
                                                                  .first_item = i};
        }
        s->buckets[s->bucket_count - 1].item_count++;
        list[i].item.bucket = s->bucket_count - 1;
    }
    for (uint32_t b = 0; b < s->bucket_count; b++) {
        struct scene_bucket *bucket = &s->buckets[b];
        bucket->first_group = s->group_count;
        bucket->group_count = (bucket->item_count + SHARED_CULL_GROUP - 1) / SHARED_CULL_GROUP;
        s->group_count += bucket->group_count;
        s->features |= bucket->features;
    }
}

static bool upload_groups(struct scene_gpu *s)
{
    struct shared_cull_group *groups = calloc(s->group_count + 1, sizeof *groups);
    if (!groups)
        return false;
    for (uint32_t b = 0; b < s->bucket_count; b++) {
        const struct scene_bucket *bucket = &s->buckets[b];
        for (uint32_t g = 0; g < bucket->group_count; g++) {
            uint32_t done = g * SHARED_CULL_GROUP, left = bucket->item_count - done;
            groups[bucket->first_group + g] =
                (struct shared_cull_group){.bucket = b,
                                           .first_item = bucket->first_item + done,
                                           .item_count = left < SHARED_CULL_GROUP ? left : SHARED_CULL_GROUP,
                                           .first_group = bucket->first_group,
                                           .bucket_first_item = bucket->first_item,
                                           .last = g + 1 == bucket->group_count};
        }
    }
    bool ok = gpu_buffer_create_filled(s->gpu, "cull groups", groups, s->group_count * sizeof *groups,
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &s->groups);
    free(groups);
    return ok;
}

bool draw_list_create(struct scene_gpu *s)
{
    const struct scene *scene = s->scene;
    if (!order_objects(s))
        return false;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        s->item_count += scene->meshes[scene->instances[i].mesh].submodel_count;
    struct sortable *list = malloc((s->item_count + 1) * sizeof *list);
    struct shared_item *items = malloc((s->item_count + 1) * sizeof *items);
    s->buckets = calloc(4 * scene->material_count + 1, sizeof *s->buckets);
    bool ok = list && items && s->buckets;
    if (ok) {
        collect(s, list);
        qsort(list, s->item_count, sizeof *list, by_key);
        cut_buckets(s, list);
        for (uint32_t i = 0; i < s->item_count; i++)
            items[i] = list[i].item;
        ok = gpu_buffer_create_filled(s->gpu, "items", items, s->item_count * sizeof *items,
                                      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &s->items) &&
             upload_groups(s);
    }
    free(list);
    free(items);
    return ok;
}
