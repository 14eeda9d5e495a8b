#include "studies/protocol/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_GUESS = 64 }; // bytes that most additions need at most

static bool text_room(struct text *text, size_t more)
{
    if (text->failed)
        return false;
    if (text->size + more + 1 <= text->capacity)
        return true;
    size_t capacity = 2 * (text->size + more + 1);
    char *data = realloc(text->data, capacity);
    if (!data) {
        text->failed = true;
        return false;
    }
    text->data = data;
    text->capacity = capacity;
    return true;
}

void text_add(struct text *text, const char *format, ...)
{
    if (!text_room(text, TEXT_GUESS))
        return;
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    size_t room = text->capacity - text->size;
    int length = vsnprintf(text->data + text->size, room, format, args);
    va_end(args);
    if (length < 0)
        text->failed = true;
    else if ((size_t)length >= room && text_room(text, (size_t)length))
        vsnprintf(text->data + text->size, (size_t)length + 1, format, again);
    va_end(again);
    if (!text->failed)
        text->size += (size_t)length;
}

void text_json_string(struct text *text, const char *value)
{
    text_add(text, "\"");
    for (const char *c = value; *c; c++) {
        const char *plain = c; // the longest stretch that stands as it is
        while ((unsigned char)*c >= 0x20 && *c != 0x7f && *c != '"' && *c != '\\')
            c++;
        text_add(text, "%.*s", (int)(c - plain), plain);
        if (!*c)
            break;
        if (*c == '"' || *c == '\\')
            text_add(text, "\\%c", *c);
        else if (*c == '\n')
            text_add(text, "\\n");
        else
            text_add(text, "\\u%04x", (unsigned)(unsigned char)*c);
    }
    text_add(text, "\"");
}

void text_number(struct text *text, double value)
{
    char digits[40];
    if (fabs(value) < 1e15 &&
        floor(value) == value) { // whole numbers stay without exponent, and without minus zero
        text_add(text, "%lld", (long long)value);
        return;
    }
    for (int precision = 1; precision <= 17; precision++) {
        snprintf(digits, sizeof digits, "%.*g", precision, value);
        if (strtod(digits, NULL) == value)
            break;
    }
    char *comma = strchr(digits, ','); // some locales print one; JSON has none
    if (comma)
        *comma = '.';
    text_add(text, "%s", digits);
}

char *text_take(struct text *text)
{
    if (!text->data)
        text_add(text, "%s", "");
    char *data = text->data;
    if (text->failed) {
        free(data);
        data = NULL;
    }
    *text = (struct text){0};
    return data;
}

bool text_copy(struct text *text, char *out, size_t out_size)
{
    bool fits = !text->failed && text->size < out_size;
    if (fits)
        memcpy(out, text->data ? text->data : "", text->size + 1);
    else if (out_size)
        out[0] = '\0';
    free(text->data);
    *text = (struct text){0};
    return fits;
}
