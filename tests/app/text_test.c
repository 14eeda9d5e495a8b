// The participant's screens: they fit, in both eyes, at every size, and are large enough to read.
#include "app/display/font.h"
#include "app/display/text.h"
#include "app/display/text_layout.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct text_screen question = {
    .title = "3 of 9",
    .body = "How good does the scene look?",
    .hint = "Enter: confirm",
    .scale_min = 1,
    .scale_max = 10,
    .scale_selected = 7,
    .scale_low = "very bad",
    .scale_high = "very good",
};

static struct text_view view_of(uint32_t width, uint32_t height)
{
    struct text_view view;
    struct viewing_fov fov = viewing_symmetric_fov(100.0, width, height);
    text_view_init(&view, &fov, width, height, 0.063);
    return view;
}

// Rightmost and lowest light pixel must leave the panel's rim dark: nothing is cut off.
static bool rim_is_dark(const struct text_image *image)
{
    for (uint32_t y = 0; y < image->height; y++)
        for (uint32_t x = 0; x < image->width; x++) {
            bool rim = x == 0 || y == 0 || x == image->width - 1 || y == image->height - 1;
            if (rim && image->rgba[4 * ((size_t)y * image->width + x)] > 40)
                return false;
        }
    return true;
}

static size_t light_pixels(const struct text_image *image)
{
    size_t count = 0;
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        count += image->rgba[4 * i] > 150;
    return count;
}

static void screens_fit_both_eyes_at_every_size(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{96, 96},   {128, 144},   {160, 180},  {320, 360},
                                        {640, 720}, {1440, 1600}, {2160, 1200}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct text_view view = view_of(sizes[i][0], sizes[i][1]);
        struct text_image image;
        assert_true(text_draw(&view, &question, 0, &image));
        for (int eye = 0; eye < EYES; eye++) {
            assert_true(image.left[eye] >= 0 && image.top[eye] >= 0);
            assert_true(image.left[eye] + (int32_t)image.width <= (int32_t)sizes[i][0]);
            assert_true(image.top[eye] + (int32_t)image.height <= (int32_t)sizes[i][1]);
        }
        assert_true(rim_is_dark(&image));
        assert_true(light_pixels(&image) > 100);
        text_image_finish(&image);
    }
}

// Where the panel's middle lies in each eye is where a point two metres ahead of the head lies.
static void both_eyes_meet_two_metres_ahead(void **state)
{
    (void)state;
    struct text_view view = view_of(1440, 1600);
    struct text_image image;
    assert_true(text_draw(&view, &question, 0, &image));
    double per_tan = 800.0 / tan(50.0 * 3.14159265358979323846 / 180.0);
    for (int eye = 0; eye < EYES; eye++) {
        double side = eye == EYE_LEFT ? 1.0 : -1.0;
        double expected = 720.0 + side * per_tan * 0.0315 / 2.0;
        assert_true(fabs(image.left[eye] + image.width / 2.0 - expected) <= 0.5 + 1e-9);
        assert_true(fabs(image.top[eye] + image.height / 2.0 - 800.0) <= 0.5 + 1e-9);
    }
    text_image_finish(&image);
}

static void letters_are_large_enough(void **state)
{
    (void)state;
    const double degree = 3.14159265358979323846 / 180.0;
    struct text_view view = view_of(1440, 1600);
    struct text_image image;
    assert_true(text_draw(&view, &question, 0, &image));
    double cap_deg = atan(image.cap_px * tan(50.0 * degree) / 800.0) / degree;
    assert_true(cap_deg >= 1.2);
    text_image_finish(&image);
    view = view_of(320, 360); // five pixels per two degrees: the pixel floor holds
    assert_true(text_draw(&view, &question, 0, &image));
    assert_true(image.cap_px >= 10.0);
    text_image_finish(&image);
}

// The cap height asked for is the height of an H as drawn.
static void the_font_has_the_size_asked_for(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    uint8_t pixels[SIDE * SIDE] = {0};
    struct font_canvas canvas = {pixels, SIDE, SIDE};
    struct font *font = font_create(30.0);
    assert_non_null(font);
    font_draw(font, "H", 1, 5.0, 50.0, &canvas);
    int top = SIDE, bottom = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (pixels[y * SIDE + x] > 127) {
                top = y < top ? y : top;
                bottom = y > bottom ? y : bottom;
            }
    assert_in_range(bottom - top + 1, 29, 31);
    assert_true(font_width_px(font, "HH", 2) > 1.8 * font_width_px(font, "H", 1));
    font_destroy(font);
}

