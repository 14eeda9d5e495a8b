// Whether a factor of any values lies within or between people: what choice_design.h is for choices.
//
// Use: factor_design_init(), factor_design_see() for each value and factor_design_planned() for each cell with
// its level, factor_design_decide(), factor_design_finish(). Who has a value was to have it. A person is at
// several levels wherever they stand, also where nothing else is the same there. As there, at least half of
// the people at several levels make it a factor within people. Levels are texts, borrowed.
#ifndef ANALYSIS_REPORT_FACTOR_DESIGN_H
#define ANALYSIS_REPORT_FACTOR_DESIGN_H

#include "analysis/report/choice_design.h"

struct factor_design {
    size_t people;
    const char **level; // of each person of the sample: the first one; NULL: none
    bool *several;
};

// False where memory ran out; nothing is to be finished then.
bool factor_design_init(struct factor_design *out, const struct sample *sample);
void factor_design_finish(struct factor_design *design);

void factor_design_see(struct factor_design *design, size_t person, const char *level);
// Everybody whose sessions planned trials of a block with these factors, in one scene or (scene "") in any.
void factor_design_planned(struct factor_design *design, const struct sample *sample, const char *block,
                           const char *factors, const char *scene, const char *level);

// `within` where nobody has a level.
struct choice_design factor_design_decide(const struct factor_design *design);

#endif
