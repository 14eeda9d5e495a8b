// Lines of the tables that people read. Inside this room only.
#ifndef STUDIES_ENGINE_PLAN_TEXT_H
#define STUDIES_ENGINE_PLAN_TEXT_H

#include "studies/protocol/text.h"

// {"epsilon":0.1,"type":"small"} as " epsilon=0.1 type=small" and the line's end; names and plain values hold
// no quotes, commas or colons. `used` columns of the line are taken; it goes on below, indented, where 120 are
// full.
void plan_members_write(struct text *text, const char *json, size_t used, size_t indent);

#endif
