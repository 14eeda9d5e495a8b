// The table of modes and what the command line makes of it.
#include "renderer/mode.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static void defaults_are_the_paper_s(void **state)
{
    (void)state;
    struct mode_choice choice;
    char text[512];
    assert_true(mode_parse("time_warped", &choice, text, sizeof text));
    assert_true(mode_parameters_json(&choice, text, sizeof text));
    assert_string_equal(text, "{\"epsilon\":0.2,\"fovea_deg\":10,\"periphery_deg\":30,\"hole_decay\":0.6,"
                              "\"dynamic_decay\":0.75,\"dynamic_objects\":\"foveated\",\"splat\":\"atomic\"}");
    assert_true(mode_parse("vrs", &choice, text, sizeof text));
    assert_true(mode_parameters_json(&choice, text, sizeof text));
    assert_string_equal(text, "{\"inner_deg\":10,\"outer_deg\":20,\"path\":\"compute\"}");
    assert_true(mode_parse("regular", &choice, text, sizeof text));
    assert_true(mode_parameters_json(&choice, text, sizeof text));
    assert_string_equal(text, "{\"eyes\":\"separate\"}");
}

static void values_are_read(void **state)
{
    (void)state;
    struct mode_choice choice;
    char error[512];
    assert_true(mode_parse("time_warped:epsilon=0.05,fovea_deg=17", &choice, error, sizeof error));
    assert_true(choice.values[mode_parameter_index(choice.mode, "epsilon")] == 0.05);
    assert_true(choice.values[mode_parameter_index(choice.mode, "fovea_deg")] == 17);
    assert_true(choice.values[mode_parameter_index(choice.mode, "periphery_deg")] == 30);
}

static void bad_words_get_a_sentence(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        {"warped", "there is no mode 'warped'; there are: regular, time_warped, vrs"},
        {"", "there is no mode ''"},
        {"time_warped:eps=1", "has no parameter 'eps'; it has: epsilon, fovea_deg"},
        {"time_warped:epsilon=2", "goes from 0 to 1"},
        {"time_warped:fovea_deg=91", "goes from 0 to 90 deg"},
        {"time_warped:fovea_deg=30",
         "periphery_deg of mode 'time_warped' is 30; it must be more than fovea_deg, 30"},
        {"vrs:inner_deg=25", "outer_deg of mode 'vrs' is 20; it must be at least inner_deg, 25"},
        {"vrs:path=cpu", "path of mode 'vrs' is not 'cpu'"},
        {"time_warped:epsilon=", "is not a number: ''"},
        {"time_warped:epsilon=0.1x", "is not a number: '0.1x'"},
        {"time_warped:epsilon=nan", "is not a number"},
        {"time_warped:epsilon", "is not name=value"},
        {"regular:epsilon=1", "it has: eyes"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct mode_choice choice;
        char error[512] = "";
        assert_false(mode_parse(bad[i][0], &choice, error, sizeof error));
        if (!strstr(error, bad[i][1]))
            fail_msg("%s: '%s' lacks '%s'", bad[i][0], error, bad[i][1]);
    }
}

static void every_mode_is_described(void **state)
{
    (void)state;
    for (size_t i = 0; modes[i]; i++) {
        const struct mode *m = modes[i];
        assert_ptr_equal(mode_find(m->name), m);
        assert_true(m->description[0] && m->source[0] && m->create && m->record && m->destroy);
        assert_true(m->parameter_count <= MODE_PARAMETERS);
        for (uint32_t k = 0; k < m->parameter_count; k++) {
            const struct mode_parameter *q = &m->parameters[k];
            assert_int_equal(mode_parameter_index(m, q->name), (int)k);
            assert_true(q->min <= q->fallback && q->fallback <= q->max && q->description[0]);
        }
    }
    struct mode_choice choice;
    char small[8], error[64];
    assert_true(mode_parse("time_warped", &choice, error, sizeof error));
    assert_false(mode_parameters_json(&choice, small, sizeof small));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_the_paper_s),
        cmocka_unit_test(values_are_read),
        cmocka_unit_test(bad_words_get_a_sentence),
        cmocka_unit_test(every_mode_is_described),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
