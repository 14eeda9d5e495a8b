// All modes on one scene, at one size, with one gaze: the walk, frame by frame in turn, and what it gave.
#ifndef APP_FOVBENCH_GROUP_H
#define APP_FOVBENCH_GROUP_H

#include "app/fovbench/request.h"
#include "app/fovbench/row.h"

#include <stdio.h>

struct group_desc {
    const struct request *request;
    const struct scene *scene;
    const char *scene_name; // borrowed by the rows
    struct request_size size;
    const struct request_gaze *gaze;
    FILE *frames_csv;          // NULL: none
    const char *progress_name; // before the progress on a terminal
};

// Fills request->mode_count rows. False after a sentence on stderr.
bool group_measure(const struct group_desc *desc, struct row *out_rows);

#endif
