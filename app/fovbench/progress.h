// How far long work has come: one line that is written over, on a terminal; nothing anywhere else.
#ifndef APP_FOVBENCH_PROGRESS_H
#define APP_FOVBENCH_PROGRESS_H

#include <stdint.h>

void progress_show(const char *what, const char *part, uint64_t done, uint64_t all);
void progress_clear(void);

#endif
