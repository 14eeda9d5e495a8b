// Known image errors by option, scene and settings: rows of the study file, lines of a file of errors, and what
// lies between them.
#ifndef APP_SESSION_ERRORS_TABLE_H
#define APP_SESSION_ERRORS_TABLE_H

#include "app/session/measure.h"
#include "studies/store/store.h"

#include <stdbool.h>
#include <stddef.h>

// What errors are asked of.
struct errors_place {
    const char *scene, *spec;    // by its name and by what is shown for it
    char metric[MEASURE_METRIC]; // with its settings
};

struct errors_table;
// Rows of the file come before lines. NULL with a sentence. `file` "" for none.
struct errors_table *errors_table_read(struct store *store, int64_t reference_id, const char *file, char *error,
                                       size_t error_size);
void errors_table_destroy(struct errors_table *table); // NULL is fine

// NaN where it is not known.
double errors_table_find(const struct errors_table *table, const struct errors_place *place,
                         const struct mode_choice *choice);
// Between the known errors of options that differ from `choice` in this parameter alone; NaN with fewer than
// two. out_count (may be NULL): how many are known.
double errors_table_between(const struct errors_table *table, const struct errors_place *place,
                            const struct mode_choice *choice, uint32_t parameter, double value,
                            uint32_t *out_count);

#endif
