// The catalogue with every mode of DESIGN section 3, those too that the program does not have yet: what the
// papers' studies are read against.
#ifndef TESTS_STUDIES_PAPERS_CATALOGUE_H
#define TESTS_STUDIES_PAPERS_CATALOGUE_H

#include "studies/protocol/catalogue.h"

#include <stdbool.h>

enum { PAPERS_MOVING_OBJECTS, PAPERS_SSAO, PAPERS_TAA }; // places in protocol_settings.render

// with_all: false leaves the modes out that the program lacks, and names them as missing.
static inline const struct catalogue *papers_catalogue(bool with_all)
{
    static const char *const dynamic[] = {"foveated", "regular", 0};
    static const char *const splat[] = {"atomic", "points", 0};
    static const char *const path[] = {"compute", "hardware", 0};
    static const char *const light[] = {"point", "area", "ao", 0};
    static const char *const off_on[] = {"off", "on", 0};
    static const struct catalogue_parameter time_warped[] = {
        {.name = "epsilon", .unit = "", .max = 1, .fallback = 0.2},
        {.name = "fovea_deg", .unit = "deg", .max = 90, .fallback = 10},
        {.name = "periphery_deg", .unit = "deg", .max = 120, .fallback = 30},
        {.name = "hole_decay", .unit = "", .max = 1, .fallback = 0.6},
        {.name = "dynamic_decay", .unit = "", .max = 1, .fallback = 0.75},
        {.name = "dynamic_objects", .unit = "", .max = 1, .choices = dynamic},
        {.name = "splat", .unit = "", .max = 1, .choices = splat},
    };
    static const struct catalogue_parameter vrs[] = {
        {.name = "inner_deg", .unit = "deg", .max = 90, .fallback = 10},
        {.name = "outer_deg", .unit = "deg", .max = 90, .fallback = 20},
        {.name = "path", .unit = "", .max = 1, .choices = path}};
    // In Stengel 2016's normalised device coordinates; the defaults are its section 6.1's.
    static const struct catalogue_parameter adaptive[] = {
        {.name = "acuity_limit", .unit = "", .max = 4, .fallback = 1.1715},
        {.name = "acuity_slope", .unit = "", .min = -20, .max = 0, .fallback = -2.45},
        {.name = "fovea_radius", .unit = "", .max = 1, .fallback = 0.07},
        {.name = "periphery_min", .unit = "", .max = 1, .fallback = 0.02},
        {.name = "eye_motion", .unit = "", .max = 1, .fallback = 1, .choices = off_on},
        {.name = "silhouettes", .unit = "", .max = 1, .fallback = 1, .choices = off_on},
        {.name = "saliency", .unit = "", .max = 1, .fallback = 1, .choices = off_on},
        {.name = "highlights", .unit = "", .max = 1, .fallback = 1, .choices = off_on},
        {.name = "brightness", .unit = "", .max = 1, .fallback = 1, .choices = off_on},
        {.name = "texture", .unit = "", .max = 1, .fallback = 1, .choices = off_on},
    };
    static const struct catalogue_parameter ray_traced[] = {
        {.name = "inner_deg", .unit = "deg", .max = 90, .fallback = 10},
        {.name = "outer_deg", .unit = "deg", .max = 120, .fallback = 20},
        {.name = "p_min", .unit = "", .max = 1, .fallback = 0.05},
        {.name = "shading", .unit = "", .max = 2, .choices = light},
    };
    static const struct catalogue_parameter ray_traced_full[] = {
        {.name = "shading", .unit = "", .max = 2, .choices = light}};
    static const struct catalogue_parameter phase_aligned[] = {
        {.name = "downsample", .unit = "", .min = 1, .max = 16, .fallback = 4},
        {.name = "inset_deg", .unit = "deg", .max = 90, .fallback = 15},
        {.name = "depth_m", .unit = "m", .max = 1000, .fallback = 2},
        {.name = "aligned", .unit = "", .max = 1, .fallback = 1, .choices = off_on},
    };
    static const struct catalogue_parameter latency_inset[] = {
        {.name = "latency_ms", .unit = "ms", .max = 500, .fallback = 50},
        {.name = "saccade_deg_per_s", .unit = "deg_per_s", .max = 1000, .fallback = 200},
        {.name = "fovea_deg", .unit = "deg", .max = 90, .fallback = 2.5},
        {.name = "blend_px", .unit = "px", .max = 500, .fallback = 16},
        {.name = "error_px", .unit = "px", .max = 500},
    };
    static const struct catalogue_mode modes[] = {
        {.name = "regular"},
        {.name = "time_warped", .parameters = time_warped, .parameter_count = 7},
        {.name = "vrs", .parameters = vrs, .parameter_count = 3},
        {.name = "adaptive", .parameters = adaptive, .parameter_count = 10},
        {.name = "ray_traced", .parameters = ray_traced, .parameter_count = 4},
        {.name = "ray_traced_full", .parameters = ray_traced_full, .parameter_count = 1},
        {.name = "phase_aligned", .parameters = phase_aligned, .parameter_count = 4},
        {.name = "latency_inset", .parameters = latency_inset, .parameter_count = 5},
    };
    static const char *const missing[] = {"adaptive",      "ray_traced",    "ray_traced_full",
                                          "phase_aligned", "latency_inset", 0};
    static const char *const scenes[] = {"atrium", "town"};
    static const struct catalogue_parameter settings[] = {
        [PAPERS_MOVING_OBJECTS] = {.name = "moving_objects", .unit = "", .max = 1, .choices = off_on},
        [PAPERS_SSAO] = {.name = "ssao", .unit = "", .max = 1, .choices = off_on},
        [PAPERS_TAA] = {.name = "taa", .unit = "", .max = 1, .choices = off_on},
    };
    static const struct catalogue catalogues[2] = {
        {.modes = modes,
         .mode_count = 3,
         .missing_modes = missing,
         .scenes = scenes,
         .scene_count = 2,
         .settings = settings,
         .setting_count = 3},
        {.modes = modes,
         .mode_count = 8,
         .scenes = scenes,
         .scene_count = 2,
         .settings = settings,
         .setting_count = 3},
    };
    return &catalogues[with_all];
}

#endif
