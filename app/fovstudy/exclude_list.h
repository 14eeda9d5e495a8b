// What is out of a study file's analysis, for people and for scripts.
#ifndef APP_FOVSTUDY_EXCLUDE_LIST_H
#define APP_FOVSTUDY_EXCLUDE_LIST_H

#include <stdbool.h>
#include <stddef.h>

// As a table, or as a JSON array of objects. False with a sentence.
bool exclude_list(const char *path, bool json, char *error, size_t error_size);

#endif
