#include "stimuli/gltf/file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { GLB_HEADER = 12, GLB_CHUNK_HEADER = 8 };

static bool fail(char *error, size_t size, const char *sentence)
{
    snprintf(error, size, "%s", sentence);
    return false;
}

static uint8_t *read_stream(FILE *stream, size_t size)
{
    uint8_t *bytes = malloc(size + 1);
    if (bytes == NULL || fread(bytes, 1, size, stream) != size) {
        free(bytes);
        return NULL;
    }
    bytes[size] = 0;
    return bytes;
}

// Counts against the file's total. NULL with a sentence.
static uint8_t *read_path(struct gltf_file *file, const char *path, size_t *out_size, char *error,
                          size_t error_size)
{
    struct stat about;
    FILE *stream = NULL;
    uint8_t *bytes = NULL;
    if (stat(path, &about) != 0)
        snprintf(error, error_size, "cannot be read: %s", strerror(errno));
    else if (!S_ISREG(about.st_mode))
        fail(error, error_size, "is not a regular file");
    else if (about.st_size == 0)
        fail(error, error_size, "is empty");
    else if ((uint64_t)about.st_size > GLTF_MAX_FILE_BYTES - file->read_bytes)
        fail(error, error_size, "takes the scene past 1 GiB of files, our limit");
    else if ((stream = fopen(path, "rb")) == NULL)
        snprintf(error, error_size, "cannot be read: %s", strerror(errno));
    else if ((bytes = read_stream(stream, (size_t)about.st_size)) == NULL)
        fail(error, error_size, "cannot be read to its end");
    if (stream != NULL)
        fclose(stream);
    if (bytes != NULL) {
        *out_size = (size_t)about.st_size;
        file->read_bytes += *out_size;
    }
    return bytes;
}

bool gltf_file_read(struct gltf_file *file, const char *path, char *error, size_t error_size)
{
    *file = (struct gltf_file){.path = path};
    file->bytes = read_path(file, path, &file->size, error, error_size);
    if (file->bytes == NULL)
        return false;
    file->binary = file->size >= 4 && memcmp(file->bytes, "glTF", 4) == 0;
    return true;
}

void gltf_file_finish(struct gltf_file *file)
{
    free(file->bytes);
    file->bytes = NULL;
}

static uint32_t read_u32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static bool check_binary_chunk(const uint8_t *bytes, size_t at, size_t length, char *error, size_t error_size)
{
    if (length - at < GLB_CHUNK_HEADER)
        return fail(error, error_size, "the GLB's second chunk header is cut off");
    uint32_t chunk = read_u32(bytes + at);
    if (read_u32(bytes + at + 4) != 0x004e4942)
        return fail(error, error_size, "the GLB's second chunk is not of type BIN");
    if (chunk % 4 != 0 || chunk == 0)
        return fail(error, error_size, "the GLB's BIN chunk length is not a positive multiple of 4");
    if (chunk > length - at - GLB_CHUNK_HEADER) {
        snprintf(error, error_size, "the GLB's BIN chunk reaches %zu bytes past the end of the file",
                 chunk - (length - at - GLB_CHUNK_HEADER));
        return false;
    }
    return true;
}

// Finds the JSON chunk; a GLB that passes is safe for the parser, which reads lengths on trust.
static bool check_container(const struct gltf_file *file, size_t *out_json, size_t *out_json_size, char *error,
                            size_t error_size)
{
    if (file->size < GLB_HEADER + GLB_CHUNK_HEADER)
        return fail(error, error_size, "the GLB header is cut off");
    if (read_u32(file->bytes + 4) != 2) {
        snprintf(error, error_size, "GLB version %u; we read version 2", read_u32(file->bytes + 4));
        return false;
    }
    uint32_t length = read_u32(file->bytes + 8), json = read_u32(file->bytes + 12);
    if (length != file->size) {
        snprintf(error, error_size,
                 "the GLB header says %u bytes, the file has %zu; it is truncated or damaged", length,
                 file->size);
        return false;
    }
    if (read_u32(file->bytes + 16) != 0x4e4f534a)
        return fail(error, error_size, "the GLB's first chunk is not of type JSON");
    if (json > length - GLB_HEADER - GLB_CHUNK_HEADER)
        return fail(error, error_size, "the GLB's JSON chunk reaches past the end of the file");
    if (json % 4 != 0 || json == 0)
        return fail(error, error_size, "the GLB's JSON chunk length is not a positive multiple of 4");
    *out_json = GLB_HEADER + GLB_CHUNK_HEADER;
    *out_json_size = json;
    size_t end = *out_json + json;
    return end == length || check_binary_chunk(file->bytes, end, length, error, error_size);
}

bool gltf_scan(struct gltf_file *file, char *error, size_t error_size)
{
    size_t at = 0, size = file->size;
    if (file->binary && !check_container(file, &at, &size, error, error_size))
        return false;
    return gltf_scan_json((const char *)file->bytes + at, size, error, error_size);
}

// A URI must name a file in the glTF file's folder or below: the file may come from anyone.
static const char *uri_problem(const char *uri)
{
    if (uri[0] == '\0')
        return "is empty";
    if (uri[0] == '/' || uri[0] == '\\')
        return "is an absolute path; only files beside the glTF file are read";
    if (strchr(uri, ':') != NULL)
        return "has a scheme we do not read; only files beside the glTF file and base64 data are";
    if (strchr(uri, '\\') != NULL)
        return "has a backslash";
    for (const char *part = uri; part != NULL; part = strchr(part, '/')) {
        part += *part == '/';
        if (strncmp(part, "..", 2) == 0 && (part[2] == '/' || part[2] == '\0'))
            return "leaves the glTF file's folder";
    }
    return NULL;
}

uint8_t *gltf_file_read_beside(struct gltf_file *file, const char *uri, size_t *out_size)
{
    char sentence[256] = "";
    uint8_t *bytes = NULL;
    const char *problem = uri_problem(uri);
    if (problem != NULL) {
        snprintf(sentence, sizeof sentence, "%s", problem);
    } else {
        const char *slash = strrchr(file->path, '/');
        size_t folder = slash != NULL ? (size_t)(slash - file->path) + 1 : 0;
        size_t length = folder + strlen(uri) + 1;
        char *path = malloc(length);
        if (path != NULL) {
            snprintf(path, length, "%.*s%s", (int)folder, file->path, uri);
            bytes = read_path(file, path, out_size, sentence, sizeof sentence);
        } else {
            snprintf(sentence, sizeof sentence, "cannot be read: out of memory");
        }
        free(path);
    }
    if (bytes == NULL && file->problem[0] == '\0')
        snprintf(file->problem, sizeof file->problem, "uri '%.200s' %s", uri, sentence);
    return bytes;
}
