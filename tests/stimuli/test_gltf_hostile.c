// Each bad file is refused with a sentence that names the file, the place and the fault.
#include "tests/stimuli/gltf_file.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct mutation {
    const char *old, *now;
    const char *says;
};

static const struct mutation mutations[] = {
    // JSON
    {"\"asset\":{\"version\":\"2.0\"},", "", "asset"},
    {"\"scene\":0,", "\"scene\":0,,", "1:38: syntax error"},
    {"\"BUFFER_URI\"}]}", "\"BUFFER_URI\"}]", "ends in the middle"},
    {"\"BUFFER_URI\"}]}", "\"BUFFER_URI", "a string without an end"},
    {"\"BUFFER_URI\"}]}", "\"BUFFER_URI\"}]}}", "a closing bracket too many"},
    {"\"asset\":",
     "\"extras\":[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[0]]]]]]]]]]]]]]]]]]]]]]]]]]]]]"
     "]]]]]]]]]]]]]]]]]]]]]]]]]]]]],\"asset\":",
     "nested deeper than 48"},
    {"\"translation\":[1,2,3]", "\"translation\":[1,2,1e999]", "8:53: 1e999 is larger than any number"},
    {"\"translation\":[1,2,3]", "\"translation\":[1,2,NaN]", "8:"},
    // numbers that are not indices
    {"\"bufferView\":0", "\"bufferView\":-1", "\"bufferView\" is -1, not an integer"},
    {"\"bufferView\":0", "\"bufferView\":4294967296", "\"bufferView\" is 4294967296, not an integer"},
    {"\"count\":4", "\"count\":-4", "\"count\" is -4"},
    {"\"count\":4", "\"count\":4.5", "\"count\" is 4.5"},
    {"\"count\":4", "\"count\":1e3", "\"count\" is 1e3"},
    {"\"byteOffset\":48", "\"byteOffset\":-48", "\"byteOffset\" is -48"},
    {"\"POSITION\":0", "\"POSITION\":-7", "\"POSITION\" is -7"},
    {"\"nodes\":[0,3]", "\"nodes\":[0,-3]", "1:60: \"nodes\" is -3"},
    {"\"light\":1", "\"light\":-1", "\"light\" is -1"},
    // accessors and views
    {"\"bufferView\":0", "\"bufferView\":99",
     "meshes[0].primitives[0].attributes.POSITION: accessor 0 names bufferView 99"},
    {"\"POSITION\":0", "\"POSITION\":77",
     "meshes[0].primitives[0].attributes.POSITION: names accessor 77, the file has 14"},
    {"\"NORMAL\":1", "\"NORMAL\":78", "attributes.NORMAL: names accessor 78"},
    {"\"indices\":5", "\"indices\":79", "accessor"},
    {"\"buffer\":0,\"byteOffset\":48", "\"buffer\":5,\"byteOffset\":48",
     "bufferViews[1]: names buffer 5, the file has 1"},
    {"\"byteOffset\":48,\"byteLength\":48", "\"byteOffset\":448,\"byteLength\":48",
     "bufferViews[1]: reaches 36 bytes past buffer 0"},
    {"\"byteOffset\":48,\"byteLength\":48", "\"byteOffset\":48,\"byteLength\":2147483647",
     "bufferViews[1]: reaches"},
    {"\"byteOffset\":48,\"byteLength\":48", "\"byteOffset\":48,\"byteLength\":0",
     "bufferViews[1]: has no bytes"},
    {"\"count\":4,\"type\":\"VEC3\"}", "\"count\":5,\"type\":\"VEC3\"}",
     "accessor 0 reaches 12 bytes past bufferView 0"},
    {"\"count\":4,\"type\":\"VEC3\"}", "\"count\":2147483647,\"type\":\"VEC3\"}",
     "accessor 0 reaches 25769803716 bytes past bufferView 0"},
    {"\"count\":4,\"type\":\"VEC3\"}", "\"count\":0,\"type\":\"VEC3\"}", "accessor 0 has 0 elements"},
    {"\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}",
     "\"componentType\":5126,\"count\":2000000000,\"type\":\"VEC3\"}", "elements without bytes"},
    {"\"bufferView\":0,\"componentType\":5126",
     "\"bufferView\":0,\"byteOffset\":2147483644,\"componentType\":5126", "bytes past bufferView 0"},
    {"\"bufferView\":0,\"componentType\":5126", "\"bufferView\":0,\"byteOffset\":2,\"componentType\":5126",
     "not aligned"},
    {"\"byteStride\":12", "\"byteStride\":8", "bufferView 0 has a byteStride of 8 for elements of 12 bytes"},
    {"\"byteStride\":12", "\"byteStride\":256", "byteStride"},
    {"\"byteStride\":12", "\"byteStride\":13", "byteStride"},
    {"\"byteStride\":12", "\"byteStride\":16", "accessor 0 reaches 12 bytes past bufferView 0"},
    {"\"componentType\":5126,\"count\":4", "\"componentType\":5124,\"count\":4", "component type 5124"},
    {"\"componentType\":5126,\"count\":4", "\"componentType\":5130,\"count\":4", "component type 5130"},
    {"\"componentType\":5126,\"count\":4", "\"componentType\":9,\"count\":4", "componentType"},
    {"\"componentType\":5126,\"count\":4", "\"componentType\":5122,\"count\":4",
     "component type 5122, which is not allowed here"},
    {"\"count\":4,\"type\":\"VEC3\"}", "\"count\":4,\"type\":\"VEC2\"}", "accessor 0 has 2 numbers an element"},
    {"\"count\":4,\"type\":\"VEC3\"}", "\"count\":4,\"type\":\"MAT4\"}", "accessor 0 has 0 numbers an element"},
    {"\"count\":4,\"type\":\"VEC3\"}", "\"count\":4,\"type\":\"VEC9\"}", "VEC9"},
    {"\"componentType\":5123,\"normalized\":true", "\"componentType\":5123",
     "component type 5123, which is not allowed here"},
    {"\"name\":\"uv0\",\"bufferView\":2,\"componentType\":5126,\"count\":4",
     "\"name\":\"uv0\",\"bufferView\":2,\"componentType\":5126,\"count\":3",
     "TEXCOORD_0: accessor 2 has 3 elements, POSITION has 4"},
    {"\"componentType\":5123,\"count\":6", "\"componentType\":5126,\"count\":3",
     "component type 5126, which is not allowed here"},
    {"\"componentType\":5123,\"count\":6", "\"componentType\":5123,\"count\":5",
     "has 5 corners, not a multiple of 3"},
    {"\"name\":\"index16\",\"bufferView\":5", "\"name\":\"index16\",\"bufferView\":6",
     "index 3 of accessor 5 is 16256, the primitive has 4 vertices"},
    // meshes
    {"\"POSITION\":0,", "", "meshes[0].primitives[0].attributes.POSITION: is missing"},
    {"\"mode\":4", "\"mode\":9", "meshes[1].primitives[0]: mode is 9"},
    {"\"material\":0", "\"material\":12", "meshes[0].primitives[0]: names material 12, the file has 2"},
    {"\"mesh\":0", "\"mesh\":8", "nodes[1]: names mesh 8, the file has 2"},
    {"\"attributes\":{\"POSITION\":0}", "\"attribute\":{\"POSITION\":0}", "attributes"},
    // materials, textures, images
    {"\"normalTexture\":{\"index\":0", "\"normalTexture\":{\"index\":4",
     "materials[0]: names texture 4, the file has 1"},
    {"\"source\":0", "\"source\":3", "textures[0]: names image 3, the file has 1"},
    {"\"sampler\":0}],", "\"sampler\":3}],", "textures[0]: names sampler 3, the file has 1"},
    {"[0.1,0.2,0.3,1]", "[0.1,0.2,0.3]", "baseColorFactor"},
    {"[0.1,0.2,0.3,1]", "[0.1,1e300,0.3,1]", "materials[0]: baseColorFactor[1] is 1e+300"},
    {"\"alphaCutoff\":0.3", "\"alphaCutoff\":-1", "materials[0]: alphaCutoff is -1"},
    {"\"metallicFactor\":0.4", "\"metallicFactor\":4", "materials[0]: metallicFactor 4"},
    {"\"offset\":[0.25,0.5]", "\"offset\":[1e9,0.5]", "KHR_texture_transform has the number 1e+09"},
    {"image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAI", "image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAA",
     "images[0]: "},
    {"iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwgbABB5A37EGHKQAAAAAElFTkSuQmCC",
     "iVBORw0KGgoAAAANSUhEUgAA6mAAAOpgCAYAAACA0nVCAAAACUlEQVR4nGMAAAABAAFe/335AAAAAElFTkSuQmCC", "images[0]: "},
    {"iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwgbABB5A37EGHKQAAAAAElFTkSuQmCC",
     "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+K", "images[0]: "},
    {"iVBORw0KGgo", "AAAAAAAAAAA", "images[0]: is neither a PNG nor a JPEG file"},
    {"\"images\":[{\"uri\":\"data:image/png;base64,", "\"images\":[{\"uri\":\"data:image/webp;base64,",
     "images"},
    {"\"images\":[{\"uri\":\"data:image/png;base64,", "\"images\":[{\"bufferView\":40,\"x\":\"", "bufferView"},
    {"\"images\":[{\"uri\":\"data:image/png;base64,", "\"images\":[{\"bufferView\":4,\"x\":\"",
     "images[0]: is neither a PNG nor a JPEG"},
    // files beside it
    {"BUFFER_URI", "../secret.bin", "'../secret.bin' leaves the glTF file's folder"},
    {"BUFFER_URI", "a/../../secret.bin", "leaves the glTF file's folder"},
    {"BUFFER_URI", "%2e%2e/secret.bin", "leaves the glTF file's folder"},
    {"BUFFER_URI", "/etc/passwd", "'/etc/passwd' is an absolute path"},
    {"BUFFER_URI", "file:///etc/passwd", "has a scheme we do not read"},
    {"BUFFER_URI", "http://example.org/a.bin", "has a scheme we do not read"},
    {"BUFFER_URI", "missing.bin", "'missing.bin' cannot be read"},
    {"BUFFER_URI", "", "buffer"},
    {"BUFFER_URI", "data:application/octet-stream;base64,AAAA",
     "buffers: a data URI is not base64 of byteLength bytes"},
    {"BUFFER_URI", "data:application/octet-stream;base64,", "buffers: a data URI is not"},
    // nodes
    {"\"children\":[1,2]", "\"children\":[1,99]", "nodes[0].children[1]: names node 99, the file has 6"},
    {"\"children\":[1,2]", "\"children\":[1,1]", "nodes[0].children[1]: node 1 already has the parent 0"},
    {"\"children\":[4,5]", "\"children\":[4,2]", "nodes[3].children[1]: node 2 already has the parent 0"},
    {"\"children\":[1,2]", "\"children\":[1,0]", "nodes[0].children[1]: node 0 is its own child"},
    {"\"name\":\"quad\",", "\"name\":\"quad\",\"children\":[0],", "nodes[0]: is part of a cycle"},
    {"\"nodes\":[0,3]", "\"nodes\":[0,1]", "scenes[0].nodes[1]: node 1 has the parent 0"},
    {"\"nodes\":[0,3]", "\"nodes\":[0,0]", "scenes[0].nodes[1]: node 0 is listed twice"},
    {"\"nodes\":[0,3]", "\"nodes\":[0,30]", "scenes[0].nodes[1]: names node 30"},
    {"\"nodes\":[0,3]", "\"nodes\":[]", "no node of the scene has a mesh"},
    {"\"scene\":0", "\"scene\":4", "scene: names scene 4, the file has 1"},
    {"\"translation\":[1,2,3]", "\"translation\":[1,2]", "nodes[0]: translation has 2 numbers, not 3"},
    {"\"translation\":[1,2,3]", "\"translation\":[1,2,1e200]", "nodes[0]: translation[2] is 1e+200"},
    {"\"rotation\":[0,0,0.70710678,0.70710678]", "\"rotation\":[0,0,0,0]", "nodes[1]: rotation is zero"},
    {"[1,0,0,0,0,1,0,0,0,0,1,0,4,5,6,1]", "[1,0,0,0,0,1,0,0,0,0,1,0,4,5,6]", "nodes[2]: matrix has 15 numbers"},
    {"[1,0,0,0,0,1,0,0,0,0,1,0,4,5,6,1]", "[1,0,0,2,0,1,0,0,0,0,1,0,4,5,6,1]",
     "nodes[2]: matrix is not affine"},
    {"\"mesh\":1", "\"mesh\":1,\"skin\":2", "nodes[3]: names skin 2"},
    {"\"mesh\":1", "\"mesh\":1,\"camera\":2", "nodes[3]: names camera 2"},
    // lights
    {"\"light\":1", "\"light\":11", "nodes[2]: names light 11, the file has 3"},
    {"\"type\":\"point\"", "\"type\":\"candle\"", "lights[1]: type 'candle'"},
    {"\"intensity\":5", "\"intensity\":-5", "lights[1]: intensity is -5"},
    {"\"range\":7", "\"range\":-7", "lights[1]: range is -7"},
    {"\"innerConeAngle\":0.1", "\"innerConeAngle\":0.9", "lights[2]: spot angles 0.9 and 0.5"},
    // animation
    {"\"sampler\":1,\"target\"", "\"sampler\":9,\"target\"",
     "animations[0].channels[1]: names sampler 9, the animation has 2"},
    {"\"target\":{\"node\":3", "\"target\":{\"node\":33", "animations[0].channels[0]: names node 33"},
    {"\"target\":{\"node\":3", "\"target\":{\"node\":2", "animates node 2, which has a matrix"},
    {"\"path\":\"rotation\"", "\"path\":\"colour\"", "animations[0].channels[1]: path 'colour'"},
    {"\"interpolation\":\"LINEAR\"", "\"interpolation\":\"BOUNCE\"", "interpolation 'BOUNCE'"},
    {"\"output\":7", "\"output\":70", "animations[0].samplers[0].output: names accessor 70"},
    {"\"output\":7", "\"output\":2", "animations[0].samplers[0].output: accessor 2 has 2 numbers an element"},
    {"\"output\":7", "\"output\":0", "animations[0].samplers[0].output: has 4 values for 3 keys"},
    {"\"input\":6,\"output\":7", "\"input\":0,\"output\":7",
     "animations[0].samplers[0].input: accessor 0 has 3 numbers"},
    {"\"interpolation\":\"LINEAR\"", "\"interpolation\":\"CUBICSPLINE\"", "has 3 values for 3 cubic keys"},
    // extensions
    {"\"extensionsUsed\":", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"extensionsUsed\":",
     "extensionsRequired: the file cannot be shown without 'KHR_draco_mesh_compression'"},
};

