// glTF 2.0 files as scenes.
//
// Use: gltf_open("x.gltf", ...) -> scene_destroy. Behind it: gltf.cpp lets tinygltf read the JSON and hands out
// plain structs (gltf/document.h), gltf/check.c proves that every index and byte range holds, and the rest of
// gltf/ makes the scene's arrays from them. It does not: draw skins, morph targets, points, lines or blended
// surfaces (scene->notes names them), read files outside the file's own folder, or open more than the limits in
// gltf/document.h.
#ifndef STIMULI_GLTF_H
#define STIMULI_GLTF_H

#include "stimuli/scene.h"

// NULL on failure, with one sentence in `error` that begins with the path.
struct scene *gltf_open(const char *path, char *error, size_t error_size);

#endif
