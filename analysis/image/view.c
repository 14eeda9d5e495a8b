// Directions of pixels and gaze, after the conventions of struct viewing_fov and viewing_direction(): -z is
// ahead, x right, y up; longitude and latitude for the gaze, a plane in tangent space for the image.
#include "analysis/image/view.h"

#include <math.h>

static const double rad_per_deg = 0.017453292519943295769;

struct direction {
    double x, y, z;
};

size_t image_row_bytes(const struct image_pixels *image)
{
    return image->row_bytes ? image->row_bytes : (size_t)image->width * image->channels;
}

bool image_pixels_ok(const struct image_pixels *image)
{
    return image->data && image->width && image->height && (image->channels == 3 || image->channels == 4) &&
           image_row_bytes(image) >= (size_t)image->width * image->channels;
}

bool image_pair_ok(const struct image_pixels *a, const struct image_pixels *b)
{
    return image_pixels_ok(a) && image_pixels_ok(b) && a->width == b->width && a->height == b->height;
}

bool image_view_ok(const struct image_view *view)
{
    return isfinite(view->tan_left) && isfinite(view->tan_right) && isfinite(view->tan_down) &&
           isfinite(view->tan_up) && view->tan_left + view->tan_right > 0 && view->tan_down + view->tan_up > 0;
}

bool image_view_gazed(const struct image_view *view)
{
    return isfinite(view->gaze_x_deg) && isfinite(view->gaze_y_deg);
}

static struct direction gaze_direction(const struct image_view *view)
{
    double x = view->gaze_x_deg * rad_per_deg, y = view->gaze_y_deg * rad_per_deg;
    return (struct direction){sin(x) * cos(y), sin(y), -cos(x) * cos(y)};
}

// By atan2 of cross and dot products: acos loses half the digits near the gaze.
static double angle_deg(struct direction a, struct direction b)
{
    double cx = a.y * b.z - a.z * b.y, cy = a.z * b.x - a.x * b.z, cz = a.x * b.y - a.y * b.x;
    return atan2(sqrt(cx * cx + cy * cy + cz * cz), a.x * b.x + a.y * b.y + a.z * b.z) / rad_per_deg;
}

static struct direction pixel_direction(const struct image_view *view, uint32_t width, uint32_t height,
                                        double x, double y)
{
    return (struct direction){x / width * (view->tan_left + view->tan_right) - view->tan_left,
                              view->tan_up - y / height * (view->tan_down + view->tan_up), -1};
}

double image_eccentricity_deg(const struct image_view *view, uint32_t width, uint32_t height, double x,
                              double y)
{
    return angle_deg(gaze_direction(view), pixel_direction(view, width, height, x, y));
}

void image_row_eccentricities_deg(const struct image_view *view, uint32_t width, uint32_t height, uint32_t x0,
                                  uint32_t y, uint32_t count, double *out)
{
    struct direction gaze = gaze_direction(view);
    for (uint32_t i = 0; i < count; i++)
        out[i] = angle_deg(gaze, pixel_direction(view, width, height, x0 + i + 0.5, y + 0.5));
}

double image_pixels_per_degree(const struct image_view *view, uint32_t width, uint32_t height)
{
    if (!image_view_ok(view) || width == 0 || height == 0)
        return (double)NAN;
    double x = (view->tan_right - view->tan_left) / 2, y = (view->tan_up - view->tan_down) / 2;
    double px_per_tan_x = width / (view->tan_left + view->tan_right);
    double px_per_tan_y = height / (view->tan_down + view->tan_up);
    double square = 1 + x * x + y * y;
    double px_per_rad_x = px_per_tan_x * square / sqrt(1 + y * y);
    double px_per_rad_y = px_per_tan_y * square / sqrt(1 + x * x);
    return sqrt(px_per_rad_x * px_per_rad_y) * rad_per_deg;
}
