// Ratings before and after: which trials planned as the first came after the second one had been on screen.
//
// A flagged trial comes again after all others. What is rated then was rated after both options had been seen
// where a trial planned as the second was shown in between, whether that one counts or was itself flagged.
#ifndef ANALYSIS_REPORT_LATE_FIRST_H
#define ANALYSIS_REPORT_LATE_FIRST_H

#include "analysis/report/sample.h"

struct late_first {
    size_t count;
    int64_t *trials; // ids in one file, of repeats
};

// Of the sample's file number `file`. False where memory ran out, or with a sentence of the store's reader.
bool late_first_load(struct late_first *out, const struct sample *sample, size_t file);
void late_first_free(struct late_first *late);
bool late_first_has(const struct late_first *late, int64_t trial_id);

#endif
