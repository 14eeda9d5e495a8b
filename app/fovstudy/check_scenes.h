// What a protocol's scenes are where it would be run: whether stand-ins and bindings can be shown, and whether
// the camera's path is long enough for what the blocks ask.
#ifndef APP_FOVSTUDY_CHECK_SCENES_H
#define APP_FOVSTUDY_CHECK_SCENES_H

#include "app/fovstudy/catalogue.h"
#include "studies/protocol/text.h"

#include <stdbool.h>
#include <stddef.h>

// False after one sentence in `error`. Remarks are added to `remarks`, one a line. load: reads bound files too,
// which may take long; else they need only be there.
bool check_scenes(const char *path, const struct protocol *protocol, const struct bound_scene *bound,
                  size_t count, bool load, struct text *remarks, char *error, size_t error_size);

#endif
