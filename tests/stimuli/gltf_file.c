#include "tests/stimuli/gltf_file.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Names make each line's text unique for gltf_file_replace.
static const char json_text[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,3]}],\n"
    "\"extensionsUsed\":[\"KHR_lights_punctual\",\"KHR_texture_transform\"],\n"
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[\n"
    " {\"type\":\"directional\",\"color\":[1,0.5,0.25],\"intensity\":8},\n"
    " {\"type\":\"point\",\"intensity\":5,\"range\":7},\n"
    " {\"type\":\"spot\",\"intensity\":9,\"spot\":{\"innerConeAngle\":0.1,\"outerConeAngle\":0.5}}]}},\n"
    "\"nodes\":[\n"
    " {\"name\":\"root\",\"children\":[1,2],\"translation\":[1,2,3]},\n"
    " {\"name\":\"quad\",\"mesh\":0,\"scale\":[2,2,2],\"rotation\":[0,0,0.70710678,0.70710678]},\n"
    " {\"name\":\"lamp\",\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}},\"matrix\":"
    "[1,0,0,0,0,1,0,0,0,0,1,0,4,5,6,1]},\n"
    " {\"name\":\"mover\",\"mesh\":1,\"children\":[4,5]},\n"
    " {\"name\":\"sun\",\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},"
    "\"rotation\":[-0.70710678,0,0,0.70710678]},\n"
    " {\"name\":\"spot\",\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}}],\n"
    "\"meshes\":[\n"
    " {\"name\":\"square\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,"
    "\"TEXCOORD_1\":3,\"COLOR_0\":4},\"indices\":5,\"material\":0}]},\n"
    " {\"name\":\"other\",\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":9,\"material\":1,"
    "\"mode\":4}]}],\n"
    "\"materials\":[\n"
    " {\"name\":\"painted\",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.3,\"doubleSided\":true,"
    "\"emissiveFactor\":[0.5,0.25,0.125],\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,1],"
    "\"metallicFactor\":0.4,\"roughnessFactor\":0.6,\"baseColorTexture\":{\"index\":0,\"texCoord\":1,"
    "\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.25,0.5],\"rotation\":1.5707963267948966,"
    "\"scale\":[2,3]}}}},\"normalTexture\":{\"index\":0,\"scale\":0.75},"
    "\"occlusionTexture\":{\"index\":0,\"strength\":0.5}},\n"
    " {\"name\":\"plain\"}],\n"
    "\"textures\":[{\"source\":0,\"sampler\":0}],\n"
    "\"samplers\":[{\"magFilter\":9728,\"wrapS\":33071,\"wrapT\":33648}],\n"
    "\"images\":[{\"uri\":\"data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwgbABB5A37EGHKQAAAAAElFTkSuQmCC\"}],\n"
    "\"animations\":[{\"channels\":["
    "{\"sampler\":0,\"target\":{\"node\":3,\"path\":\"translation\"}},"
    "{\"sampler\":1,\"target\":{\"node\":3,\"path\":\"rotation\"}}],\"samplers\":["
    "{\"input\":6,\"output\":7,\"interpolation\":\"LINEAR\"},{\"input\":6,\"output\":8}]}],\n"
    "\"accessors\":[\n"
    " {\"name\":\"position\",\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},\n"
    " {\"name\":\"normal\",\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},\n"
    " {\"name\":\"uv0\",\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},\n"
    " {\"name\":\"uv1\",\"bufferView\":3,\"componentType\":5123,\"normalized\":true,\"count\":4,\"type\":"
    "\"VEC2\"},\n"
    " {\"name\":\"colour\",\"bufferView\":4,\"componentType\":5121,\"normalized\":true,\"count\":4,"
    "\"type\":\"VEC4\"},\n"
    " {\"name\":\"index16\",\"bufferView\":5,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},\n"
    " {\"name\":\"times\",\"bufferView\":6,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\"},\n"
    " {\"name\":\"moves\",\"bufferView\":7,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},\n"
    " {\"name\":\"turns\",\"bufferView\":8,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"},\n"
    " {\"name\":\"index8\",\"bufferView\":9,\"componentType\":5121,\"count\":6,\"type\":\"SCALAR\"},\n"
    " {\"name\":\"index32\",\"bufferView\":10,\"componentType\":5125,\"count\":6,\"type\":\"SCALAR\"},\n"
    " {\"name\":\"sparse\",\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":"
    "{\"count\":1,\"indices\":{\"bufferView\":11,\"componentType\":5123},\"values\":{\"bufferView\":12}}},\n"
    " {\"name\":\"cubic\",\"bufferView\":13,\"componentType\":5126,\"count\":9,\"type\":\"VEC3\"},\n"
    " {\"name\":\"quantised\",\"bufferView\":14,\"componentType\":5122,\"normalized\":true,\"count\":4,"
    "\"type\":\"VEC3\"}],\n"
    "\"bufferViews\":[\n"
    " {\"name\":\"v0\",\"buffer\":0,\"byteOffset\":0,\"byteLength\":48,\"byteStride\":12},\n"
    " {\"name\":\"v1\",\"buffer\":0,\"byteOffset\":48,\"byteLength\":48},\n"
    " {\"name\":\"v2\",\"buffer\":0,\"byteOffset\":96,\"byteLength\":32},\n"
    " {\"name\":\"v3\",\"buffer\":0,\"byteOffset\":128,\"byteLength\":16},\n"
    " {\"name\":\"v4\",\"buffer\":0,\"byteOffset\":144,\"byteLength\":16},\n"
    " {\"name\":\"v5\",\"buffer\":0,\"byteOffset\":160,\"byteLength\":12},\n"
    " {\"name\":\"v6\",\"buffer\":0,\"byteOffset\":176,\"byteLength\":12},\n"
    " {\"name\":\"v7\",\"buffer\":0,\"byteOffset\":188,\"byteLength\":36},\n"
    " {\"name\":\"v8\",\"buffer\":0,\"byteOffset\":224,\"byteLength\":48},\n"
    " {\"name\":\"v9\",\"buffer\":0,\"byteOffset\":272,\"byteLength\":6},\n"
    " {\"name\":\"v10\",\"buffer\":0,\"byteOffset\":280,\"byteLength\":24},\n"
    " {\"name\":\"v11\",\"buffer\":0,\"byteOffset\":304,\"byteLength\":2},\n"
    " {\"name\":\"v12\",\"buffer\":0,\"byteOffset\":308,\"byteLength\":12},\n"
    " {\"name\":\"v13\",\"buffer\":0,\"byteOffset\":320,\"byteLength\":108},\n"
    " {\"name\":\"v14\",\"buffer\":0,\"byteOffset\":428,\"byteLength\":32,\"byteStride\":8}],\n"
    "\"buffers\":[{\"byteLength\":460,\"uri\":\"BUFFER_URI\"}]}\n";