static void long_texts_become_pages_that_lose_nothing(void **state)
{
    (void)state;
    static char text[8000];
    text[0] = '\0';
    for (int i = 0; i < 90; i++)
        strcat(text, "This sentence stands in a long consent form and takes more than one line of it. ");
    struct text_view view = view_of(640, 720);
    struct text_screen screen = {.title = "Consent", .body = text, .hint = "Y: yes", .more = "read on"};
    struct text_image image;
    assert_true(text_draw(&view, &screen, 0, &image));
    uint32_t pages = image.pages;
    assert_in_range(pages, 2, 12);
    text_image_finish(&image);
    for (uint32_t page = 0; page < pages; page++) {
        assert_true(text_draw(&view, &screen, page, &image));
        assert_int_equal(image.page, page);
        assert_true(rim_is_dark(&image) && image.height <= 720 && light_pixels(&image) > 50);
        text_image_finish(&image);
    }
    assert_true(text_draw(&view, &screen, 1000, &image));
    assert_int_equal(image.page, pages - 1);
    text_image_finish(&image);
}

static void the_marked_number_stands_out(void **state)
{
    (void)state;
    struct text_view view = view_of(640, 720);
    struct text_screen none = question;
    struct text_image marked, plain;
    none.scale_selected = 0;
    assert_true(text_draw(&view, &question, 0, &marked));
    assert_true(text_draw(&view, &none, 0, &plain));
    size_t yellow[2] = {0, 0};
    const struct text_image *images[] = {&marked, &plain};
    for (int i = 0; i < 2; i++)
        for (size_t p = 0; p < (size_t)images[i]->width * images[i]->height; p++)
            yellow[i] += images[i]->rgba[4 * p] > 200 && images[i]->rgba[4 * p + 2] < 120;
    assert_true(yellow[0] > 100);
    assert_int_equal(yellow[1], 0);
    text_image_finish(&marked);
    text_image_finish(&plain);
}

// However many numbers a scale has, on every size of eye: in lines, apart, and inside the panel.
static void numbers_of_a_scale_stay_apart(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1280, 1440}, {640, 720}, {320, 360}};
    static const int ends[][2] = {{-3, 3}, {1, 10}, {0, 20}, {-10, 10}, {0, 60}};
    for (size_t s = 0; s < 3; s++) {
        for (size_t e = 0; e < 5; e++) {
            struct text_view view = view_of(sizes[s][0], sizes[s][1]);
            struct text_screen screen = {.body = "How many?", .scale_min = ends[e][0], .scale_max = ends[e][1]};
            struct text_layout layout;
            assert_true(text_layout_init(&layout, &view, &screen));
            double space = font_width_px(layout.fonts[TEXT_BODY], "0", 1);
            size_t numbers = 0;
            for (size_t i = 0; i < layout.run_count; i++) {
                const struct text_run *run = &layout.runs[i];
                if (run->text < layout.numbers[0] || run->text > layout.numbers[63])
                    continue;
                numbers++;
                assert_true(run->x >= 0 && run->x + run->width <= layout.width);
                for (size_t k = 0; k < i; k++) {
                    const struct text_run *other = &layout.runs[k];
                    if (other->page == run->page && fabs(other->top - run->top) < 1)
                        assert_true(run->x >= other->x + other->width + space);
                }
            }
            assert_int_equal(numbers, ends[e][1] - ends[e][0] + 1);
            text_layout_finish(&layout);
        }
    }
}

static void odd_text_is_drawn_without_harm(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",
        "\n\n\n",
        "\xff\xfe broken \xe2\x82",
        "Averyveryveryveryveryveryveryveryveryveryveryveryveryveryverylongwordwithoutanyspace",
        "\xc3\xbc\xe2\x82\xac\xf0\x9f\x98\x80",
        "   "};
    struct text_view view = view_of(128, 144);
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct text_screen screen = {.title = texts[i], .body = texts[i], .hint = texts[i]};
        struct text_image image;
        assert_true(text_draw(&view, &screen, 0, &image));
        assert_true(image.width <= 128);
        text_image_finish(&image);
    }
    struct text_view broken = view_of(8, 8);
    struct text_image image;
    assert_false(text_draw(&broken, &question, 0, &image));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(screens_fit_both_eyes_at_every_size),
        cmocka_unit_test(both_eyes_meet_two_metres_ahead),
        cmocka_unit_test(letters_are_large_enough),
        cmocka_unit_test(the_font_has_the_size_asked_for),
        cmocka_unit_test(long_texts_become_pages_that_lose_nothing),
        cmocka_unit_test(the_marked_number_stands_out),
        cmocka_unit_test(numbers_of_a_scale_stay_apart),
        cmocka_unit_test(odd_text_is_drawn_without_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