static bool refused(struct scene *scene, const char *error, const char *says, const char *what)
{
    bool ok = scene == NULL && strstr(error, says) != NULL && strstr(error, "made.gl") != NULL &&
              strchr(error, '\n') == NULL && strlen(error) < 900;
    if (!ok)
        print_error("for %s\n  expected: %s\n  got:      %s\n", what, says, scene != NULL ? "a scene" : error);
    scene_destroy(scene);
    return ok;
}

static void expect_refusal(struct scene *scene, const char *error, const char *says, const char *what)
{
    assert_true(refused(scene, error, says, what));
}

static void refuses_each_mutation(void **state)
{
    (void)state;
    size_t tried = 0, wrong = 0;
    for (size_t i = 0; i < sizeof mutations / sizeof mutations[0]; i++) {
        struct gltf_file_text file;
        char error[1024] = "";
        gltf_file_make(&file);
        gltf_file_replace(&file, mutations[i].old, mutations[i].now);
        wrong +=
            !refused(gltf_file_open(&file, error, sizeof error), error, mutations[i].says, mutations[i].now);
        tried++;
    }
    assert_true(tried >= 60);
    assert_int_equal(wrong, 0);
}

// The same file, with its primitive on another accessor and the bytes or text of that accessor damaged.
static void refuses_sparse_faults(void **state)
{
    (void)state;
    static const struct mutation faults[] = {
        {"\"sparse\":{\"count\":1", "\"sparse\":{\"count\":9", "sparse.count is 9"},
        {"\"bufferView\":11,\"componentType\":5123", "\"bufferView\":11,\"componentType\":5122",
         "sparse.indices have component type 5122"},
        {"\"bufferView\":11", "\"bufferView\":40", "sparse.indices names bufferView 40"},
        {"\"bufferView\":12", "\"bufferView\":11", "sparse.values reaches 10 bytes past bufferView 11"},
        {"\"bufferView\":11", "\"bufferView\":8", "sparse.indices[0] is 200"},
    };
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        struct gltf_file_text file;
        char error[1024] = "";
        gltf_file_make(&file);
        gltf_file_replace(&file, "\"POSITION\":0", "\"POSITION\":11");
        gltf_file_replace(&file, faults[i].old, faults[i].now);
        file.bytes[AT_TURNS] = 200; // what the last fault reads as its index
        expect_refusal(gltf_file_open(&file, error, sizeof error), error, faults[i].says, faults[i].now);
    }
}

