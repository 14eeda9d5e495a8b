// Passes in the groups of the paper's Table 2 (Franke et al. 2021, section 8.4), so that modes with different
// passes stand side by side.
#ifndef APP_FOVBENCH_PASSES_H
#define APP_FOVBENCH_PASSES_H

#include "app/fovbench/row.h"

enum pass_group {
    PASS_REPROJECT, // reprojection, hole filling, confidence, redraw map
    PASS_RENDER,    // culling and the G-buffer
    PASS_SSAO,
    PASS_SHADE,
    PASS_TONEMAP,
    PASS_TAA, // with composition and motion smoothing
    PASS_OTHER,
    PASS_GROUPS
};

extern const char *const pass_group_names[PASS_GROUPS]; // "reproject", ...: columns are these with "_ms"

enum pass_group pass_group_of(const char *pass);
// Sums of the passes' medians; all NaN where no pass was measured.
void pass_groups(const struct row_pass *passes, uint32_t count, double out_ms[PASS_GROUPS]);

#endif
