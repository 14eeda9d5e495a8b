// The bytes of a glTF file and of the files it names, and what must hold before a parser may see them.
#ifndef STIMULI_GLTF_FILE_H
#define STIMULI_GLTF_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLTF_MAX_FILE_BYTES = 1 << 30, // the file and all it names together
    GLTF_MAX_JSON_BYTES = 64 << 20,
    GLTF_MAX_JSON_DEPTH = 48,        // parsers recurse; real files stay below 12
    GLTF_MAX_JSON_OBJECTS = 1000000, // tinygltf spends up to 1 KiB on each
    GLTF_MAX_JSON_VALUES = 8000000,
};

struct gltf_file {
    const char *path;
    uint8_t *bytes; // owned
    size_t size;
    uint64_t read_bytes; // so far, of the limit
    bool binary;         // GLB
    char problem[512];   // the first sentence about a file named inside; "" for none
};

// Reads the file; false with a sentence (without the path).
bool gltf_file_read(struct gltf_file *file, const char *path, char *error, size_t error_size);
void gltf_file_finish(struct gltf_file *file);

// Checks the GLB container and the JSON's depth, sizes and integer fields; the sentence begins with line:column
// where it is about the JSON.
bool gltf_scan(struct gltf_file *file, char *error, size_t error_size);
bool gltf_scan_json(const char *json, size_t size, char *error, size_t error_size);

// Reads a file beside the glTF file by its decoded relative URI. Caller frees. NULL: see file->problem.
uint8_t *gltf_file_read_beside(struct gltf_file *file, const char *uri, size_t *out_size);

#ifdef __cplusplus
}
#endif
#endif