static void refuses_bad_bytes(void **state)
{
    (void)state;
    static const struct {
        int at;
        float value;
        const char *says;
    } faults[] = {
        {AT_POSITION + 16, NAN, "meshes[0].primitives[0]: element 1 of accessor 0 is infinite or not a number"},
        {AT_POSITION + 16, INFINITY, "element 1 of accessor 0 is infinite or not a number"},
        {AT_NORMAL, -INFINITY, "element 0 of accessor 1 is infinite"},
        {AT_UV0 + 8, NAN, "element 1 of accessor 2"},
        {AT_TIMES + 4, 0.0f, "animations[0].samplers[0].input: key time 1 is 0; times must rise"},
        {AT_TIMES, -1.0f, "key time 0 is -1"},
        {AT_MOVES + 4, 1e30f, "animations[0].samplers[0].output: a value is 1e+30"},
        {AT_TURNS + 12, 0.0f, "animations[0].samplers[1].output: rotation of key 0"},
    };
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        struct gltf_file_text file;
        char error[1024] = "";
        gltf_file_make(&file);
        memcpy(file.bytes + faults[i].at, &faults[i].value, sizeof faults[i].value);
        expect_refusal(gltf_file_open(&file, error, sizeof error), error, faults[i].says, faults[i].says);
    }
}

