// What a scene's specification may say, and what a wrong one is answered.
#include "stimuli/builtin/builtin.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void refused(const char *spec, const char *first, const char *second)
{
    char error[512] = "";
    struct scene *scene = builtin_scene_open(spec, error, sizeof error);
    if (scene != NULL)
        fail_msg("'%s' was taken", spec);
    char checked[512] = "";
    static struct camera_path path;
    assert_false(builtin_scene_check(spec, &path, checked, sizeof checked)); // for the same reason
    assert_string_equal(checked, error);
    if (strstr(error, first) == NULL || strstr(error, second) == NULL || strchr(error, '\n') != NULL)
        fail_msg("'%s' gave: %s", spec, error);
}

static void wrong_values_name_the_range(void **state)
{
    (void)state;
    refused("town:triangles=-5", "triangles=-5", "20000 to 8000000");
    refused("town:triangles=19999", "triangles=19999", "20000 to 8000000");
    refused("town:triangles=8000001", "8000001", "20000 to 8000000");
    refused("town:triangles=", "triangles=", "20000 to 8000000");
    refused("town:triangles=1e5", "1e5", "20000 to 8000000");
    refused("town:triangles=nan", "nan", "20000 to 8000000");
    refused("town:triangles=99999999999999999999999999999999999999", "9999", "20000 to 8000000");
    refused("town:seed=4294967296", "seed", "0 to 4294967295");
    refused("town:moving=101", "moving=101", "0 to 100");
    refused("town:triangles=50000,seed=x", "seed=x", "4294967295");
}

static void wrong_names_name_the_valid_ones(void **state)
{
    (void)state;
    refused("town:foo=1", "foo=1", "triangles, seed, moving");
    refused("town:foo", "foo", "triangles, seed, moving");
    refused("town:", "town", "triangles, seed, moving");
    refused("town:seed=1,", "town", "triangles, seed, moving");
    refused("town:=5", "=5", "triangles, seed, moving");
    refused("atrium:x", "'x'", "no parameters");
    refused("atrium:", "atrium", "no parameters");
    refused("nosuch", "nosuch", "atrium, town");
    refused("nosuch:a=1", "nosuch", "atrium, town");
    refused("", "''", "atrium, town");
    refused("towns", "towns", "atrium, town");
}

static void small_error_buffers_are_kept(void **state)
{
    (void)state;
    char error[8] = "1234567";
    assert_null(builtin_scene_open("nosuch", error, 4));
    assert_int_equal(strlen(error), 3);
    assert_int_equal(error[4], '5');
}

static void table_holds_what_is_known(void **state)
{
    (void)state;
    for (const struct builtin_scene *s = builtin_scenes; s->name != NULL; s++) {
        assert_true(builtin_scene_known(s->name));
        assert_true(strlen(s->description) > 0);
        for (const struct builtin_parameter *p = s->parameters; p->name != NULL; p++)
            assert_true(p->min <= p->value && p->value <= p->max);
    }
    assert_true(builtin_scene_known("town:seed=3"));
    assert_false(builtin_scene_known("nosuch"));
    assert_false(builtin_scene_known(""));
}

// The path is known without making the scene.
static void check_knows_the_path(void **state)
{
    (void)state;
    static const char *const specs[] = {"atrium", "town:triangles=20000,seed=3"};
    static struct camera_path path;
    char error[512] = "";
    for (int i = 0; i < 2; i++) {
        assert_true(builtin_scene_check(specs[i], &path, error, sizeof error));
        struct scene *scene = builtin_scene_open(specs[i], error, sizeof error);
        assert_non_null(scene);
        assert_true(path.duration_s > 10 && path.duration_s == scene->path.duration_s);
        assert_int_equal(path.knot_count, scene->path.knot_count);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_knows_the_path),
        cmocka_unit_test(wrong_values_name_the_range),
        cmocka_unit_test(wrong_names_name_the_valid_ones),
        cmocka_unit_test(small_error_buffers_are_kept),
        cmocka_unit_test(table_holds_what_is_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
