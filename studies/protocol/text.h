// Text that grows as it is written, with JSON's rules for strings and numbers.
//
// After a failed allocation every further call does nothing and text_take returns NULL.
#ifndef STUDIES_PROTOCOL_TEXT_H
#define STUDIES_PROTOCOL_TEXT_H

#include <stdbool.h>
#include <stddef.h>

struct text {
    char *data; // terminated; NULL while empty
    size_t size, capacity;
    bool failed;
};

void text_add(struct text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_json_string(struct text *text, const char *value); // quoted and escaped
void text_number(struct text *text, double value); // the shortest digits that read back as the same value
char *text_take(struct text *text);                // the caller frees it
bool text_copy(struct text *text, char *out, size_t out_size); // frees; false: too small or failed

#endif
