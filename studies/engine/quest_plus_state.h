// QUEST+'s insides, shared by its two files: quest_plus_model.c (the psychometric functions and their grids)
// and quest_plus.c (the posterior).
#ifndef STUDIES_ENGINE_QUEST_PLUS_STATE_H
#define STUDIES_ENGINE_QUEST_PLUS_STATE_H

#include "studies/engine/quest_plus.h"

// Doubles that one instance needs; infinite where the product is.
double quest_plus_doubles(const struct quest_plus_desc *desc);

// Every parameter set of the grids, outcomes + 2 values each. `order` is scratch of outcomes - 1.
void quest_plus_fill_sets(const struct quest_plus_model *model, bool falling, uint32_t *order, double *out);

#endif
