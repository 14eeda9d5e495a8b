// The real test scenes: triangle counts as their README states them, and what each is there for.
#include "tests/stimuli/gltf_file.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

struct sample {
    const char *file;
    uint64_t triangles, unique;
    uint32_t lights, masks;
    bool moves;
    const char *notes;
};

static const struct sample samples[] = {
    {"Sponza/Sponza.gltf", 262267, 262267, 0, 1, false, ""},
    {"MedievalVillage/MedievalVillage.gltf", 3334874, 118314, 0, 1, false, ""},
    {"KayKitCity_L/KayKitCity_L.gltf", 5237721, 19845, 0, 0, true, ""},
    {"KayKitCity_S/KayKitCity_S.gltf", 594265, 19845, 64, 0, true, ""},
    {"DreamApartment/DreamApartment.gltf", 177934, 177934, 0, 0, false, ""},
    {"PolyHavenFern/Fern02.gltf", 6232, 6232, 0, 1, false, ""},
    {"CesiumMilkTruck/CesiumMilkTruck.glb", 3624, 2856, 0, 0, true, ""},
    {"CesiumMan/CesiumMan.glb", 4672, 4672, 0, 0, false, "1 skinned node(s) drawn without their skin.\n"},
};

static void check_arrays(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->index_count; i++)
        if (scene->indices[i] >= scene->vertex_count)
            fail_msg("index %u is %u of %u", i, scene->indices[i], scene->vertex_count);
    for (uint32_t i = 0; i < scene->vertex_count; i++)
        if (scene->vertices[i].tangent[3] != 32767 && scene->vertices[i].tangent[3] != -32767)
            fail_msg("vertex %u has no tangent", i);
    for (uint32_t i = 0; i < scene->submodel_count; i++) {
        const struct scene_submodel *s = &scene->submodels[i];
        assert_in_range(s->index_count, 3, SCENE_SUBMODEL_TRIANGLES * 3);
        assert_true(s->first_index + s->index_count <= scene->index_count);
        assert_true(s->material < scene->material_count);
    }
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        assert_non_null(scene->textures[i].rgba);
        assert_true(scene->textures[i].levels > 1);
    }
}

static void opens_the_samples(void **state)
{
    (void)state;
    const char *folder = gltf_file_scenes();
    if (folder == NULL)
        skip();
    for (size_t i = 0; i < sizeof samples / sizeof samples[0]; i++) {
        const struct sample *sample = &samples[i];
        char path[512], error[1024] = "";
        struct timespec start, end;
        snprintf(path, sizeof path, "%s/%s", folder, sample->file);
        clock_gettime(CLOCK_MONOTONIC, &start);
        struct scene *scene = scene_open(path, error, sizeof error);
        clock_gettime(CLOCK_MONOTONIC, &end);
        if (scene == NULL)
            fail_msg("%s", error);
        print_message("%s: %.2f s\n", sample->file,
                      (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec));
        check_arrays(scene);
        uint32_t masks = 0;
        for (uint32_t k = 0; k < scene->material_count; k++)
            masks += scene->materials[k].alpha_mask;
        assert_int_equal(scene->triangle_count, sample->triangles);
        assert_int_equal(scene->index_count / 3, sample->unique);
        assert_int_equal(scene->light_count, sample->lights);
        assert_true(sample->masks > 0 ? masks > 0 : masks == 0);
        assert_int_equal(scene->moving_count > 0, sample->moves);
        assert_string_equal(scene->notes, sample->notes);
        assert_true(scene->path.knot_count > 0 && scene->path.duration_s > 1.0);
        assert_true(scene->luminance > 0.0f && isfinite(scene->luminance));
        assert_true(scene->sun.illuminance[0] > 0.0f && scene->sky.zenith[2] > 0.0f);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(opens_the_samples)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
