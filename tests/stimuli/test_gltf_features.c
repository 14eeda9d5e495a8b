// What a file says is what the scene has, to the number.
#include "tests/stimuli/gltf_file.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <stb_image_write.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NEAR(a, b) assert_true(fabs((double)(a) - (double)(b)) < 1e-5)

static struct scene *open_made(const struct gltf_file_text *file)
{
    char error[1024] = "";
    struct scene *scene = gltf_file_open(file, error, sizeof error);
    if (scene == NULL)
        fail_msg("%s", error);
    return scene;
}

static struct scene *open_changed(const char *old, const char *now)
{
    struct gltf_file_text file;
    gltf_file_make(&file);
    if (old != NULL)
        gltf_file_replace(&file, old, now);
    return open_made(&file);
}

static const struct scene_vertex *find_vertex(const struct scene *scene, uint32_t mesh, float x, float y)
{
    for (uint32_t s = 0; s < scene->meshes[mesh].submodel_count; s++) {
        const struct scene_submodel *sub = &scene->submodels[scene->meshes[mesh].first_submodel + s];
        for (uint32_t i = 0; i < sub->index_count; i++) {
            const struct scene_vertex *v = &scene->vertices[scene->indices[sub->first_index + i]];
            if (fabsf(v->position[0] - x) < 1e-4f && fabsf(v->position[1] - y) < 1e-4f)
                return v;
        }
    }
    fail_msg("mesh %u has no vertex at %g %g", mesh, (double)x, (double)y);
    return NULL;
}

static uint32_t mesh_triangles(const struct scene *scene, uint32_t mesh)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->meshes[mesh].submodel_count; s++)
        count += scene->submodels[scene->meshes[mesh].first_submodel + s].index_count / 3;
    return count;
}

static void reads_vertices(void **state)
{
    (void)state;
    struct scene *scene = open_changed(NULL, NULL);
    assert_int_equal(scene->vertex_count, 4 + 6); // the mesh without normals is flat: a vertex a corner
    assert_int_equal(scene->index_count, 12);
    assert_int_equal(scene->triangle_count, 4);
    const struct scene_vertex *v = find_vertex(scene, 0, 0, 1);
    NEAR(v->uv[0][0], 0);
    NEAR(v->uv[0][1], 0);
    NEAR(v->uv[1][0], 0.2);
    NEAR(v->uv[1][1], 0);
    const uint8_t colour[4] = {10, 20, 30, 40};
    assert_memory_equal(v->colour, colour, 4);
    assert_int_equal(v->normal[0], 0);
    assert_int_equal(v->normal[1], 0);
    // u to the right, v down: tangent +x, and cross(n, t) = +y is against v
    assert_int_equal(v->tangent[0], 32767);
    assert_int_equal(v->tangent[3], -32767);
    v = find_vertex(scene, 1, 1, 1);
    const uint8_t white[4] = {255, 255, 255, 255};
    assert_memory_equal(v->colour, white, 4);
    assert_int_equal(v->normal[0], 0);
    scene_destroy(scene);
}

static void reads_materials_and_textures(void **state)
{
    (void)state;
    struct scene *scene = open_changed(NULL, NULL);
    assert_int_equal(scene->material_count, 2);
    const struct scene_material *m = &scene->materials[0];
    assert_string_equal(m->name, "painted");
    NEAR(m->base_colour[2], 0.3);
    NEAR(m->emissive[1], 0.25);
    NEAR(m->metallic, 0.4);
    NEAR(m->roughness, 0.6);
    NEAR(m->alpha_cutoff, 0.3);
    NEAR(m->normal_scale, 0.75);
    NEAR(m->occlusion_strength, 0.5);
    assert_true(m->alpha_mask && m->double_sided && !scene->materials[1].alpha_mask);
    NEAR(scene->materials[1].metallic, 1);
    const struct scene_texture_use *use = &m->use[SCENE_BASE_COLOUR];
    assert_int_equal(use->uv_set, 1);
    // a quarter turn: u' = 3 v + 0.25, v' = -2 u + 0.5
    const double transform[6] = {0, 3, 0.25, -2, 0, 0.5};
    for (int k = 0; k < 6; k++)
        NEAR(use->transform[k], transform[k]);
    // One image, stored as sRGB for colour and as it is for normals and occlusion, which share a texture.
    assert_int_equal(scene->texture_count, 2);
    assert_int_equal(m->use[SCENE_NORMAL].texture, m->use[SCENE_OCCLUSION].texture);
    assert_int_equal(m->use[SCENE_EMISSIVE].texture, -1);
    const struct scene_texture *t = &scene->textures[use->texture];
    assert_true(t->srgb && t->nearest && !scene->textures[m->use[SCENE_NORMAL].texture].srgb);
    assert_int_equal(t->wrap_u, SCENE_CLAMP);
    assert_int_equal(t->wrap_v, SCENE_MIRROR);
    assert_int_equal(t->width, 2);
    assert_int_equal(t->levels, 2);
    const uint8_t pixels[8] = {255, 0, 0, 255, 0, 255, 0, 128};
    assert_memory_equal(t->rgba, pixels, 8);
    scene_destroy(scene);
}

