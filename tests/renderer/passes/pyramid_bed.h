// An image with holes and what a test of the pyramid does with it: paint it, fill it, judge it by the
// reference.
#ifndef TESTS_RENDERER_PASSES_PYRAMID_BED_H
#define TESTS_RENDERER_PASSES_PYRAMID_BED_H

#include "renderer/passes/pyramid/pyramid.h"
#include "tests/renderer/passes/fill_reference.h"

// half floats hold values near 1 to 2^-11; they are rounded, or cut, once every three levels
static const double level_error = 1.5e-3;

struct bed {
    struct rig rig;
    struct rig_view view;
    uint32_t width, height;
    size_t count; // pixels of both eyes
    struct gpu_image colour[2], position[2], redraw_map;
    float (*positions)[4], (*after)[4];
    uint8_t *forced; // what the map holds before, where the pass reads it
    bool turns;      // moving pixels may be redrawn before their confidence asks for it
    uint32_t turn;
    uint8_t (*colours)[4]; // before
    uint8_t (*result)[4];  // after
    uint8_t *map;
};

struct verdict {
    uint32_t redrawn, kept_holes, undecided, wrong_decisions, wrong_colours, wrong_positions;
    double worst_colour; // of 255
};

void bed_open(struct bed *b, uint32_t width, uint32_t height);
void bed_close(struct bed *b);
struct pyramid bed_make(struct bed *b, const struct fill_parameters *q, bool forced);
// epsilon 0 gives all levels; the thresholds may change afterwards.
struct pyramid bed_make_unlimited(struct bed *b);
void bed_use(struct pyramid *pass, const struct fill_parameters *q);
// `before`: the redraw map's contents; NULL: nothing that could be read as a map.
void bed_run(struct bed *b, const struct pyramid *pass, uint32_t target, const uint8_t *before);
struct verdict bed_judge(const struct bed *b, const struct fill_parameters *q);

enum holes { NO_HOLES, SPECKLED, SPARSE, BLOCKS, ALL_HOLES, ONE_PIXEL, HOLES };

void bed_paint(struct bed *b, enum holes holes, uint64_t seed);
void bed_look(struct bed *b, double x_deg, double y_deg);
static const struct fill_parameters paper = {0.2, 10, 30, 0.6, 0.75};

void bed_draw_parameters(struct bed *b, struct fill_parameters *q, uint64_t seed);

#endif
