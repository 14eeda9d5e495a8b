#include "app/fovbench/passes.h"

#include <math.h>
#include <string.h>

const char *const pass_group_names[PASS_GROUPS] = {"reproject", "render", "ssao", "shade",
                                                   "tonemap",   "taa",    "other"};

// By how a pass's name begins; the first that fits counts.
static const struct {
    const char *begin;
    enum pass_group group;
} beginnings[] = {
    {"reproject", PASS_REPROJECT},
    {"resolve", PASS_REPROJECT},
    {"splat", PASS_REPROJECT},
    {"pull", PASS_REPROJECT},
    {"push", PASS_REPROJECT},
    {"fill", PASS_REPROJECT},
    {"confidence", PASS_REPROJECT},
    {"redraw", PASS_REPROJECT},
    {"pyramid", PASS_REPROJECT},
    {"tiles", PASS_REPROJECT},
    {"show", PASS_REPROJECT},
    {"cull", PASS_RENDER},
    {"g-buffer", PASS_RENDER},
    {"gbuffer", PASS_RENDER},
    {"forward", PASS_RENDER},
    {"ssao", PASS_SSAO},
    {"ambient occlusion", PASS_SSAO},
    {"occlusion", PASS_SSAO},
    {"shade", PASS_SHADE},
    {"light", PASS_SHADE},
    {"tone", PASS_TONEMAP},
    {"taa", PASS_TAA},
    {"compose", PASS_TAA},
    {"smooth", PASS_TAA},
    {"motion smoothing", PASS_TAA},
};

enum pass_group pass_group_of(const char *pass)
{
    for (size_t i = 0; i < sizeof beginnings / sizeof beginnings[0]; i++)
        if (strncmp(pass, beginnings[i].begin, strlen(beginnings[i].begin)) == 0)
            return beginnings[i].group;
    return PASS_OTHER;
}

void pass_groups(const struct row_pass *passes, uint32_t count, double out_ms[PASS_GROUPS])
{
    for (int i = 0; i < PASS_GROUPS; i++)
        out_ms[i] = count ? 0 : (double)NAN;
    for (uint32_t i = 0; i < count; i++)
        out_ms[pass_group_of(passes[i].name)] += passes[i].median_ms;
}
