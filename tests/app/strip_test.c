// `fovstudy strip`: one PNG that holds what `fovstudy render` draws, each picture under its label. Exit 77
// where no device can draw.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// The library is one header; its code does not meet our warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

enum { WIDTH = 64, HEIGHT = 48 };
#define WALK "--scene town:triangles=20000 --size 64x48 --frames 4 --gaze script --ssao "

static char folder[512];

struct picture {
    int width, height;
    uint8_t *rgb;
};

static struct picture load(const char *name)
{
    char path[640];
    struct picture p;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    p.rgb = stbi_load(path, &p.width, &p.height, &(int){0}, 3);
    if (!p.rgb)
        fail_msg("%s: %s", path, stbi_failure_reason());
    return p;
}

static bool is_at(const struct picture *sheet, const struct picture *p, int x, int y)
{
    for (int line = 0; line < p->height; line++)
        if (memcmp(sheet->rgb + 3 * ((y + line) * sheet->width + x), p->rgb + 3 * line * p->width,
                   3 * (size_t)p->width) != 0)
            return false;
    return true;
}

// Where a picture that `render` wrote stands in the sheet; fails the test where it is not in it.
static void find(const struct picture *sheet, const char *name, int *out_x, int *out_y)
{
    struct picture p = load(name);
    for (int i = 0; i < sheet->width * sheet->height; i++) {
        *out_x = i % sheet->width;
        *out_y = i / sheet->width;
        if (*out_x + p.width <= sheet->width && *out_y + p.height <= sheet->height &&
            is_at(sheet, &p, *out_x, *out_y)) {
            stbi_image_free(p.rgb);
            return;
        }
    }
    fail_msg("%s is not in the strip", name);
}

// Pixels of ink in the line above a place.
static int ink_above(const struct picture *sheet, int x, int y)
{
    int ink = 0;
    for (int line = y - 16; line < y - 1; line++)
        for (int i = x; i < x + WIDTH; i++)
            ink += sheet->rgb[3 * (line * sheet->width + i)] > 128;
    return ink;
}

static void a_strip_holds_what_render_draws(void **state)
{
    (void)state;
    int x[4], y[4];
    const struct command_result *result =
        command("fovstudy strip --modes regular time_warped vrs " WALK "--out '%s/new/strip.png'", folder);
    assert_string_equal(result->err, "");
    assert_int_equal(result->status, 0);
    result = command("fovstudy render --mode time_warped --against regular --redraw-map " WALK
                     "--out '%s/warped' && "
                     "fovstudy render --mode vrs " WALK "--out '%s/vrs'",
                     folder, folder);
    assert_int_equal(result->status, 0);
    const struct picture sheet = load("new/strip.png");
    find(&sheet, "warped/0003-left-against.png", &x[0], &y[0]);
    find(&sheet, "warped/0003-left-difference.png", &x[2], &y[2]);
    find(&sheet, "warped/0003-left-redraw.png", &x[3], &y[3]);
    find(&sheet, "vrs/0003-left.png", &x[1], &y[1]);
    // pictures below each other, what belongs to one beside it
    assert_true(x[1] == x[0] && y[1] - y[0] >= 2 * HEIGHT);
    assert_true(x[2] >= x[0] + WIDTH && x[3] - x[2] == x[2] - x[0] && y[2] == y[3]);
    assert_true(2 * y[2] == y[0] + y[1]);
    for (int i = 0; i < 4; i++)
        assert_true(ink_above(&sheet, x[i], y[i]) > 20);
    stbi_image_free(sheet.rgb);
}

static void what_cannot_be_done_is_said(void **state)
{
    (void)state;
    const struct command_result *result =
        command("fovstudy strip --modes regular --scene nowhere.gltf --out '%s/x.png'", folder);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "nowhere.gltf"));
    result = command("fovstudy strip --modes regular " WALK "--out '%s/new/strip.png/x.png'", folder);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "strip.png"));
}

static int set_up(void **state)
{
    (void)state;
    command_folder("strip", folder, sizeof folder);
    return 0;
}

int main(void)
{
    if (command("fovstudy devices")->status != 0)
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_strip_holds_what_render_draws),
        cmocka_unit_test(what_cannot_be_done_is_said),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
