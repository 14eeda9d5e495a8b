// Shared by sample.c and sample_read.c only.
#ifndef ANALYSIS_REPORT_SAMPLE_PRIVATE_H
#define ANALYSIS_REPORT_SAMPLE_PRIVATE_H

#include "analysis/report/sample.h"

bool sample_read(struct sample *sample, char *error, size_t error_size);

// Replaces each text by a copy that the sample owns.
bool sample_keep_all(struct sample *sample, const char **texts[], size_t count);

#endif
