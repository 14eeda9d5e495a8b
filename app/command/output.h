// A text file that is written whole or not at all: next to its place first, moved there when it is complete.
//
// Use: output_open before the work (so that a place that cannot be written stops it at once) -> print to .file
// -> output_close(keep). A path of "-" is standard output.
#ifndef APP_COMMAND_OUTPUT_H
#define APP_COMMAND_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct output {
    FILE *file;       // NULL: not open
    const char *path; // borrowed
    char temporary[4096];
};

// False with a sentence; then there is nothing to close. path NULL: not open and true.
bool output_open(struct output *output, const char *path, char *error, size_t error_size);
// Keeps the file or drops what was written. False with a sentence where keeping it failed.
bool output_close(struct output *output, bool keep, char *error, size_t error_size);
// A folder with those above it; true where it is there already. False with a sentence.
bool output_make_folder(const char *path, char *error, size_t error_size);

#endif