static void refuses_damaged_containers(void **state)
{
    (void)state;
    static const struct {
        int at; // from the start; -1: only the size changes, -2: from the BIN chunk's header
        uint32_t value;
        int cut;
        const char *says;
    } faults[] = {
        {-1, 0, 1, "it is truncated or damaged"},
        {-1, 0, 400, "it is truncated or damaged"},
        {4, 1, 0, "GLB version 1; we read version 2"},
        {8, 0xffffffff, 0, "the GLB header says 4294967295 bytes"},
        {12, 0xfffffffc, 0, "JSON chunk reaches past"},
        {12, 0, 0, "JSON chunk length is not a positive"},
        {12, 7, 0, "JSON chunk length is not a positive multiple of 4"},
        {16, 0x12345678, 0, "first chunk is not of type JSON"},
        {-2, 0xfffffffc, 0, "BIN chunk reaches"},
        {-2, 464, 0, "BIN chunk reaches 4 bytes past the end"},
        {-2, 3, 0, "BIN chunk length is not"},
        {-2, 456, 0, "byteLength"},
    };
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        struct gltf_file_text file;
        char error[1024] = "";
        size_t size = 0;
        gltf_file_make(&file);
        uint8_t *glb = gltf_file_glb(&file, &size);
        int at = faults[i].at == -2 ? (int)size - AT_END - 8 : faults[i].at;
        if (at >= 0)
            memcpy(glb + at, &faults[i].value, 4);
        struct scene *scene =
            gltf_file_open_bytes("made.glb", glb, size - (size_t)faults[i].cut, error, sizeof error);
        expect_refusal(scene, error, faults[i].says, faults[i].says);
        free(glb);
    }
    char error[1024] = "";
    expect_refusal(gltf_file_open_bytes("made.glb", "glTF", 4, error, sizeof error), error, "header is cut off",
                   "4 bytes");
    expect_refusal(gltf_file_open_bytes("made.gltf", "", 0, error, sizeof error), error, "is empty", "no byte");
    expect_refusal(gltf_file_open_bytes("made.gltf", "hello", 5, error, sizeof error), error,
                   "1:1: syntax error", "text");
    assert_null(scene_open("/nowhere/made.gltf", error, sizeof error));
    assert_non_null(strstr(error, "/nowhere/made.gltf: cannot be read: No such file"));
    assert_null(scene_open("/", error, sizeof error));
    assert_non_null(strstr(error, "is not a regular file"));
}

