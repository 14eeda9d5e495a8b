#include "stimuli/viewing.h"

#include <math.h>

static const double rad_per_deg = 0.017453292519943295769;

struct viewing_fov viewing_symmetric_fov(double vertical_deg, uint32_t width, uint32_t height)
{
    double tan_up = vertical_deg > 0 && vertical_deg < 180 && width && height
                        ? tan(vertical_deg / 2 * rad_per_deg)
                        : (double)NAN;
    double tan_right = tan_up * width / height;
    return (struct viewing_fov){tan_right, tan_right, tan_up, tan_up};
}

bool viewing_fov_ok(const struct viewing_fov *fov)
{
    return isfinite(fov->tan_left) && isfinite(fov->tan_right) && isfinite(fov->tan_down) &&
           isfinite(fov->tan_up) && fov->tan_left + fov->tan_right > 0 && fov->tan_down + fov->tan_up > 0;
}

struct pose viewing_eye_pose(const struct pose *head, int eye, double ipd_m)
{
    struct dvec3 side = {eye == EYE_LEFT ? -ipd_m / 2 : ipd_m / 2, 0, 0};
    return (struct pose){dvec3_add(head->position, dquat_rotate(head->orientation, side)), head->orientation};
}

struct dvec3 viewing_direction(double x_deg, double y_deg)
{
    double x = x_deg * rad_per_deg, y = y_deg * rad_per_deg;
    return (struct dvec3){sin(x) * cos(y), sin(y), -cos(x) * cos(y)};
}

void viewing_angles(struct dvec3 d, double *out_x_deg, double *out_y_deg)
{
    *out_x_deg = atan2(d.x, -d.z) / rad_per_deg;
    *out_y_deg = atan2(d.y, hypot(d.x, d.z)) / rad_per_deg;
}

bool viewing_pixel(const struct viewing_fov *fov, uint32_t width, uint32_t height, struct dvec3 d,
                   double *out_x, double *out_y)
{
    if (!(d.z < 0))
        return false;
    *out_x = (d.x / -d.z + fov->tan_left) / (fov->tan_left + fov->tan_right) * width;
    *out_y = (fov->tan_up - d.y / -d.z) / (fov->tan_down + fov->tan_up) * height;
    return true;
}

struct dvec3 viewing_pixel_direction(const struct viewing_fov *fov, uint32_t width, uint32_t height, double x,
                                     double y)
{
    struct dvec3 d = {x / width * (fov->tan_left + fov->tan_right) - fov->tan_left,
                      fov->tan_up - y / height * (fov->tan_down + fov->tan_up), -1};
    return dvec3_normalise(d);
}

// A cone of half angle r around a direction t from the axis cuts the plane at distance 1 in an ellipse from
// tan(t - r) to tan(t + r); its other half axis is sin r / sqrt(cos^2 t - sin^2 r).
bool viewing_disc(const struct viewing_fov *fov, uint32_t width, uint32_t height, struct dvec3 d,
                  double radius_deg, struct viewing_disc *out)
{
    const double side = hypot(d.x, d.y), t = atan2(side, -d.z), r = radius_deg * rad_per_deg;
    if (!(r > 0) || !(t + r < 85 * rad_per_deg))
        return false;
    const double near = tan(t - r), far = tan(t + r), middle = (near + far) / 2, along = (far - near) / 2;
    const double across = sin(r) / sqrt(cos(t) * cos(t) - sin(r) * sin(r));
    const double ex = side > 0 ? d.x / side : 1, ey = side > 0 ? d.y / side : 0;
    const double px = (fov->tan_left + fov->tan_right) / width, py = (fov->tan_down + fov->tan_up) / height;
    const double mixed = ex * ey * (1 / along - 1 / across);
    *out = (struct viewing_disc){
        .x_px = (middle * ex + fov->tan_left) / px,
        .y_px = (fov->tan_up - middle * ey) / py,
        .unit_from_px = {{(ex * ex / along + ey * ey / across) * px, -mixed * py},
                         {mixed * px, -(ey * ey / along + ex * ex / across) * py}},
    };
    return true;
}