static void put(struct gltf_file_text *out, int at, const void *values, size_t size)
{
    memcpy(out->bytes + at, values, size);
}

void gltf_file_make(struct gltf_file_text *out)
{
    memset(out, 0, sizeof *out);
    memcpy(out->json, json_text, sizeof json_text);
    const float corners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const float normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    const float uv0[] = {0, 1, 1, 1, 1, 0, 0, 0};
    const uint16_t uv1[] = {0, 65535, 65535, 65535, 65535, 0, 13107, 0};
    const uint8_t colours[] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 128, 10, 20, 30, 40};
    const uint16_t index16[] = {0, 1, 2, 0, 2, 3};
    const float times[] = {0, 1, 3};
    const float moves[] = {0, 0, 0, 2, 0, 0, 2, 4, 0};
    const float turns[] = {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f, 0, 0, 1, 0};
    const uint8_t index8[] = {0, 1, 2, 0, 2, 3};
    const uint32_t index32[] = {0, 1, 2, 0, 2, 3};
    const uint16_t sparse_index = 2;
    const float sparse_value[] = {5, 6, 7};
    const float cubic[] = {0,  0,  0,  0,  0, 0, 1, 2, 3, 4, 5, 6, 10, 20,
                           30, -1, -2, -3, 2, 2, 2, 7, 8, 9, 0, 0, 0};
    const int16_t quantised[] = {0, 0, 0, 0, 32767, 0, 0, 0, 32767, 32767, 0, 0, 0, -32767, 0, 0};
    put(out, AT_POSITION, corners, sizeof corners);
    put(out, AT_NORMAL, normals, sizeof normals);
    put(out, AT_UV0, uv0, sizeof uv0);
    put(out, AT_UV1, uv1, sizeof uv1);
    put(out, AT_COLOUR, colours, sizeof colours);
    put(out, AT_INDEX16, index16, sizeof index16);
    put(out, AT_TIMES, times, sizeof times);
    put(out, AT_MOVES, moves, sizeof moves);
    put(out, AT_TURNS, turns, sizeof turns);
    put(out, AT_INDEX8, index8, sizeof index8);
    put(out, AT_INDEX32, index32, sizeof index32);
    put(out, AT_SPARSE_INDEX, &sparse_index, sizeof sparse_index);
    put(out, AT_SPARSE_VALUE, sparse_value, sizeof sparse_value);
    put(out, AT_CUBIC, cubic, sizeof cubic);
    put(out, AT_QUANTISED, quantised, sizeof quantised);
}

