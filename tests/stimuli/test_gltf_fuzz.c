// Seeded damage to whole files: byte flips, runs, truncation, and changed digits. The loader may open or refuse
// each; the sanitizer build shows that it never reads or writes past anything. A refusal always has a sentence.
#include "tests/stimuli/gltf_file.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 150 };

// SplitMix64 (Steele et al. 2014)
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static size_t below(uint64_t *state, size_t limit)
{
    return (size_t)(next_random(state) % limit);
}

// Most changes fall into the header and the JSON, where structure is.
static size_t place(uint64_t *state, size_t size, size_t json_size)
{
    return below(state, 4) != 0 ? below(state, json_size) : below(state, size);
}

static void damage(uint64_t *state, uint8_t *bytes, size_t *size, size_t json_size)
{
    size_t at = place(state, *size, json_size), count = 1 + below(state, 4);
    switch (below(state, 5)) {
    case 0:
        for (size_t i = 0; i < count; i++)
            bytes[place(state, *size, json_size)] = (uint8_t)next_random(state);
        break;
    case 1:
        for (size_t i = 0; i < 16 && at + i < *size; i++)
            bytes[at + i] = (uint8_t)next_random(state);
        break;
    case 2:
        *size = 1 + below(state, *size);
        break;
    default: // another number: still JSON, no longer true
        for (size_t tries = 0; tries < 4000 && count > 0; tries++) {
            size_t digit = 20 + below(state, json_size - 20);
            if (isdigit(bytes[digit])) {
                bytes[digit] = (uint8_t)('0' + below(state, 10));
                count--;
            }
        }
    }
}

static void fuzz(const char *name, const uint8_t *original, size_t original_size, size_t json_size,
                 uint64_t seed)
{
    uint8_t *bytes = malloc(original_size);
    assert_non_null(bytes);
    unsigned opened = 0, refused = 0;
    clock_t start = clock();
    for (int round = 0; round < ROUNDS && (clock() - start) / CLOCKS_PER_SEC < 30; round++) {
        size_t size = original_size;
        char error[1024] = "";
        memcpy(bytes, original, original_size);
        damage(&seed, bytes, &size, json_size);
        struct scene *scene = gltf_file_open_bytes(name, bytes, size, error, sizeof error);
        opened += scene != NULL;
        refused += scene == NULL;
        if (scene == NULL && (strstr(error, name) == NULL || strlen(error) < strlen(name) + 8))
            fail_msg("round %d: no sentence: %s", round, error);
        scene_destroy(scene);
    }
    print_message("%s: %u opened, %u refused\n", name, opened, refused);
    assert_true(refused > 0);
    free(bytes);
}

static void survives_damage_to_the_made_file(void **state)
{
    (void)state;
    struct gltf_file_text file;
    size_t size = 0;
    gltf_file_make(&file);
    uint8_t *glb = gltf_file_glb(&file, &size);
    fuzz("made.glb", glb, size, size - AT_END, 1);
    free(glb);
    char *uri = gltf_file_data_uri("application/octet-stream", file.bytes, AT_END);
    gltf_file_replace(&file, "BUFFER_URI", uri);
    fuzz("made.gltf", (const uint8_t *)file.json, strlen(file.json), strlen(file.json), 2);
    free(uri);
}

static void fuzz_sample(const char *folder, const char *sample, uint64_t seed)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, sample);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    assert_int_equal(fseek(stream, 0, SEEK_END), 0);
    size_t size = (size_t)ftell(stream);
    rewind(stream);
    uint8_t *bytes = malloc(size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, size, stream), size);
    fclose(stream);
    size_t json_size = 20 + ((size_t)bytes[12] | (size_t)bytes[13] << 8 | (size_t)bytes[14] << 16);
    fuzz("sample.glb", bytes, size, json_size, seed);
    free(bytes);
}

static void survives_damage_to_the_samples(void **state)
{
    (void)state;
    const char *folder = gltf_file_scenes();
    if (folder == NULL)
        skip();
    fuzz_sample(folder, "CesiumMilkTruck/CesiumMilkTruck.glb", 3);
    fuzz_sample(folder, "CesiumMan/CesiumMan.glb", 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(survives_damage_to_the_made_file),
        cmocka_unit_test(survives_damage_to_the_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
