#include "stimuli/builtin/town.h"

#include "stimuli/builtin/random.h"
#include "stimuli/builtin/town_models.h"
#include "stimuli/builtin/town_parts.h"

#include <math.h>
#include <stdlib.h>

#define TAU 6.283185307179586

enum { MERGED = 64 }; // span of faces in the smallest towns: as few triangles as the shapes allow

static void add_light(struct scene *scene)
{
    // A low evening sun; lanterns are lit and count in the shade.
    scene->sun.direction = dvec3_normalise((struct dvec3){-0.62, 0.52, 0.50});
    const float sun[3] = {60, 50, 35}, zenith[3] = {1.2f, 3.6f, 9.6f}, horizon[3] = {6.0f, 7.6f, 9.2f};
    const float ground[3] = {2.2f, 1.9f, 1.5f};
    for (int i = 0; i < 3; i++) {
        scene->sun.illuminance[i] = sun[i];
        scene->sky.zenith[i] = zenith[i];
        scene->sky.horizon[i] = horizon[i];
        scene->sky.ground[i] = ground[i];
    }
    scene->luminance = 1.35f;
}

bool town_path(struct camera_path *out)
{
    // Around the well, down the east street, over the river, along the far bank and back over the other bridge.
    static const struct camera_path_knot knots[] = {
        {{-5.8, 1.65, 5.8}, {4, 2.2, -6}},    {{-6.4, 1.65, 0.5}, {6, 2.6, -9}},
        {{-3.2, 1.65, -4.2}, {9, 2.6, -10}},  {{1.8, 1.65, -4.3}, {14, 3.0, -12}},
        {{6.4, 1.65, -2.4}, {19, 3.2, -9}},   {{11.0, 1.65, -2.6}, {22, 3.4, 3}},
        {{14.4, 1.65, 0.6}, {17.5, 3.0, 14}}, {{15.0, 1.65, 6.5}, {14, 2.4, 22}},
        {{15.0, 1.70, 13.0}, {13, 1.6, 27}},  {{15.0, 2.00, 19.0}, {6, 1.2, 27}},
        {{15.0, 2.05, 25.2}, {0, 2.0, 30.5}}, {{12.9, 1.72, 30.0}, {-5, 2.6, 30.5}},
        {{7.0, 1.65, 29.6}, {-10, 2.4, 25}},  {{1.0, 1.65, 29.5}, {-12, 3.2, 18}},
        {{-5.0, 1.65, 29.6}, {-15, 2.8, 14}}, {{-11.6, 1.65, 29.9}, {-17, 2.6, 12}},
        {{-15.0, 2.00, 25.6}, {-14, 2.6, 8}}, {{-15.0, 2.05, 20.0}, {-8, 2.8, 2}},
        {{-14.6, 1.70, 14.0}, {-4, 2.8, -2}}, {{-10.6, 1.65, 6.4}, {0, 2.4, -4}},
    };
    *out = (struct camera_path){.knot_count = sizeof knots / sizeof knots[0], .speed_m_s = 1.4};
    for (uint32_t i = 0; i < out->knot_count; i++)
        out->knots[i] = knots[i];
    return camera_path_finish(out);
}

static struct voxel_style model_style(const struct town *town)
{
    return (struct voxel_style){.kinds = town->kinds, .span = town->span, .plain = town->span >= MERGED};
}

static void measure_models(struct town *town)
{
    for (int i = 0; i < TOWN_MODELS; i++) {
        struct voxel_style style = model_style(town);
        town->triangles[i] = voxel_mesh(NULL, &town->models[i], &style);
    }
}

// Chooses blocks and items, nearest first, until the wanted number is reached; returns the number chosen.
static uint64_t choose(struct town *town)
{
    uint64_t limit = town->wanted, sum = town_mover_triangles();
    for (uint32_t b = 0; b < TOWN_BLOCKS; b++) {
        town->blocks[b].shown = 0;
        sum += town_add_ground(town, &town->blocks[b], false, true);
    }
    bool open = true;
    for (town->built = 0; town->built < TOWN_BLOCKS && open; town->built++) {
        struct town_block *block = &town->blocks[town->built];
        uint64_t ground = town_add_ground(town, block, true, true) - town_add_ground(town, block, false, true);
        if (sum + ground > limit)
            break;
        sum += ground;
        // Smaller items may still fit where a house does not.
        uint32_t kept = 0;
        for (uint32_t i = 0; i < block->item_count; i++) {
            uint32_t cost = town->triangles[block->items[i].model];
            if (sum + cost > limit) {
                open = false;
                continue;
            }
            sum += cost;
            block->items[kept++] = block->items[i];
        }
        block->shown = kept;
    }
    return sum;
}

