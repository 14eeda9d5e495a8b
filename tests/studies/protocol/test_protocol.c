// What the studies' own files say arrives in the struct, and settings cascade.
#include "studies/protocol/protocol.h"
#include "tests/studies/protocol/sample_catalogue.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct protocol *load(const char *name)
{
    char path[512], error[PROTOCOL_ERROR] = "";
    snprintf(path, sizeof path, "%s/studies/protocols/%s", SOURCE_DIR, name);
    struct protocol *protocol = protocol_load(path, sample_catalogue(), error, sizeof error);
    assert_string_equal(error, "");
    assert_non_null(protocol);
    return protocol;
}

static void test_calibration_is_the_papers(void **state)
{
    (void)state;
    struct protocol *p = load("calibration.yaml");
    assert_string_equal(p->name, "calibration");
    assert_int_equal(p->seed, 20210802);
    assert_int_equal(p->scene_count, 2);
    assert_string_equal(p->scenes[1], "town");
    assert_int_equal(p->block_count, 3);
    assert_string_equal(p->options[p->reference].name, "regular");

    const struct protocol_block *block = &p->blocks[1];
    assert_int_equal(block->kind, PROTOCOL_TOGGLE);
    assert_int_equal(protocol_block_trials(block), 9);
    assert_int_equal(block->factor_count, 2);
    static const char *const levels[2][3] = {{"0.2", "0.1", "0.05"}, {"17", "10", "6"}};
    for (uint32_t f = 0; f < 2; f++) {
        assert_int_equal(block->factors[f].level_count, 3);
        for (uint32_t i = 0; i < 3; i++)
            assert_string_equal(block->factors[f].level[i], levels[f][i]);
    }
    assert_true(block->cells[5].option[0].values[0] == 0.1 && block->cells[5].option[0].values[1] == 6);
    assert_int_equal(block->settings.fade_to_gray_ns + block->settings.fade_gray_ns +
                         block->settings.fade_from_gray_ns,
                     500000000);
    assert_true(block->settings.render[0] == 0);
    const struct protocol_option *tested = &p->options[block->options[0]];
    assert_true(tested->values[2] == 30);  // periphery_deg
    assert_true(tested->values[3] == 0.6); // the mode's default

    assert_int_equal(p->blocks[0].kind, PROTOCOL_RATE);
    assert_true(tested->values[0] == 0.1 && tested->values[1] == 10); // what the ratings show
    assert_int_equal(p->blocks[2].complement_of, 0);
    const struct protocol_question *question = &p->questions[p->blocks[2].settings.asked[0]];
    assert_true(question->scale_min == 1 && question->scale_max == 10);
    assert_string_equal(question->label_max, "very good");
    assert_string_equal(p->consent_version, "1");
    assert_int_equal(p->attribute_count, 3);
    assert_int_equal(p->analysis_count, 4);
    assert_string_equal(p->analyses[0].method, "binomial");
    protocol_destroy(p);
}

static void test_the_text_and_its_hash_are_kept(void **state)
{
    (void)state;
    struct protocol *p = load("short.yaml");
    assert_int_equal(protocol_block_trials(&p->blocks[0]), 2);
    assert_int_equal(protocol_block_trials(&p->blocks[1]), 1);
    uint8_t digest[SHA256_BYTES];
    assert_int_equal(strlen(p->text), p->text_size);
    sha256(p->text, p->text_size, digest);
    assert_memory_equal(digest, p->sha256, sizeof digest);
    protocol_destroy(p);
}

static const char cascade[] = "fovstudy: 1\nname: c\ntitle: t\nseed: 0\nscenes: [atrium, town]\n"
                              "options: {f: {mode: time_warped}, r: {mode: regular}}\nreference: r\n"
                              "questions: {q: {text: Which?}, z: {text: What?}}\ninstructions: i\n"
                              "consent: {version: 1, text: c}\n"
                              "settings: {question: q, moving_objects: on, confirm_s: 2, fade: {gray_s: 1}}\n"
                              "blocks:\n"
                              "- name: b\n  kind: toggle\n  options: [f, r]\n"
                              "  settings: {camera: still, fade: {to_gray_s: 0.5}}\n"
                              "  trials:\n"
                              "  - {name: one, scene: town, parameters: {f: {epsilon: 0.3, splat: points}}}\n"
                              "  - {settings: {moving_objects: off, question: z, fade: {gray_s: 2}}}\n";

