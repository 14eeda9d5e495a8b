// The town's models in cells; private to the town's files. Each returns false where memory ran out.
#ifndef STIMULI_BUILTIN_TOWN_MODELS_H
#define STIMULI_BUILTIN_TOWN_MODELS_H

#include "stimuli/builtin/town_parts.h"

bool town_make_house(struct voxel_model *model, uint32_t number, uint64_t seed);
bool town_make_tower(struct voxel_model *model);
bool town_make_tree(struct voxel_model *model, uint32_t number, uint64_t seed);
bool town_make_lamp(struct voxel_model *model);
bool town_make_stall(struct voxel_model *model);
bool town_make_well(struct voxel_model *model);
bool town_make_bridge(struct voxel_model *model);
bool town_make_hay(struct voxel_model *model);

#define TOWN_LAMP_GLOW_M 2.55f // height of a lamp's light above its foot

#endif
