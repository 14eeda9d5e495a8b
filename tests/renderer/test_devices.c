// What a device lacks is said in one sentence, and nothing is created.
#include "renderer/renderer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct heard {
    int sentences;
    char last[1024];
};

static void hear(void *user, enum renderer_log_level level, const char *sentence)
{
    struct heard *heard = user;
    if (level != RENDERER_ERROR)
        return;
    heard->sentences++;
    snprintf(heard->last, sizeof heard->last, "%s", sentence);
}

static void refused(const struct renderer_desc *given, const char *about)
{
    struct heard heard = {0};
    struct renderer_desc desc = *given;
    desc.log = (struct renderer_log){hear, &heard};
    assert_null(renderer_create(&desc));
    assert_int_equal(heard.sentences, 1);
    if (!strstr(heard.last, about))
        fail_msg("'%s' does not say '%s'", heard.last, about);
}

static void a_device_of_another_name(void **state)
{
    (void)state;
    refused(&(struct renderer_desc){.width = 64, .height = 64, .device = "Voodoo 2"}, "contains 'Voodoo 2'");
}

static void sizes_out_of_range(void **state)
{
    (void)state;
    refused(&(struct renderer_desc){.width = 15, .height = 64}, "16x16 to 16384x16384");
    refused(&(struct renderer_desc){.width = 64, .height = 20000}, "16x16 to 16384x16384");
}

// The layer beside this test hides a feature of the real device.
static void use_poor_layer(const char *feature)
{
    setenv("VK_LAYER_PATH", POOR_LAYER_DIR, 1);
    setenv("VK_INSTANCE_LAYERS", "VK_LAYER_FOVSTUDY_poor", 1);
    setenv("POOR_FEATURE", feature, 1);
}

static void use_no_layer(void)
{
    unsetenv("VK_LAYER_PATH");
    unsetenv("VK_INSTANCE_LAYERS");
    unsetenv("POOR_FEATURE");
}

static void a_device_without_what_every_mode_needs(void **state)
{
    (void)state;
    const struct renderer_desc desc = {.width = 64, .height = 64};
    use_poor_layer("Vulkan 1.3");
    refused(&desc, "lacks Vulkan 1.3");
    use_poor_layer("drawIndirectCount");
    refused(&desc, "lacks drawIndirectCount");
    use_no_layer();
}

// A mode that needs more than the others refuses, and the others go on.
static void refuses_alone(const char *feature, const char *mode, const char *about)
{
    struct heard heard = {0};
    char error[512];
    use_poor_layer(feature);
    struct renderer *r =
        renderer_create(&(struct renderer_desc){.log = {hear, &heard}, .width = 64, .height = 64});
    use_no_layer();
    assert_non_null(r);
    struct scene *scene = scene_open("town:triangles=20000", error, sizeof error);
    struct renderer_scene *uploaded = renderer_scene_create(r, scene);
    struct mode_choice choice;
    assert_true(mode_parse(mode, &choice, error, sizeof error));
    assert_null(renderer_option_create(r, uploaded, &choice, NULL));
    assert_int_equal(heard.sentences, 1);
    if (!strstr(heard.last, about))
        fail_msg("'%s' does not say '%s'", heard.last, about);
    assert_true(mode_parse("regular", &choice, error, sizeof error));
    struct renderer_option *regular = renderer_option_create(r, uploaded, &choice, NULL);
    assert_non_null(regular);
    renderer_option_destroy(regular);
    renderer_scene_destroy(uploaded);
    renderer_destroy(r);
    scene_destroy(scene);
}

static void a_device_without_64_bit_atomics(void **state)
{
    (void)state;
    refuses_alone("shaderInt64", "time_warped", "time_warped needs 64-bit atomics");
}

static void a_device_that_cannot_draw_both_eyes_at_once(void **state)
{
    (void)state;
    refuses_alone("multiview", "regular:eyes=multiview", "eyes=multiview needs multiview");
    refuses_alone("shaderOutputLayer", "regular:eyes=instanced", "eyes=instanced needs shaderOutputLayer");
}

static void no_driver_at_all(void **state)
{
    (void)state;
    setenv("VK_DRIVER_FILES", "/nonexistent/driver.json", 1);
    setenv("VK_ICD_FILENAMES", "/nonexistent/driver.json", 1);
    refused(&(struct renderer_desc){.width = 64, .height = 64}, "no Vulkan");
    unsetenv("VK_DRIVER_FILES");
    unsetenv("VK_ICD_FILENAMES");
}

int main(void)
{
    struct renderer *probe = renderer_create(&(struct renderer_desc){.width = 16, .height = 16});
    if (!probe)
        return 77;
    renderer_destroy(probe);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_device_of_another_name),
        cmocka_unit_test(sizes_out_of_range),
        cmocka_unit_test(a_device_without_what_every_mode_needs),
        cmocka_unit_test(a_device_without_64_bit_atomics),
        cmocka_unit_test(a_device_that_cannot_draw_both_eyes_at_once),
        cmocka_unit_test(no_driver_at_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