static void reads_nodes_and_instances(void **state)
{
    (void)state;
    struct scene *scene = open_changed(NULL, NULL);
    assert_int_equal(scene->node_count, 6);
    assert_int_equal(scene->instance_count, 2);
    for (uint32_t i = 0; i < scene->node_count; i++)
        assert_true(scene->nodes[i].parent < (int32_t)i);
    struct dmat4 world[6];
    scene_pose(scene, 0.0, false, world);
    const struct scene_instance *quad = &scene->instances[scene->instances[0].mesh == 0 ? 0 : 1];
    assert_int_equal(quad->moving_id, 0);
    // (1, 0, 0) scaled by 2, a quarter turn about z, moved by (1, 2, 3)
    struct dvec3 p = dmat4_point(&world[quad->node], (struct dvec3){1, 0, 0});
    NEAR(p.x, 1);
    NEAR(p.y, 4);
    NEAR(p.z, 3);
    NEAR(scene->bounds_min.x, -1);
    NEAR(scene->bounds_max.y, 4);
    scene_destroy(scene);
    scene = open_changed("\"scenes\":[{\"nodes\":[0,3]}]", "\"scenes\":[{\"nodes\":[3]},{\"nodes\":[0]}]");
    assert_int_equal(scene->instance_count, 1);
    assert_non_null(strstr(scene->notes, "1 further scene"));
    scene_destroy(scene);
    scene = open_changed("\"scene\":0,\"scenes\":[{\"nodes\":[0,3]}],", "");
    assert_int_equal(scene->node_count, 6);
    scene_destroy(scene);
    scene = open_changed("\"mesh\":1", "\"mesh\":0"); // shared
    assert_int_equal(scene->instances[0].mesh, scene->instances[1].mesh);
    assert_int_equal(scene->triangle_count, 4);
    scene_destroy(scene);
}

static void reads_lights(void **state)
{
    (void)state;
    struct scene *scene = open_changed(NULL, NULL);
    // the sun's node is turned -90 degrees about x: its light falls along -y
    NEAR(scene->sun.direction.y, 1);
    NEAR(scene->sun.illuminance[0], 8);
    NEAR(scene->sun.illuminance[2], 2);
    assert_int_equal(scene->light_count, 2);
    const struct scene_light *point = &scene->lights[scene->lights[0].cos_outer < -1.0f ? 0 : 1];
    const struct scene_light *spot = &scene->lights[scene->lights[0].cos_outer < -1.0f ? 1 : 0];
    NEAR(point->position.x, 5);
    NEAR(point->position.y, 7);
    NEAR(point->position.z, 9);
    NEAR(point->intensity[1], 5);
    NEAR(point->range_m, 7);
    NEAR(spot->cos_inner, cos(0.1));
    NEAR(spot->cos_outer, cos(0.5));
    NEAR(spot->direction.z, -1);
    assert_true(spot->range_m > 1.0f && isfinite(spot->range_m));
    scene_destroy(scene);
    scene = open_changed("\"intensity\":8}", "\"intensity\":0}"); // no sun left: ours, dimmed beside lamps
    assert_true(scene->sun.illuminance[0] > 1.0f && scene->sky.zenith[0] > 0.0f);
    scene_destroy(scene);
}

