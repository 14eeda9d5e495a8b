#include "analysis/report/level.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// DESIGN's suffixes for units, and how people write them.
static const char *const units[][2] = {
    {"_deg", "\u00b0"}, {"_ms", " ms"}, {"_px", " px"}, {"_hz", " Hz"}, {"_m", " m"}};

// The name without its unit's suffix, '_' as spaces; the unit as people write it, "" for none.
static const char *split(const char *factor, char name[64])
{
    const char *unit = "";
    snprintf(name, 64, "%s", strcmp(factor, "epsilon") == 0 ? "\u03b5" : factor);
    size_t length = strlen(name);
    for (size_t i = 0; i < sizeof units / sizeof units[0] && !unit[0]; i++) {
        size_t size = strlen(units[i][0]);
        if (length > size && strcmp(name + length - size, units[i][0]) == 0) {
            name[length - size] = '\0';
            unit = units[i][1];
        }
    }
    for (char *c = name; *c; c++)
        if (*c == '_')
            *c = ' ';
    return unit;
}

void level_words(const char *factor, const char *value, bool named, char out[96])
{
    char name[64];
    const char *unit = split(factor, name);
    snprintf(out, 96, "%s%s%.20s%s", named ? name : "", named ? " " : "", value, unit);
}

void level_name(const char *factor, char out[96])
{
    char name[64];
    const char *unit = split(factor, name);
    snprintf(out, 96, unit[0] ? "%s (%s)" : "%s%s", name, unit + (unit[0] == ' '));
}

void level_join(const struct choice_cell *cell, size_t from, size_t to, char out[256])
{
    out[0] = '\0';
    for (size_t i = from; i < to && i < cell->level_count; i++) {
        char words[96];
        level_words(cell->levels[i].factor, cell->levels[i].value, true, words);
        size_t used = strlen(out);
        snprintf(out + used, 256 - used, "%s%s", i > from ? ", " : "", words);
    }
}

void level_all(const struct sample *sample, const char *factors, char out[256])
{
    out[0] = '\0';
    for (size_t i = 0; i < sample->factor_count; i++) {
        char words[96];
        size_t used = strlen(out);
        if (strcmp(sample->factors[i].factors, factors) != 0)
            continue;
        level_words(sample->factors[i].key, sample->factors[i].value, true, words);
        snprintf(out + used, 256 - used, "%s%s", used ? ", " : "", words);
    }
}

int level_order(const char *a, const char *b)
{
    while (*a && *b) {
        if (isdigit((unsigned char)*a) && isdigit((unsigned char)*b)) {
            char *after_a, *after_b;
            double x = strtod(a, &after_a), y = strtod(b, &after_b);
            if (x != y)
                return x < y ? 1 : -1;
            a = after_a;
            b = after_b;
        } else if (*a != *b) {
            break;
        } else {
            a++;
            b++;
        }
    }
    return (unsigned char)*a - (unsigned char)*b;
}