static char *replaced(const char *text, const char *old, const char *now)
{
    const char *at = strstr(text, old);
    if (at == NULL)
        fail_msg("the made file has no '%s'", old);
    size_t size = strlen(text) + strlen(now) + 1;
    char *out = malloc(size);
    assert_non_null(out);
    snprintf(out, size, "%.*s%s%s", (int)(at - text), text, now, at + strlen(old));
    return out;
}

void gltf_file_replace(struct gltf_file_text *file, const char *old, const char *now)
{
    char *text = replaced(file->json, old, now);
    assert_true(strlen(text) < sizeof file->json);
    memcpy(file->json, text, strlen(text) + 1);
    free(text);
}

char *gltf_file_data_uri(const char *mime, const void *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *in = bytes;
    char *out = malloc(strlen(mime) + size * 2 + 64);
    assert_non_null(out);
    char *to = out + sprintf(out, "data:%s;base64,", mime);
    for (size_t i = 0; i < size; i += 3) {
        uint32_t group = (uint32_t)in[i] << 16;
        group |= i + 1 < size ? (uint32_t)in[i + 1] << 8 : 0;
        group |= i + 2 < size ? (uint32_t)in[i + 2] : 0;
        for (int k = 0; k < 4; k++)
            *to++ = i + (size_t)k <= size ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    *to = '\0';
    return out;
}

void gltf_file_path(const char *name, char *out, size_t out_size)
{
    char folder[256];
    snprintf(folder, sizeof folder, "%s/tests/gltf-%ld", BUILD_DIR, (long)getpid());
    mkdir(folder, 0777);
    snprintf(out, out_size, "%s/%s", folder, name);
}

void gltf_file_write(const char *path, const void *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

struct scene *gltf_file_open_bytes(const char *name, const void *bytes, size_t size, char *error,
                                   size_t error_size)
{
    char path[512];
    gltf_file_path(name, path, sizeof path);
    gltf_file_write(path, bytes, size);
    struct scene *scene = scene_open(path, error, error_size);
    remove(path);
    *strrchr(path, '/') = '\0';
    rmdir(path);
    return scene;
}

struct scene *gltf_file_open_json(const char *json, char *error, size_t error_size)
{
    return gltf_file_open_bytes("made.gltf", json, strlen(json), error, error_size);
}

struct scene *gltf_file_open(const struct gltf_file_text *file, char *error, size_t error_size)
{
    if (strstr(file->json, "BUFFER_URI") == NULL)
        return gltf_file_open_json(file->json, error, error_size);
    char *uri = gltf_file_data_uri("application/octet-stream", file->bytes, AT_END);
    char *json = replaced(file->json, "BUFFER_URI", uri);
    struct scene *scene = gltf_file_open_json(json, error, error_size);
    free(json);
    free(uri);
    return scene;
}

static void put_u32(uint8_t *at, size_t value)
{
    for (int k = 0; k < 4; k++)
        at[k] = (uint8_t)(value >> (8 * k));
}

uint8_t *gltf_file_glb(const struct gltf_file_text *file, size_t *out_size)
{
    char *json = replaced(file->json, ",\"uri\":\"BUFFER_URI\"", "");
    size_t length = strlen(json), padded = (length + 3) / 4 * 4, bytes = AT_END;
    uint8_t *glb = malloc(28 + padded + bytes);
    assert_non_null(glb);
    memcpy(glb, "glTF", 4);
    put_u32(glb + 4, 2);
    put_u32(glb + 8, 28 + padded + bytes);
    put_u32(glb + 12, padded);
    memcpy(glb + 16, "JSON", 4);
    memset(glb + 20, ' ', padded);
    memcpy(glb + 20, json, length);
    put_u32(glb + 20 + padded, bytes);
    memcpy(glb + 24 + padded, "BIN", 4);
    memcpy(glb + 28 + padded, file->bytes, bytes);
    free(json);
    *out_size = 28 + padded + bytes;
    return glb;
}

const char *gltf_file_scenes(void)
{
    const char *folder = getenv("FOVSTUDY_SCENES");
    if (folder == NULL)
        folder = SOURCE_DIR "/../shared/scenes";
    if (access(folder, R_OK) == 0)
        return folder;
    print_message("no test scenes at %s; set FOVSTUDY_SCENES\n", folder);
    return NULL;
}