static void plays_animation(void **state)
{
    (void)state;
    struct scene *scene = open_changed(NULL, NULL);
    assert_int_equal(scene->moving_count, 1);
    NEAR(scene->animation_s, 3);
    uint32_t node = scene->instances[scene->instances[0].moving_id > 0 ? 0 : 1].node;
    struct dmat4 world[6];
    scene_pose(scene, 2.0, false, world);
    NEAR(world[node].m[12], 2);
    NEAR(world[node].m[13], 2);
    struct dvec3 x = dmat4_direction(&world[node], (struct dvec3){1, 0, 0});
    NEAR(atan2(x.y, x.x), 2.356194490); // half way from 90 to 180 degrees
    scene_destroy(scene);
    struct gltf_file_text file;
    gltf_file_make(&file);
    gltf_file_replace(&file, "\"output\":7,\"interpolation\":\"LINEAR\"",
                      "\"output\":12,\"interpolation\":\"CUBICSPLINE\"");
    scene = open_made(&file);
    scene_pose(scene, 1.0, false, world);
    NEAR(world[node].m[12], 10);
    NEAR(world[node].m[14], 30);
    scene_pose(scene, 0.5, false, world); // values 0 and 10, out-tangent 1, in-tangent 4, step 1
    NEAR(world[node].m[12], 5 + 0.125 * 1 - 0.125 * 4);
    scene_destroy(scene);
    scene = open_changed("\"interpolation\":\"LINEAR\"", "\"interpolation\":\"STEP\"");
    scene_pose(scene, 2.9, false, world);
    NEAR(world[node].m[12], 2);
    NEAR(world[node].m[13], 0);
    scene_destroy(scene);
}

