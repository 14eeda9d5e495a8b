// How a stimulus is seen: field of view, eyes, eccentricity, gaze.
//
// Angles are degrees in the head's frame: x = atan2(x, -z), y = atan2(y, hypot(x, z)); right and up positive.
#ifndef STIMULI_VIEWING_H
#define STIMULI_VIEWING_H

#include "stimuli/geometry.h"

#include <stdbool.h>
#include <stdint.h>

enum { EYE_LEFT, EYE_RIGHT, EYES };

#define VIEWING_DEFAULT_FOV_DEG 100.0 // vertical, per eye (DESIGN section 3)
#define VIEWING_DEFAULT_IPD_M 0.063   // mean adult interpupillary distance, Dodgson 2004 (SPIE 5291: 63 mm)
#define VIEWING_NEAR_M 0.05

// One eye's frustum by the tangents of its half angles, each positive away from the axis.
struct viewing_fov {
    double tan_left, tan_right, tan_down, tan_up;
};

// Symmetric with square pixels; NaN for a field of view outside (0, 180) or a zero size.
struct viewing_fov viewing_symmetric_fov(double vertical_deg, uint32_t width, uint32_t height);
bool viewing_fov_ok(const struct viewing_fov *fov);

// The eye `ipd` / 2 to the side of the head, looking as the head does.
struct pose viewing_eye_pose(const struct pose *head, int eye, double ipd_m);

struct dvec3 viewing_direction(double x_deg, double y_deg); // unit, head's frame
void viewing_angles(struct dvec3 direction, double *out_x_deg, double *out_y_deg);
// Where a direction falls in the image, pixels from the upper left corner; false behind the eye.
bool viewing_pixel(const struct viewing_fov *fov, uint32_t width, uint32_t height, struct dvec3 direction,
                   double *out_x, double *out_y);
// The direction of a point of the image (pixel centres are at +0.5).
struct dvec3 viewing_pixel_direction(const struct viewing_fov *fov, uint32_t width, uint32_t height, double x,
                                     double y);

// A ball's image: an ellipse, longer along the way from the image's axis.
struct viewing_disc {
    double x_px, y_px;         // its middle, from the upper left corner
    double unit_from_px[2][2]; // takes pixels from there to the unit disc, right and up positive
};
// False where the ball is not wholly in front of the eye.
bool viewing_disc(const struct viewing_fov *fov, uint32_t width, uint32_t height, struct dvec3 direction,
                  double radius_deg, struct viewing_disc *out);

enum gaze_eye { GAZE_LEFT, GAZE_RIGHT, GAZE_BOTH };

// One tracker sample. Angles as above; NaN where not valid. pupil_mm and confidence are NaN where not known.
struct gaze_sample {
    int64_t device_ns; // the tracker's own clock
    int64_t host_ns;   // ours, since the segment's origin, when it arrived
    enum gaze_eye eye;
    double x_deg, y_deg;
    double pupil_mm;
    double confidence; // 0..1
    bool valid;
};

#endif
