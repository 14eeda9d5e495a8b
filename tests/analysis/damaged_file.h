// Study files that went wrong: cut off, overwritten, with an index or a page that is not the table's.
#ifndef TESTS_ANALYSIS_DAMAGED_FILE_H
#define TESTS_ANALYSIS_DAMAGED_FILE_H

#include <stddef.h>

void damaged_file_bytes(const char *path, int byte, size_t count); // a new file of so many equal bytes
void damaged_file_cut(const char *path);                           // to half its size
// A page in the middle, as a block of a disk that was given to another file.
void damaged_file_middle(const char *path);
// The last entry of a small index is missing; its table is whole. SQLite does not notice when it reads.
void damaged_file_index(const char *path, const char *index);
// A page of a large table holds what another one holds, which SQLite does not notice either.
void damaged_file_twice(const char *path, const char *table);

#endif
