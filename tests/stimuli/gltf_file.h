// glTF files made by the tests: one file with most features, its JSON and bytes open to changes.
#ifndef TESTS_STIMULI_GLTF_FILE_H
#define TESTS_STIMULI_GLTF_FILE_H

#include "stimuli/scene.h"

#include <stddef.h>
#include <stdint.h>

enum { GLTF_FILE_BYTES = 512, GLTF_FILE_TEXT = 16384 };

// Offsets in the made file's buffer.
enum {
    AT_POSITION = 0,       // 4 x 3 floats: the unit square in xy
    AT_NORMAL = 48,        // 4 x 3 floats: +z
    AT_UV0 = 96,           // 4 x 2 floats
    AT_UV1 = 128,          // 4 x 2 uint16, normalised
    AT_COLOUR = 144,       // 4 x 4 uint8, normalised
    AT_INDEX16 = 160,      // 6 uint16
    AT_TIMES = 176,        // 3 floats: 0 1 3
    AT_MOVES = 188,        // 3 x 3 floats
    AT_TURNS = 224,        // 3 x 2 quaternion-sized groups, linear: 3 x 4 floats
    AT_INDEX8 = 272,       // 6 uint8
    AT_INDEX32 = 280,      // 6 uint32
    AT_SPARSE_INDEX = 304, // 1 uint16
    AT_SPARSE_VALUE = 308, // 3 floats
    AT_CUBIC = 320,        // 3 keys x 3 x 3 floats, 108 bytes
    AT_QUANTISED = 428,    // 4 x 4 int16 (stride 8)
    AT_END = 460,
};

struct gltf_file_text {
    char json[GLTF_FILE_TEXT];
    uint8_t bytes[GLTF_FILE_BYTES];
};

void gltf_file_make(struct gltf_file_text *out);
// The first occurrence of `old`; fails the test where there is none.
void gltf_file_replace(struct gltf_file_text *file, const char *old, const char *now);

// "data:<mime>;base64,..."; caller frees.
char *gltf_file_data_uri(const char *mime, const void *bytes, size_t size);

// A folder of the test's own, made on first use; the path of a file in it.
void gltf_file_path(const char *name, char *out, size_t out_size);
void gltf_file_write(const char *path, const void *bytes, size_t size);

// Writes and opens. As .gltf with the buffer as data URI (the text BUFFER_URI in the JSON), or as .glb.
struct scene *gltf_file_open(const struct gltf_file_text *file, char *error, size_t error_size);
struct scene *gltf_file_open_json(const char *json, char *error, size_t error_size);
// Caller frees.
uint8_t *gltf_file_glb(const struct gltf_file_text *file, size_t *out_size);
struct scene *gltf_file_open_bytes(const char *name, const void *bytes, size_t size, char *error,
                                   size_t error_size);

// The test scenes' folder, or NULL after a message.
const char *gltf_file_scenes(void);

#endif
