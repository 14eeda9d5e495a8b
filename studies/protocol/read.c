#include "studies/protocol/read.h"

#include "studies/protocol/text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void place(struct reader *reader, uint32_t line, uint32_t column, const char *format, va_list args)
{
    int used = snprintf(reader->error, reader->error_size, "%s:%u:%u: ", reader->file, line, column);
    if (used >= 0 && (size_t)used < reader->error_size)
        vsnprintf(reader->error + used, reader->error_size - (size_t)used, format, args);
}

bool read_fail(struct reader *reader, const struct yaml_node *node, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    place(reader, node->line, node->column, format, args);
    va_end(args);
    return false;
}

bool read_fail_key(struct reader *reader, const struct yaml_node *node, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    place(reader, node->key ? node->key_line : node->line, node->key ? node->key_column : node->column, format,
          args);
    va_end(args);
    return false;
}

void read_remark(struct reader *reader, const struct yaml_node *node, const char *format, ...)
{
    char sentence[PROTOCOL_ERROR];
    struct reader aside = *reader; // so that an error's sentence stays
    struct protocol *protocol = reader->protocol;
    va_list args;
    if (protocol->remark_count == PROTOCOL_REMARKS)
        return;
    aside.error = sentence;
    aside.error_size = sizeof sentence;
    va_start(args, format);
    place(&aside, node->key ? node->key_line : node->line, node->key ? node->key_column : node->column, format,
          args);
    va_end(args);
    char *kept = arena_text(reader->arena, sentence, strlen(sentence));
    if (kept)
        protocol->remarks[protocol->remark_count++] = kept;
}

// Levenshtein 1966: insertions, deletions and replacements of one byte; words are at most PROTOCOL_NAME long.
static size_t distance(const char *a, const char *b)
{
    size_t row[PROTOCOL_NAME + 1];
    size_t columns = strlen(b) < PROTOCOL_NAME ? strlen(b) : PROTOCOL_NAME;
    for (size_t j = 0; j <= columns; j++)
        row[j] = j;
    for (size_t i = 0; a[i] && i < PROTOCOL_NAME; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < columns; j++) {
            size_t replaced = diagonal + (tolower((unsigned char)a[i]) != tolower((unsigned char)b[j]));
            diagonal = row[j + 1];
            size_t moved = (row[j] < row[j + 1] ? row[j] : row[j + 1]) + 1;
            row[j + 1] = replaced < moved ? replaced : moved;
        }
    }
    return row[columns];
}

const char *read_nearest(const char *word, const char *const *known)
{
    const char *nearest = NULL;
    size_t least = (strlen(word) + 2) / 3 + 1;
    for (; *known; known++) {
        size_t apart = distance(word, *known);
        if (apart < least) {
            least = apart;
            nearest = *known;
        }
    }
    return nearest;
}

// "key:" and nothing after it
static bool is_empty(const struct yaml_node *node)
{
    return node->kind == YAML_SCALAR && !*node->text && !node->quoted;
}

bool read_unknown(struct reader *reader, const struct yaml_node *node, bool at_key, const char *what,
                  const char *word, const char *const *known)
{
    if (at_key && is_empty(node) && strspn(word, "0123456789") == strlen(word))
        return read_fail_key(reader, node,
                             "%.60s stands alone: a comma begins another entry; a decimal has a point, as 0.1",
                             word);
    const char *nearest = read_nearest(word, known);
    struct text list = {0};
    if (nearest)
        text_add(&list, "did you mean '%s'?", nearest);
    else if (!*known)
        text_add(&list, "there is none");
    else
        for (const char *const *each = known; *each; each++)
            text_add(&list, "%s%s", each == known ? "known: " : ", ", *each);
    char *tail = text_take(&list);
    bool (*report)(struct reader *, const struct yaml_node *, const char *, ...) =
        at_key ? read_fail_key : read_fail;
    report(reader, node, "%s '%.60s' is not known here; %.600s", what, word, tail ? tail : "");
    free(tail);
    return false;
}

bool read_is_map(struct reader *reader, const struct yaml_node *node, const char *what)
{
    if (node->kind == YAML_MAP)
        return true;
    if (is_empty(node))
        return read_fail(reader, node, "%s has no value; write 'key: value' below it", what);
    return read_fail(reader, node, "%s is a mapping; write 'key: value' below it", what);
}

bool read_fail_count(struct reader *reader, const struct yaml_node *node, const char *what, uint32_t min,
                     uint32_t max)
{
    const char *entries = node->count == 1 ? "entry" : "entries";
    if (min == max)
        return read_fail(reader, node, "%s: %u %s where %u are needed", what, node->count, entries, min);
    return read_fail(reader, node, "%s: %u %s where %u to %u are needed", what, node->count, entries, min, max);
}

bool read_is_list(struct reader *reader, const struct yaml_node *node, const char *what, uint32_t min,
                  uint32_t max)
{
    if (is_empty(node))
        return read_fail(reader, node, "%s has no value; write [..., ...] or one '- ' line each", what);
    if (node->kind != YAML_LIST)
        return read_fail(reader, node, "%s is a list; write [..., ...] or one '- ' line each", what);
    if (node->count < min || node->count > max)
        return read_fail_count(reader, node, what, min, max);
    return true;
}