static void reads_every_index_type_and_mode(void **state)
{
    (void)state;
    static const struct {
        const char *now;
        uint32_t triangles;
    } cases[] = {
        {"\"indices\":9,\"material\":1,\"mode\":4", 2},
        {"\"indices\":10,\"material\":1", 2},
        {"\"indices\":5,\"material\":1", 2},
        {"\"material\":1,\"mode\":5", 2},
        {"\"material\":1,\"mode\":6", 2},
        {"\"indices\":9,\"material\":1,\"mode\":5", 4},
        {"\"indices\":9,\"material\":1,\"mode\":6", 4},
        {"\"indices\":9,\"material\":1,\"mode\":0", 0},
        {"\"indices\":9,\"material\":1,\"mode\":3", 0},
        {"\"indices\":9", 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct scene *scene = open_changed("\"indices\":9,\"material\":1,\"mode\":4", cases[i].now);
        assert_int_equal(mesh_triangles(scene, 1), cases[i].triangles);
        if (i == 7)
            assert_string_equal(scene->notes, "1 primitive(s) of points not drawn.\n");
        if (i == 8)
            assert_string_equal(scene->notes, "1 primitive(s) of lines not drawn.\n");
        assert_int_equal(scene->material_count, i == 9 ? 3 : 2);
        scene_destroy(scene);
    }
}

static void winds_strips_and_fans(void **state)
{
    (void)state;
    // 0 1 3 2 is a strip over the square; 0 1 2 3 is a fan: all four triangles face +z.
    for (int fan = 0; fan < 2; fan++) {
        struct gltf_file_text file;
        gltf_file_make(&file);
        const uint8_t strip[4] = {0, 1, 3, 2}, around[4] = {0, 1, 2, 3};
        memcpy(file.bytes + AT_INDEX8, fan ? around : strip, 4);
        gltf_file_replace(&file, "\"componentType\":5121,\"count\":6", "\"componentType\":5121,\"count\":4");
        gltf_file_replace(&file, "\"mode\":4", fan ? "\"mode\":6" : "\"mode\":5");
        struct scene *scene = open_made(&file);
        const struct scene_submodel *s = &scene->submodels[scene->meshes[1].first_submodel];
        assert_int_equal(s->index_count, 6);
        for (uint32_t i = s->first_index; i < s->first_index + 6; i += 3) {
            const float *a = scene->vertices[scene->indices[i]].position,
                        *b = scene->vertices[scene->indices[i + 1]].position;
            const float *c = scene->vertices[scene->indices[i + 2]].position;
            float cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            NEAR(cross, 1);
        }
        scene_destroy(scene);
    }
}

static void reads_sparse_and_quantised_positions(void **state)
{
    (void)state;
    struct scene *scene = open_changed("\"POSITION\":0", "\"POSITION\":11");
    assert_true(fabsf(find_vertex(scene, 0, 5, 6)->position[2] - 7) < 1e-6f);
    find_vertex(scene, 0, 0, 1);
    scene_destroy(scene);
    struct gltf_file_text file;
    gltf_file_make(&file);
    gltf_file_replace(&file, "\"POSITION\":0", "\"POSITION\":13");
    char error[1024] = "";
    assert_null(gltf_file_open(&file, error, sizeof error)); // only with the extension
    gltf_file_replace(
        &file, "\"extensionsUsed\":[",
        "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"extensionsUsed\":[\"KHR_mesh_quantization\",");
    scene = open_made(&file);
    find_vertex(scene, 0, 1, 1);
    find_vertex(scene, 0, 0, -1);
    scene_destroy(scene);
    gltf_file_replace(&file, "\"componentType\":5122,\"normalized\":true", "\"componentType\":5122");
    scene = open_made(&file);
    find_vertex(scene, 0, 32767, 32767);
    scene_destroy(scene);
}

static void names_what_is_not_drawn(void **state)
{
    (void)state;
    static const struct {
        const char *old, *now, *note;
    } cases[] = {
        {"\"alphaMode\":\"MASK\"", "\"alphaMode\":\"BLEND\"", "1 blended material(s) drawn opaque.\n"},
        {"\"name\":\"plain\"", "\"name\":\"plain\",\"extensions\":{\"KHR_materials_clearcoat\":{}}",
         "1 material(s) drawn without their KHR_materials extensions.\n"},
        {"\"indices\":5", "\"targets\":[{\"POSITION\":0}],\"indices\":5",
         "1 primitive(s) drawn without their morph targets.\n"},
        {"\"texCoord\":1", "\"texCoord\":3", "1 texture(s) on TEXCOORD_2 or higher not drawn.\n"},
        {"\"animations\":[", "\"animations\":[{\"channels\":[],\"samplers\":[]},",
         "1 further animation(s) not played; the first is.\n"},
        {"\"extensionsUsed\":[", "\"extensionsUsed\":[\"EXT_odd\",",
         "1 extension(s) not read, first EXT_odd.\n"},
        {"\"light\":1", "\"light\":0", "1 further directional light(s) not drawn; the brightest is the sun.\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct scene *scene = open_changed(cases[i].old, cases[i].now);
        assert_string_equal(scene->notes, cases[i].note);
        scene_destroy(scene);
    }
    struct gltf_file_text file;
    gltf_file_make(&file);
    gltf_file_replace(&file, "\"mesh\":1", "\"mesh\":1,\"skin\":0,\"camera\":0");
    gltf_file_replace(&file, "\"meshes\":",
                      "\"skins\":[{\"joints\":[0]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{"
                      "\"yfov\":1,\"znear\":0.1}}],\"meshes\":");
    struct scene *scene = open_made(&file);
    assert_string_equal(scene->notes, "1 skinned node(s) drawn without their skin.\n1 camera(s) not used.\n");
    scene_destroy(scene);
}

static void flies_through_three_cameras(void **state)
{
    (void)state;
    struct gltf_file_text file;
    gltf_file_make(&file);
    gltf_file_replace(&file, "\"name\":\"root\"", "\"name\":\"root\",\"camera\":0");
    gltf_file_replace(&file, "\"name\":\"lamp\"", "\"name\":\"lamp\",\"camera\":0");
    gltf_file_replace(&file, "\"name\":\"spot\"", "\"name\":\"spot\",\"camera\":0");
    gltf_file_replace(
        &file, "\"meshes\":",
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.1}}],\"meshes\":");
    struct scene *scene = open_made(&file);
    assert_int_equal(scene->path.knot_count, 3);
    NEAR(scene->path.knots[1].position.y, 7);
    assert_string_equal(scene->notes, "");
    scene_destroy(scene);
}

