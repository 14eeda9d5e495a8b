// Shared by sample*.c only.
#ifndef ANALYSIS_REPORT_SAMPLE_PRIVATE_H
#define ANALYSIS_REPORT_SAMPLE_PRIVATE_H

#include "analysis/report/sample.h"

bool sample_read(struct sample *sample, char *error, size_t error_size);

// Adds the cells of a file whose sessions are known; false where memory ran out or the file could not be read.
bool sample_read_cells(struct sample *sample, size_t file);

// Replaces each text by a copy that the sample owns.
bool sample_keep_all(struct sample *sample, const char **texts[], size_t count);

#endif
