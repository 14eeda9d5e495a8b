// Packing is lossless; a recording is played as it was made, in any order, without waiting where that is
// wanted.
#include "app/session/pack.h"
#include "app/session/player.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { WIDTH = 37, HEIGHT = 23, PIXELS = WIDTH * HEIGHT, FRAMES = 40 };

// Smooth with noise in it, opaque; another one for each frame and eye.
static void paint(uint8_t *out, size_t pixels, uint32_t frame, uint32_t eye, uint32_t noise)
{
    uint32_t random = frame * 7919 + eye * 104729 + 1;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 4; c++) {
            random = random * 1664525u + 1013904223u;
            out[4 * i + c] = (uint8_t)(c == 3 ? 255 : i / 64 * (c + 1) + frame + (random >> 24) % noise);
        }
}

static void packing_is_lossless(void **state)
{
    (void)state;
    uint8_t in[4 * PIXELS], out[4 * PIXELS];
    uint8_t *scratch = malloc(pack_scratch(PIXELS)), *packed = malloc(pack_bound(PIXELS));
    assert_true(scratch && packed);
    static const uint32_t noise[] = {1, 2, 9, 256}; // the last does not get smaller
    for (size_t k = 0; k < 4; k++) {
        paint(in, PIXELS, 3, 0, noise[k]);
        size_t size = pack(in, PIXELS, scratch, packed, pack_bound(PIXELS));
        assert_true(size > 0);
        memset(out, 7, sizeof out);
        assert_true(unpack(packed, size, PIXELS, scratch, out));
        assert_memory_equal(in, out, sizeof in);
        assert_false(unpack(packed, size - 1, PIXELS, scratch, out));
        assert_false(unpack(packed, size, PIXELS + 1, scratch, out));
    }
    free(scratch);
    free(packed);
}

struct rig {
    struct recording *recording;
    struct player *player;
    uint8_t *buffers[PLAYER_BUFFERS];
};

static struct recording *record(uint32_t first)
{
    uint8_t left[4 * PIXELS], right[4 * PIXELS];
    struct recording *recording = recording_create(WIDTH, HEIGHT, FRAMES);
    assert_non_null(recording);
    for (uint32_t i = 0; i < FRAMES; i++) {
        const uint8_t *const rgba[EYES] = {left, right};
        paint(left, PIXELS, first + i, 0, 5);
        paint(right, PIXELS, first + i, 1, 5);
        assert_true(recording_add(recording, rgba, i, 2 * i));
    }
    const uint8_t *const rgba[EYES] = {left, right};
    assert_false(recording_add(recording, rgba, 0, 0));
    assert_true(recording_forecast(recording) <= recording->bytes &&
                recording_forecast(recording) + FRAMES > recording->bytes);
    return recording;
}

static void open_rig(struct rig *rig)
{
    for (int i = 0; i < PLAYER_BUFFERS; i++)
        assert_non_null(rig->buffers[i] = calloc(2, 4 * PIXELS));
    rig->recording = record(0);
    rig->player = player_create(rig->buffers, WIDTH, HEIGHT);
    assert_non_null(rig->player);
}

static void close_rig(struct rig *rig)
{
    player_destroy(rig->player);
    recording_destroy(rig->recording);
    for (int i = 0; i < PLAYER_BUFFERS; i++)
        free(rig->buffers[i]);
}

static void expect(const struct rig *rig, int buffer, uint32_t frame)
{
    uint8_t wanted[4 * PIXELS];
    assert_in_range(buffer, 0, PLAYER_BUFFERS - 1);
    for (uint32_t eye = 0; eye < EYES; eye++) {
        paint(wanted, PIXELS, frame, eye, 5);
        assert_memory_equal(rig->buffers[buffer] + eye * sizeof wanted, wanted, sizeof wanted);
    }
}

