// Which number a participant has, or would get, in a study file that is only read.
#ifndef APP_FOVSTUDY_CHECK_NUMBER_H
#define APP_FOVSTUDY_CHECK_NUMBER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The rule of store_participant_number (store.h), without opening the file for writing. False with a sentence.
bool check_number(const char *path, const char *code, uint64_t *out, char *error, size_t error_size);

#endif
