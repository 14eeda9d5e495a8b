// Writes JSON values.
#ifndef APP_COMMAND_JSON_H
#define APP_COMMAND_JSON_H

#include <stdbool.h>
#include <stdio.h>

// Quoted and escaped; UTF-8 stays as it is. NULL prints null.
void json_string(FILE *out, const char *text);
// Nine digits; null where it is not finite.
void json_number(FILE *out, double value);
// ,"name": with the value after it; the comma is left out for the first.
void json_key(FILE *out, const char *name, bool first);

#endif
