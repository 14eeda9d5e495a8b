// Writes JSON strings.
#ifndef APP_FOVSTUDY_JSON_H
#define APP_FOVSTUDY_JSON_H

#include <stdio.h>

// Quoted and escaped; UTF-8 stays as it is. NULL prints null.
void json_string(FILE *out, const char *text);

#endif
