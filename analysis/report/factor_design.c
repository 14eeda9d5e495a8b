#include "analysis/report/factor_design.h"

#include <stdlib.h>
#include <string.h>

bool factor_design_init(struct factor_design *out, const struct sample *sample)
{
    *out = (struct factor_design){.people = sample->person_count,
                                  .level = calloc(sample->person_count + 1, sizeof *out->level),
                                  .several = calloc(sample->person_count + 1, sizeof *out->several)};
    if (out->level && out->several)
        return true;
    factor_design_finish(out);
    return false;
}

void factor_design_finish(struct factor_design *design)
{
    free(design->level);
    free(design->several);
    *design = (struct factor_design){0};
}

void factor_design_see(struct factor_design *design, size_t person, const char *level)
{
    if (!design->level[person])
        design->level[person] = level;
    else if (strcmp(design->level[person], level) != 0)
        design->several[person] = true;
}

void factor_design_planned(struct factor_design *design, const struct sample *sample, const char *block,
                           const char *factors, const char *scene, const char *level)
{
    for (size_t i = 0; i < sample->cell_count; i++) {
        const struct sample_cell *cell = &sample->cells[i];
        if (strcmp(cell->block, block) != 0 || strcmp(cell->factors, factors) != 0 ||
            (scene[0] && strcmp(cell->scene, scene) != 0))
            continue;
        for (size_t k = 0; k < cell->session_count; k++) {
            const struct sample_session *session = &sample->sessions[cell->sessions[k]];
            if (!session->excluded)
                factor_design_see(design, session->person, level);
        }
    }
}

struct choice_design factor_design_decide(const struct factor_design *design)
{
    struct choice_design out = {0};
    for (size_t p = 0; p < design->people; p++) {
        out.several += design->several[p];
        out.one += design->level[p] && !design->several[p];
    }
    out.within = out.several >= out.one;
    return out;
}