static void reads_containers_and_files_beside(void **state)
{
    (void)state;
    struct gltf_file_text file;
    char error[1024] = "", path[512];
    size_t size = 0;
    gltf_file_make(&file);
    uint8_t *glb = gltf_file_glb(&file, &size);
    struct scene *scene = gltf_file_open_bytes("made.GLB", glb, size, error, sizeof error);
    assert_non_null(scene);
    assert_int_equal(scene->triangle_count, 4);
    assert_string_equal(scene->name, "made");
    scene_destroy(scene);
    free(glb);
    gltf_file_replace(&file, "BUFFER_URI", "two%20words.bin");
    gltf_file_path("two words.bin", path, sizeof path);
    gltf_file_write(path, file.bytes, AT_END);
    scene = gltf_file_open(&file, error, sizeof error);
    if (scene == NULL)
        fail_msg("%s", error);
    scene_destroy(scene);
    remove(path);
}

struct image_file {
    uint8_t bytes[65536];
    size_t size;
};

static void append_bytes(void *context, void *data, int size)
{
    struct image_file *out = context;
    assert_true(out->size + (size_t)size <= sizeof out->bytes);
    memcpy(out->bytes + out->size, data, (size_t)size);
    out->size += (size_t)size;
}

static void reads_each_kind_of_image(void **state)
{
    (void)state;
    static const char given[] =
        "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwgbABB5A37EGHKQAAAAAElFTkSuQmCC";
    static const struct {
        const char *base64;
        uint8_t pixels[8];
    } cases[] = {
        // 16 bit: 0xffff 0x8000 0, 0x1234 0xabcd 0xffff
        {"iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR42mP4/7+BgYFByGT12f//ASV2BjsA/"
         "TfxAAAAAElFTkSuQmCC",
         {255, 128, 0, 255, 0x12, 0xab, 255, 255}},
        // gray 10, 200
        {"iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAAAAADRSSBWAAAAC0lEQVR42mPgOgEAAN8A09iF0q4AAAAASUVORK5CYII=",
         {10, 10, 10, 255, 200, 200, 200, 255}},
        // palette
        {"iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAMAAADD/"
         "I+4AAAABlBMVEUBAgMoMjzyD6lKAAAAC0lEQVR42mNgZAAAAAUAAkLCRJ8AAAAASUVORK5CYII=",
         {40, 50, 60, 255, 1, 2, 3, 255}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct scene *scene = open_changed(given, cases[i].base64);
        assert_memory_equal(scene->textures[0].rgba, cases[i].pixels, 8);
        scene_destroy(scene);
    }
    struct image_file *jpeg = calloc(1, sizeof *jpeg);
    uint8_t red[16 * 16 * 3] = {0};
    for (size_t i = 0; i < sizeof red; i += 3)
        red[i] = 200;
    assert_int_not_equal(stbi_write_jpg_to_func(append_bytes, jpeg, 16, 16, 3, red, 95), 0);
    char *uri = gltf_file_data_uri("image/jpeg", jpeg->bytes, jpeg->size);
    char old[256];
    snprintf(old, sizeof old, "data:image/png;base64,%s", given);
    struct scene *scene = open_changed(old, uri);
    assert_int_equal(scene->textures[0].width, 16);
    assert_int_equal(scene->textures[0].levels, 5);
    assert_in_range(scene->textures[0].rgba[0], 195, 205);
    scene_destroy(scene);
    free(uri);
    free(jpeg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_vertices),
        cmocka_unit_test(reads_materials_and_textures),
        cmocka_unit_test(reads_nodes_and_instances),
        cmocka_unit_test(reads_lights),
        cmocka_unit_test(plays_animation),
        cmocka_unit_test(reads_every_index_type_and_mode),
        cmocka_unit_test(winds_strips_and_fans),
        cmocka_unit_test(reads_sparse_and_quantised_positions),
        cmocka_unit_test(names_what_is_not_drawn),
        cmocka_unit_test(flies_through_three_cameras),
        cmocka_unit_test(reads_containers_and_files_beside),
        cmocka_unit_test(reads_each_kind_of_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