static void refuses_deep_and_crowded_files(void **state)
{
    (void)state;
    char *json = malloc(1 << 16), error[1024] = "";
    assert_non_null(json);
    char *to =
        json + sprintf(json, "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
    for (int i = 0; i < 400; i++)
        to += sprintf(to, "%s{\"children\":[%d]}", i > 0 ? "," : "", i + 1);
    sprintf(to, ",{}]}");
    expect_refusal(gltf_file_open_json(json, error, sizeof error), error, "has more than 256 ancestors",
                   "a deep tree");
    free(json);
    // Three bytes an object: would be half a gigabyte of nodes.
    size_t size = 3u * 1100000u + 64;
    json = malloc(size);
    assert_non_null(json);
    to = json + sprintf(json, "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}");
    for (int i = 0; i < 1100000; i++)
        to += sprintf(to, ",{}");
    sprintf(to, "]}");
    expect_refusal(gltf_file_open_json(json, error, sizeof error), error, "1,000,000 JSON objects", "a crowd");
    free(json);
}

static void refuses_unknown_names(void **state)
{
    (void)state;
    char error[256] = "";
    assert_null(scene_open("nosuch:seed=3", error, sizeof error));
    assert_non_null(strstr(error, "'nosuch:seed=3' is neither a built-in scene"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refuses_each_mutation),
        cmocka_unit_test(refuses_sparse_faults),
        cmocka_unit_test(refuses_bad_bytes),
        cmocka_unit_test(refuses_damaged_containers),
        cmocka_unit_test(refuses_deep_and_crowded_files),
        cmocka_unit_test(refuses_unknown_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
