// What a run says on the terminal.
#ifndef APP_FOVBENCH_TABLE_H
#define APP_FOVBENCH_TABLE_H

#include "app/fovbench/row.h"

#include <stddef.h>
#include <stdio.h>

// The rows of one scene, size and gaze, under a heading of their own.
void table_write(FILE *out, const struct row *rows, size_t count);

#endif
