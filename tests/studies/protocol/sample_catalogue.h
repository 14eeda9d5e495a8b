// The catalogue that tests read protocols against: the modes' tables as DESIGN section 3 states them.
#ifndef TESTS_STUDIES_SAMPLE_CATALOGUE_H
#define TESTS_STUDIES_SAMPLE_CATALOGUE_H

#include "studies/protocol/catalogue.h"

static inline const struct catalogue *sample_catalogue(void)
{
    static const char *const dynamic[] = {"foveated", "regular", 0};
    static const char *const splat[] = {"atomic", "points", 0};
    static const char *const switched[] = {"off", "on", 0};
    static const struct catalogue_parameter time_warped[] = {
        {"epsilon", "", 0, 1, 0.2, 0, "confidence below which a pixel is drawn anew"},
        {"fovea_deg", "deg", 0, 90, 10, 0, 0},
        {"periphery_deg", "deg", 0, 120, 30, 0, 0},
        {"hole_decay", "", 0, 1, 0.6, 0, 0},
        {"dynamic_objects", "", 0, 1, 0, dynamic, 0},
        {"splat", "", 0, 1, 0, splat, 0},
    };
    static const struct catalogue_mode modes[] = {{"regular", 0, 0, "every pixel", false},
                                                  {"time_warped", time_warped, 6, 0, true}};
    static const char *const scenes[] = {"atrium", "town", "yard"};
    static const struct catalogue_parameter settings[] = {{"moving_objects", "", 0, 1, 0, switched, 0}};
    static const char *const missing[] = {"ray_traced", 0};
    static const struct catalogue catalogue = {.modes = modes,
                                               .mode_count = 2,
                                               .missing_modes = missing,
                                               .scenes = scenes,
                                               .scene_count = 3,
                                               .settings = settings,
                                               .setting_count = 1};
    return &catalogue;
}

#endif
