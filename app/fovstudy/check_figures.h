// The smallest effects that planned tests show, as text and JSON.
#ifndef APP_FOVSTUDY_CHECK_FIGURES_H
#define APP_FOVSTUDY_CHECK_FIGURES_H

#include "app/fovstudy/check_power.h"
#include "studies/protocol/text.h"

void check_figures_text(struct text *text, const struct check_analyses *analyses, uint32_t people,
                        bool assumed);
void check_figures_json(struct text *text, const struct check_analyses *analyses); // ,"power":[...]

// check_margins.c: a sentence a line, of the file at `path`, for each analysis whose planned margin so few
// people seldom show.
void check_figures_remarks(struct text *remarks, const char *path, const struct check_analyses *analyses);

#endif