static void frames_come_in_any_order(void **state)
{
    (void)state;
    struct rig rig;
    open_rig(&rig);
    assert_int_equal(player_take(rig.player, 0, true), -1); // nothing is loaded
    player_load(rig.player, rig.recording);
    for (int round = 0; round < 20; round++)
        for (uint32_t i = 0; i < FRAMES; i++)
            expect(&rig, player_take(rig.player, i, true), i);
    static const uint32_t jumps[] = {0, 0, 7, 8, 8, 39, 12, 11, 30, 1, 39, 39, 0};
    for (size_t i = 0; i < sizeof jumps / sizeof jumps[0]; i++)
        expect(&rig, player_take(rig.player, jumps[i], true), jumps[i]);
    assert_int_equal(player_take(rig.player, FRAMES, true), -1);
    player_load(rig.player, NULL);
    assert_int_equal(player_take(rig.player, 0, true), -1);
    struct recording *other = record(500);
    player_load(rig.player, other);
    expect(&rig, player_take(rig.player, 5, true), 505);
    player_load(rig.player, rig.recording);
    recording_destroy(other); // nobody reads it any more
    expect(&rig, player_take(rig.player, 5, true), 5);
    close_rig(&rig);
}

// Taking never waits; what it gives is the right picture, and at the screen's pace nothing is missed.
static void nothing_waits_at_the_pace_of_a_screen(void **state)
{
    (void)state;
    struct rig rig;
    uint32_t there = 0;
    open_rig(&rig);
    player_load(rig.player, rig.recording);
    expect(&rig, player_take(rig.player, 0, true), 0);
    for (uint32_t i = 1; i < FRAMES; i++) {
        nanosleep(&(struct timespec){.tv_nsec = 11111111}, NULL);
        int buffer = player_take(rig.player, i, false);
        if (buffer >= 0)
            expect(&rig, buffer, i);
        there += buffer >= 0;
    }
    print_message("%u of %d frames were there in time\n", there, FRAMES - 1);
    assert_true(there > FRAMES / 2);           // a machine under load may miss some
    for (uint32_t i = 0; i < FRAMES; i += 3) { // as fast as can be, which is too fast
        int buffer = player_take(rig.player, i, false);
        if (buffer >= 0)
            expect(&rig, buffer, i);
    }
    close_rig(&rig);
}

static void a_damaged_recording_ends_in_no_picture(void **state)
{
    (void)state;
    struct rig rig;
    open_rig(&rig);
    rig.recording->frames[3].size[EYE_RIGHT] /= 2;
    player_load(rig.player, rig.recording);
    assert_int_equal(player_take(rig.player, 3, true), -1);
    assert_int_equal(player_take(rig.player, 30, false), -1);
    close_rig(&rig);
}

static double thread_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

// How long one eye takes at the sizes of a headset: for reading, since machines differ.
static void unpacking_is_timed(void **state)
{
    (void)state;
    static const size_t sizes[][2] = {{640, 720}, {1280, 1440}};
    for (size_t k = 0; k < 2; k++) {
        size_t pixels = sizes[k][0] * sizes[k][1];
        uint8_t *in = malloc(4 * pixels), *scratch = malloc(pack_scratch(pixels)),
                *packed = malloc(pack_bound(pixels));
        assert_true(in && scratch && packed);
        paint(in, pixels, 1, 0, 4);
        size_t size = pack(in, pixels, scratch, packed, pack_bound(pixels));
        double best = 1e9;
        for (int i = 0; i < 5; i++) {
            double start = thread_ms();
            assert_true(unpack(packed, size, pixels, scratch, in));
            best = thread_ms() - start < best ? thread_ms() - start : best;
        }
        print_message("%zux%zu: ratio %.2f, %.2f ms of processor time an eye\n", sizes[k][0], sizes[k][1],
                      4.0 * (double)pixels / (double)size, best);
        free(in);
        free(scratch);
        free(packed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packing_is_lossless),
        cmocka_unit_test(frames_come_in_any_order),
        cmocka_unit_test(nothing_waits_at_the_pace_of_a_screen),
        cmocka_unit_test(a_damaged_recording_ends_in_no_picture),
        cmocka_unit_test(unpacking_is_timed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
