// What `fovstats choices` says of cells in which somebody answered more than once.
#ifndef ANALYSIS_TOOLS_CHOICES_PEOPLE_H
#define ANALYSIS_TOOLS_CHOICES_PEOPLE_H

#include "analysis/report/choices.h"
#include "analysis/tools/json.h"
#include "analysis/tools/table.h"

bool choices_people_print(const struct choices *choices);                      // false where memory ran out
void choices_contrasts_json(struct json *json, const struct choices *choices); // "contrasts"
// Cells of a table: a p-value, and an interval of shares in percent, which may be one-sided or not exist.
void choices_p_cell(struct table *table, double p);
void choices_range_cell(struct table *table, struct stat_interval ci);
// Members of the cell's object.
void choices_people_json(struct json *json, const struct choice_cell *cell, double conf);

#endif
