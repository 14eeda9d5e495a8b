// Writes JSON with commas where they belong. NaN and infinite numbers become null.
#ifndef ANALYSIS_TOOLS_JSON_H
#define ANALYSIS_TOOLS_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct json {
    FILE *out;
    bool started; // a value stands before the next one on this level
};

// `key` is NULL within an array and for the outermost value.
void json_open(struct json *json, const char *key, char bracket); // '{' or '['
void json_close(struct json *json, char bracket);                 // '}' or ']'
void json_text(struct json *json, const char *key, const char *value);
void json_number(struct json *json, const char *key, double value); // reads back as the same double
void json_integer(struct json *json, const char *key, int64_t value);
void json_bool(struct json *json, const char *key, bool value);

#endif
