// Writes JSON strings.
#ifndef APP_COMMAND_JSON_H
#define APP_COMMAND_JSON_H

#include <stdio.h>

// Quoted and escaped; UTF-8 stays as it is. NULL prints null.
void json_string(FILE *out, const char *text);

#endif
