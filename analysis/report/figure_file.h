// A report's figures as files that open alone: SVG, and PDF made from it.
//
// Each bears in a line below the picture, and in its metadata, the study, the data's hash and the program's
// version; of simulated data also that it is simulated. PDF is made by rsvg-convert as a process.
#ifndef ANALYSIS_REPORT_FIGURE_FILE_H
#define ANALYSIS_REPORT_FIGURE_FILE_H

#include "analysis/report/sample.h"

struct figure_files {
    const char *folder;          // borrowed; made where it does not exist
    const struct sample *sample; // borrowed
    size_t svgs, pdfs;           // written
    bool no_pdf;                 // rsvg-convert is not installed
};

// False with a sentence where the folder is none and cannot be made.
bool figure_files_begin(struct figure_files *files, char *error, size_t error_size);
// Writes NAME.svg and NAME.pdf. `svg` is what figure_end() gave; NULL: nothing is written. False with a
// sentence naming the file. A missing rsvg-convert is no failure: files->no_pdf says it.
bool figure_files_write(struct figure_files *files, const char *name, const char *svg, char *error,
                        size_t error_size);

#endif
