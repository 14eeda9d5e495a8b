// All that a run measured, as JSON: the CSV's figures by the same names, and what has no column there: passes,
// rings, causes of full redraws, the supersampled reference. null stands for what was not measured and for an
// infinite PSNR.
#ifndef APP_FOVBENCH_JSON_WRITE_H
#define APP_FOVBENCH_JSON_WRITE_H

#include "app/fovbench/request.h"
#include "app/fovbench/row.h"

#include <stdio.h>

void json_write(FILE *out, const struct request *request, const struct row *rows, size_t count);

#endif
