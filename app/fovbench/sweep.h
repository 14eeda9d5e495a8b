// Every scene at every size with every gaze, and the files a run leaves.
#ifndef APP_FOVBENCH_SWEEP_H
#define APP_FOVBENCH_SWEEP_H

#include "app/fovbench/request.h"

int sweep(const struct request *request); // the exit status, after what had to be said

#endif
