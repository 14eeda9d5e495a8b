// The image measures of one mode, summed over frames and both eyes: PSNR, eccentricity-weighted PSNR, SSIM and
// FLIP, whole and by ring.
#ifndef APP_FOVBENCH_MEASURES_H
#define APP_FOVBENCH_MEASURES_H

#include "analysis/image/error.h"
#include "analysis/image/flip.h"
#include "analysis/image/ssim.h"
#include "app/fovbench/row.h"
#include "renderer/frame.h"

// What measuring needs besides pictures; one for each run, for one thread.
struct measures_tools {
    struct image_rings *rings[EYES]; // owned, as all
    struct image_ssim *ssim;
    struct image_flip *flip; // NULL: fewer pixels per degree than FLIP is defined for, or more
};

struct image_view measures_view(const struct frame_eye *eye);

bool measures_tools_init(struct measures_tools *tools, const struct frame_eye *eye, uint32_t width,
                         uint32_t height); // false: no memory
void measures_tools_finish(struct measures_tools *tools);
// The rings of a frame: before its pictures are compared.
bool measures_tools_look(struct measures_tools *tools, const struct frame *frame, uint32_t width,
                         uint32_t height);

struct measures { // zero is empty
    struct image_error_rings error;
    struct image_ring_sum ssim, flip;
};

// False: no memory, or pictures too small for a measure.
bool measures_add(struct measures *measures, struct measures_tools *tools, int eye,
                  const struct image_pixels *test, const struct image_pixels *truth);
struct row_error measures_result(const struct measures *measures, int region); // flicker stays NaN

#endif
