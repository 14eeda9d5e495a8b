// A two-storey arcaded court under an open sky: columns, arches, vaults, cloth, tiles, plants, a basin.
#ifndef STIMULI_BUILTIN_ATRIUM_H
#define STIMULI_BUILTIN_ATRIUM_H

#include "stimuli/scene.h"

bool atrium_path(struct camera_path *out);
struct scene *atrium_make(const double *values); // takes no parameters; NULL: out of memory

#endif