static void test_settings_cascade(void **state)
{
    (void)state;
    char error[PROTOCOL_ERROR] = "";
    struct protocol *p = protocol_parse("c", cascade, strlen(cascade), sample_catalogue(), error, sizeof error);
    assert_string_equal(error, "");
    const struct protocol_block *block = &p->blocks[0];
    assert_int_equal(protocol_block_trials(block), 2);
    const struct protocol_cell *one = &block->cells[0], *two = &block->cells[1];
    assert_string_equal(one->labels, ",\"trial\":\"one\"");
    assert_int_equal(one->scene, 1);
    assert_int_equal(two->scene, -1);
    assert_true(one->option[0].values[0] == 0.3 && one->option[0].values[5] == 1 &&
                two->option[0].values[0] == 0.2);
    assert_int_equal(one->settings.camera, PROTOCOL_CAMERA_STILL);
    assert_int_equal(one->settings.confirm_ns, 2000000000);
    assert_int_equal(one->settings.fade_to_gray_ns, 500000000);
    assert_int_equal(one->settings.fade_gray_ns, 1000000000);
    assert_int_equal(two->settings.fade_gray_ns, 2000000000);
    assert_int_equal(two->settings.fade_to_gray_ns, 500000000);
    assert_true(one->settings.render[0] == 1 && two->settings.render[0] == 0);
    assert_int_equal(one->settings.asked[0], 0);
    assert_int_equal(two->settings.asked[0], 1);

    char json[1024];
    assert_true(protocol_option_json(p, &one->option[0], json, sizeof json));
    assert_string_equal(json, "{\"epsilon\":0.3,\"fovea_deg\":10,\"periphery_deg\":30,\"hole_decay\":0.6,"
                              "\"dynamic_objects\":\"foveated\",\"splat\":\"points\"}");
    assert_true(protocol_option_json(p, &one->option[1], json, sizeof json));
    assert_string_equal(json, "{}");
    assert_true(protocol_settings_json(p, block->kind, &two->settings, "", json, sizeof json));
    assert_string_equal(
        json, "{\"procedure\":\"toggle\",\"camera\":\"still\",\"foveate\":\"gaze\",\"moving_objects\":\"off\","
              "\"fade_s\":[0.5,2,0.125]}");
    assert_false(protocol_option_json(p, &one->option[0], json, 20));
    protocol_destroy(p);
}

static void test_attributes(void **state)
{
    (void)state;
    struct protocol *p = load("calibration.yaml");
    const struct protocol_attribute *age = protocol_attribute_find(p, "age");
    const struct protocol_attribute *gender = protocol_attribute_find(p, "gender");
    assert_non_null(age);
    assert_non_null(gender);
    assert_null(protocol_attribute_find(p, "name"));
    char json[64], error[256];
    assert_true(protocol_attribute_json(age, "27", json, sizeof json, error, sizeof error));
    assert_string_equal(json, "27");
    assert_true(protocol_attribute_json(gender, "diverse", json, sizeof json, error, sizeof error));
    assert_string_equal(json, "\"diverse\"");
    assert_false(protocol_attribute_json(age, "27.5", json, sizeof json, error, sizeof error));
    assert_string_equal(error, "age is a whole number, not '27.5'");
    assert_false(protocol_attribute_json(age, "17", json, sizeof json, error, sizeof error));
    assert_string_equal(error, "age is 17; it must lie between 18 and 99");
    assert_false(protocol_attribute_json(age, "", json, sizeof json, error, sizeof error));
    assert_false(protocol_attribute_json(gender, "x", json, sizeof json, error, sizeof error));
    assert_string_equal(error, "gender is 'x'; give female, male, diverse, undisclosed");
    protocol_destroy(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_calibration_is_the_papers),
        cmocka_unit_test(test_the_text_and_its_hash_are_kept),
        cmocka_unit_test(test_settings_cascade),
        cmocka_unit_test(test_attributes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
