// A gzip file (RFC 1952) that is written once, the same bytes each time: its header holds no time and no name.
#ifndef ANALYSIS_TOOLS_GZIP_FILE_H
#define ANALYSIS_TOOLS_GZIP_FILE_H

#include <stdbool.h>
#include <stddef.h>

struct gzip_file;

// Appends where the file exists: members of one gzip file are one text to every reader. NULL with errno.
struct gzip_file *gzip_file_open(const char *path);
bool gzip_file_write(struct gzip_file *file, const char *text, size_t size);
bool gzip_file_close(struct gzip_file *file); // on the disk then; NULL is fine; false with errno

#endif