bool read_section(struct reader *reader, const struct yaml_node *map, const struct language_section *section,
                  const char *const *more)
{
    const char *known[64] = {NULL};
    uint32_t count = 0;
    for (const struct language_key *each = section->keys; each->name; each++)
        known[count++] = each->name;
    for (; more && *more && count < 63; more++)
        known[count++] = *more;
    if (!read_is_map(reader, map, section->title))
        return false;
    for (const struct yaml_node *child = map->first; child; child = child->next) {
        bool found = section->open && !more;
        for (uint32_t i = 0; i < count && !found; i++)
            found = strcmp(known[i], child->key) == 0;
        if (!found) {
            char words[PROTOCOL_NAME + 32];
            snprintf(words, sizeof words, "in %s, key", section->title);
            return read_unknown(reader, child, true, words, child->key, known);
        }
    }
    for (const struct language_key *each = section->keys; each->name; each++)
        if (each->required && !read_required(reader, map, section->title, each->name))
            return false;
    return true;
}

const struct yaml_node *read_required(struct reader *reader, const struct yaml_node *map, const char *what,
                                      const char *key)
{
    const struct yaml_node *node = yaml_get(map, key);
    if (!node)
        read_fail(reader, map, "%s has no '%s'; add it", what, key);
    return node;
}

static bool is_scalar(struct reader *reader, const struct yaml_node *node, const char *what, const char *wanted)
{
    if (node->kind != YAML_SCALAR)
        return read_fail(reader, node, "%s is %s, not a %s", what, wanted,
                         node->kind == YAML_LIST ? "list" : "mapping");
    if (is_empty(node))
        return read_fail(reader, node, "%s has no value; give %s", what, wanted);
    return true;
}

bool read_name(struct reader *reader, const struct yaml_node *node, const char *what, char out[PROTOCOL_NAME])
{
    if (!is_scalar(reader, node, what, "a name"))
        return false;
    size_t length = strlen(node->text);
    size_t legal = strspn(node->text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-");
    if (length == 0 || legal != length)
        return read_fail(reader, node, "%s '%.60s' is not a name; use letters, digits, _ and -", what,
                         node->text);
    if (length >= PROTOCOL_NAME)
        return read_fail(reader, node, "%s is longer than %d characters; shorten it", what, PROTOCOL_NAME - 1);
    memcpy(out, node->text, length + 1);
    return true;
}

bool read_text(struct reader *reader, const struct yaml_node *node, const char *what, char **out)
{
    if (!is_scalar(reader, node, what, "a text"))
        return false;
    size_t length = strlen(node->text);
    while (length > 0 && node->text[length - 1] == '\n')
        length--; // the newline that a YAML block ends with is not part of what is shown
    *out = arena_text(reader->arena, node->text, length);
    return *out ? true : read_fail(reader, node, "out of memory");
}

bool read_number(struct reader *reader, const struct yaml_node *node, const char *what, double min, double max,
                 double *out)
{
    if (!is_scalar(reader, node, what, "a number"))
        return false;
    // Decimal digits only: strtod would also take hexadecimal, infinities and NaN.
    char *end = NULL;
    errno = 0;
    double value = strspn(node->text, "+-.0123456789eE") == strlen(node->text) ? strtod(node->text, &end) : 0;
    if (node->quoted || !end || end == node->text || *end || !isfinite(value))
        return read_fail(reader, node, "%s is a number, not '%.60s'", what, node->text);
    if (value < min || value > max)
        return read_fail(reader, node, "%s is %.60s; it must lie between %g and %g", what, node->text, min,
                         max);
    *out = value;
    return true;
}

bool read_integer(struct reader *reader, const struct yaml_node *node, const char *what, int64_t min,
                  int64_t max, int64_t *out)
{
    if (!is_scalar(reader, node, what, "a whole number"))
        return false;
    char *end = NULL;
    errno = 0;
    long long value = strtoll(node->text, &end, 10);
    bool digits = strspn(node->text, "+-0123456789") == strlen(node->text);
    if (node->quoted || !digits || end == node->text || *end)
        return read_fail(reader, node, "%s is a whole number, not '%.60s'", what, node->text);
    if (min == max && value != min)
        return read_fail(reader, node, "%s is %.60s; it must be %lld", what, node->text, (long long)min);
    if (errno == ERANGE || value < min || value > max)
        return read_fail(reader, node, "%s is %.60s; it must lie between %lld and %lld", what, node->text,
                         (long long)min, (long long)max);
    *out = value;
    return true;
}

bool read_seconds(struct reader *reader, const struct yaml_node *node, const char *what, double max,
                  int64_t *out_ns)
{
    double seconds = 0;
    if (!read_number(reader, node, what, 0, max, &seconds))
        return false;
    *out_ns = (int64_t)floor(seconds * 1e9 + 0.5);
    return true;
}

bool read_word(struct reader *reader, const struct yaml_node *node, const char *what, const char *const *words,
               uint32_t *out_index)
{
    if (!is_scalar(reader, node, what, "a word"))
        return false;
    for (uint32_t i = 0; words[i]; i++) {
        if (strcmp(words[i], node->text) == 0) {
            *out_index = i;
            return true;
        }
    }
    return read_unknown(reader, node, false, what, node->text, words);
}