// The finest faces with which the town still reaches some way around the camera's path.
static void choose_detail(struct town *town)
{
    static const int32_t spans[] = {1, 2, 4, MERGED};
    town->ground_cell = town->wanted < 150000 ? 3 : 1;
    town->country_cell = town->wanted < 150000 ? 30 : town->wanted < 600000 ? 15 : 6;
    for (size_t i = 0; i < sizeof spans / sizeof spans[0]; i++) {
        town->span = spans[i];
        measure_models(town);
        uint64_t near = 0;
        for (uint32_t b = 0; b < 21; b++)
            for (uint32_t k = 0; k < town->blocks[b].item_count; k++)
                near += town->triangles[town->blocks[b].items[k].model];
        if (near < town->wanted * 7 / 10)
            return;
    }
}

static uint32_t mesh_of(struct town *town, enum town_model model)
{
    struct voxel_style style = model_style(town);
    maker_mesh_begin(town->maker);
    voxel_mesh(town->maker, &town->models[model], &style);
    return maker_mesh_end(town->maker);
}

static void add_items(struct town *town)
{
    bool made[TOWN_MODELS] = {false};
    for (uint32_t b = 0; b < town->built; b++) {
        for (uint32_t i = 0; i < town->blocks[b].shown; i++) {
            const struct town_item *item = &town->blocks[b].items[i];
            if (!made[item->model])
                town->mesh[item->model] = mesh_of(town, item->model);
            made[item->model] = true;
            double half = item->quarter * TAU / 8;
            struct dquat turn = {0, sin(half), 0, cos(half)};
            uint32_t node = maker_node(town->maker, -1,
                                       (struct dvec3){(double)item->x, (double)item->y, (double)item->z}, turn);
            maker_instance(town->maker, town->mesh[item->model], node);
            if (item->model == TOWN_LAMP && town->maker->scene->light_count < 20)
                maker_light(town->maker, &(struct scene_light){
                                             .position = {(double)item->x, (double)(item->y + TOWN_LAMP_GLOW_M),
                                                          (double)item->z},
                                             .intensity = {26, 17, 8},
                                             .range_m = 9,
                                             .direction = {0, -1, 0},
                                             .cos_inner = 1,
                                             .cos_outer = -2,
                                         });
        }
    }
}

static void build(struct town *town)
{
    struct maker *maker = town->maker;
    town_plan(town);
    choose_detail(town);
    choose(town);
    if (maker->failed || !town_make_tops(town)) {
        maker->failed = true;
        return;
    }
    uint32_t node = maker_node(maker, -1, (struct dvec3){0, 0, 0}, (struct dquat){0, 0, 0, 1});
    for (uint32_t b = 0; b < TOWN_BLOCKS && !maker->failed; b++) {
        maker_mesh_begin(maker);
        town_add_ground(town, &town->blocks[b], b < town->built, false);
        maker_instance(maker, maker_mesh_end(maker), node);
    }
    add_items(town);
    town_add_movers(town);
}

// Nodes drawn by lot; the whole ground is one.
static void hold_nodes(struct town *town, double percent)
{
    for (uint32_t i = 0; i < town->maker->scene->node_count; i++)
        town->maker->scene->nodes[i].held = 100.0 * (double)random_unit(town->seed, i) < percent;
}

struct scene *town_make(const double *values)
{
    struct maker *maker = malloc(sizeof *maker);
    struct town *town = calloc(1, sizeof *town);
    struct scene *scene = NULL;
    if (maker != NULL && town != NULL && maker_create(maker, "town")) {
        town->maker = maker;
        town->wanted = (uint32_t)values[0];
        town->seed = (uint64_t)values[1];
        town->blocks = calloc(TOWN_BLOCKS, sizeof *town->blocks);
        add_light(maker->scene);
        if (town->blocks != NULL && town_path(&maker->scene->path) && town_make_kinds(town) &&
            town_make_models(town))
            build(town);
        else
            maker->failed = true;
        hold_nodes(town, values[2]);
        scene = maker_finish(maker);
        for (int i = 0; i < TOWN_MODELS; i++)
            voxel_destroy(&town->models[i]);
        free(town->tops);
        free(town->blocks);
    }
    free(town);
    free(maker);
    return scene;
}
