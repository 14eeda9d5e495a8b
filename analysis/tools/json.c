#include "analysis/tools/json.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static void write_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\')
            fprintf(out, "\\%c", *c);
        else if (*c < 0x20)
            fprintf(out, "\\u%04x", *c);
        else
            fputc(*c, out);
    }
    fputc('"', out);
}

static void write_key(struct json *json, const char *key)
{
    if (json->started)
        fputc(',', json->out);
    json->started = true;
    if (key) {
        write_string(json->out, key);
        fputc(':', json->out);
    }
}

void json_open(struct json *json, const char *key, char bracket)
{
    write_key(json, key);
    fputc(bracket, json->out);
    json->started = false;
}

void json_close(struct json *json, char bracket)
{
    fputc(bracket, json->out);
    json->started = true;
}

void json_text(struct json *json, const char *key, const char *value)
{
    write_key(json, key);
    write_string(json->out, value);
}

void json_number(struct json *json, const char *key, double value)
{
    write_key(json, key);
    if (!isfinite(value)) {
        fputs("null", json->out);
        return;
    }
    char text[40];
    for (int digits = 15; digits <= 17; digits++) { // the shortest that reads back as the same number
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    fputs(text, json->out);
}

void json_integer(struct json *json, const char *key, int64_t value)
{
    write_key(json, key);
    fprintf(json->out, "%" PRId64, value);
}

void json_bool(struct json *json, const char *key, bool value)
{
    write_key(json, key);
    fputs(value ? "true" : "false", json->out);
}
