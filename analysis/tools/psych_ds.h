// A study file as a Psych-DS dataset: a folder with dataset_description.json (JSON-LD, schema.org), README.md
// and data/study-NAME_description-TABLE_data.csv. Rules: Psych-DS schema as of psychds-validator 1.4.0.
#ifndef ANALYSIS_TOOLS_PSYCH_DS_H
#define ANALYSIS_TOOLS_PSYCH_DS_H

#include "studies/store/read.h"

struct psych_ds_column {
    const char *name, *description;
    const char *unit;   // NULL: none
    const char *levels; // the values there are; NULL: any
};

// Every column of every table once, ended by a NULL name.
const struct psych_ds_column *psych_ds_columns(void);

// Into an empty folder. CSV is RFC 4180 (UTF-8, CRLF, header), an empty cell is a missing value, numbers read
// back as the same bits; one pass, rows are not held. The same file gives the same bytes. False with a
// sentence.
bool psych_ds_write(struct store_reader *reader, const char *folder, char *error, size_t error_size);

#endif
