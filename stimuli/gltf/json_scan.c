// One pass over the JSON before the parser builds its tree: nesting and counts are bounded (parsers recurse and
// allocate), and the fields that glTF defines as indices, counts and offsets are plain non-negative integers
// (tinygltf narrows 64-bit numbers to int and takes a negative offset for none).
//
// It does not check JSON grammar; the parser does. What lies under "extras" or an unknown extension is not
// ours.
#include "stimuli/gltf/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEY_SIZE = 24 };

struct scan {
    const char *text;
    size_t size, at;
    uint32_t depth;
    uint64_t objects, values;
    char key[GLTF_MAX_JSON_DEPTH + 1][KEY_SIZE]; // the last key at each depth
    char token[KEY_SIZE];                        // the last string
    uint32_t foreign;                            // depth at which extras began, 0 for none
    char *error;
    size_t error_size;
};

static bool fail(struct scan *scan, size_t at, const char *what)
{
    size_t line = 1, column = 1;
    for (size_t i = 0; i < at && i < scan->size; i++) {
        column++;
        if (scan->text[i] == '\n') {
            line++;
            column = 1;
        }
    }
    snprintf(scan->error, scan->error_size, "%zu:%zu: %s", line, column, what);
    return false;
}

static bool is_integer_key(const char *key)
{
    static const char *const keys[] = {"bufferView",
                                       "buffer",
                                       "byteOffset",
                                       "byteLength",
                                       "byteStride",
                                       "count",
                                       "componentType",
                                       "indices",
                                       "material",
                                       "mode",
                                       "mesh",
                                       "camera",
                                       "skin",
                                       "children",
                                       "nodes",
                                       "scene",
                                       "node",
                                       "sampler",
                                       "input",
                                       "output",
                                       "source",
                                       "index",
                                       "texCoord",
                                       "joints",
                                       "light",
                                       "skeleton",
                                       "magFilter",
                                       "minFilter",
                                       "wrapS",
                                       "wrapT",
                                       "inverseBindMatrices"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        if (strcmp(key, keys[i]) == 0)
            return true;
    return false;
}

static bool scan_string(struct scan *scan)
{
    size_t start = scan->at++, length = 0;
    while (scan->at < scan->size && scan->text[scan->at] != '"') {
        if (scan->text[scan->at] == '\\')
            scan->at++;
        if (length + 1 < KEY_SIZE && scan->at < scan->size)
            scan->token[length++] = scan->text[scan->at];
        scan->at++;
    }
    scan->token[length] = '\0';
    if (scan->at >= scan->size)
        return fail(scan, start, "a string without an end; the file is truncated or damaged");
    scan->at++;
    return true;
}

// Whether a double can hold the number; parsers throw where it cannot.
static bool is_finite(const char *text, size_t length)
{
    char copy[64];
    if (length >= sizeof copy)
        return true; // the parser judges these
    memcpy(copy, text, length);
    copy[length] = '\0';
    return isfinite(strtod(copy, NULL));
}

static bool scan_number(struct scan *scan)
{
    size_t start = scan->at;
    bool integer = true;
    while (scan->at < scan->size && strchr("+-.eE0123456789", scan->text[scan->at]) != NULL) {
        integer = integer && scan->text[scan->at] >= '0' && scan->text[scan->at] <= '9';
        scan->at++;
    }
    const char *key = scan->key[scan->depth], *number = scan->text + start;
    size_t digits = scan->at - start;
    char what[160];
    if (!integer && !is_finite(number, digits)) {
        snprintf(what, sizeof what, "%.*s is larger than any number we can hold", (int)digits, number);
        return fail(scan, start, what);
    }
    bool attribute = scan->depth > 0 && strcmp(scan->key[scan->depth - 1], "attributes") == 0;
    if (scan->foreign > 0 || (!is_integer_key(key) && !attribute))
        return true;
    if (integer && (digits < 10 || (digits == 10 && memcmp(number, "2147483647", 10) <= 0)))
        return true;
    snprintf(what, sizeof what, "\"%s\" is %.*s, not an integer from 0 to 2147483647", key,
             (int)(digits < 40 ? digits : 40), number);
    return fail(scan, start, what);
}

static bool is_foreign(const struct scan *scan)
{
    const char *key = scan->key[scan->depth];
    if (strcmp(key, "extras") == 0)
        return true;
    bool extension = scan->depth > 0 && strcmp(scan->key[scan->depth - 1], "extensions") == 0;
    return extension && strcmp(key, "KHR_lights_punctual") != 0 && strcmp(key, "KHR_texture_transform") != 0;
}

static bool open_bracket(struct scan *scan)
{
    bool object = scan->text[scan->at] == '{';
    if (scan->depth == GLTF_MAX_JSON_DEPTH)
        return fail(scan, scan->at, "JSON nested deeper than 48 levels, our limit");
    if (object && ++scan->objects > GLTF_MAX_JSON_OBJECTS)
        return fail(scan, scan->at, "more than 1,000,000 JSON objects, our limit");
    const char *key = scan->key[scan->depth];
    if (scan->foreign == 0 && is_foreign(scan))
        scan->foreign = scan->depth + 1;
    scan->depth++;
    // An array's elements belong to the array's key.
    memcpy(scan->key[scan->depth], object ? "" : key, object ? 1 : KEY_SIZE);
    scan->at++;
    return true;
}

static bool close_bracket(struct scan *scan)
{
    if (scan->depth == 0)
        return fail(scan, scan->at, "a closing bracket too many");
    if (scan->foreign == scan->depth)
        scan->foreign = 0;
    scan->depth--;
    scan->at++;
    return true;
}

static bool scan_token(struct scan *scan)
{
    char c = scan->text[scan->at];
    if (c == '{' || c == '[')
        return open_bracket(scan);
    if (c == '}' || c == ']')
        return close_bracket(scan);
    if (c == '"')
        return scan_string(scan);
    if (c == ':')
        memcpy(scan->key[scan->depth], scan->token, KEY_SIZE);
    if (c == ',' && ++scan->values > GLTF_MAX_JSON_VALUES)
        return fail(scan, scan->at, "more than 8,000,000 JSON values, our limit");
    if (c == '-' || (c >= '0' && c <= '9'))
        return scan_number(scan);
    if (c == '\0')
        return fail(scan, scan->at, "a zero byte; this is not JSON");
    scan->at++;
    return true;
}

bool gltf_scan_json(const char *json, size_t size, char *error, size_t error_size)
{
    if (size > GLTF_MAX_JSON_BYTES) {
        snprintf(error, error_size, "the JSON has %zu bytes; our limit is 64 MiB", size);
        return false;
    }
    struct scan *scan = calloc(1, sizeof *scan);
    if (scan == NULL) {
        snprintf(error, error_size, "out of memory");
        return false;
    }
    *scan = (struct scan){.text = json, .size = size, .error = error, .error_size = error_size};
    bool ok = true;
    while (ok && scan->at < size)
        ok = scan_token(scan);
    if (ok && scan->depth > 0)
        ok = fail(scan, size, "the JSON ends in the middle; the file is truncated or damaged");
    free(scan);
    return ok;
}
