#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

FILE *reference_open(const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/tests/reference/%s", SOURCE_DIR, name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    return file;
}

char *reference_field(char **rest, char separator)
{
    if (!*rest)
        return NULL;
    char *field = *rest, *end = strchr(field, separator);
    if (end)
        *end = '\0';
    *rest = end ? end + 1 : NULL;
    return field;
}

double reference_number(const char *text)
{
    if (strcmp(text, "NA") == 0 || strcmp(text, "NaN") == 0)
        return (double)NAN;
    char *end;
    double value = strtod(text, &end);
    assert_true(end != text);
    return value;
}

size_t reference_numbers(const char *text, double *out, size_t most)
{
    size_t count = 0;
    char copy[32768];
    assert_true(strlen(text) < sizeof copy);
    strcpy(copy, text);
    char *rest = copy[0] ? copy : NULL, *field;
    while ((field = reference_field(&rest, ' '))) {
        assert_true(count < most);
        out[count++] = reference_number(field);
    }
    return count;
}

double reference_value(const char *file, const char *name)
{
    FILE *table = reference_open(file);
    char line[256];
    bool found = false;
    double value = (double)NAN;
    while (!found && fgets(line, sizeof line, table)) {
        char *rest = line;
        found = strcmp(reference_field(&rest, ','), name) == 0;
        if (found)
            value = strtod(rest, NULL);
    }
    fclose(table);
    if (!found || isnan(value))
        fail_msg("%s has no value for %s", file, name);
    return value;
}

double reference_distance(double a, double b)
{
    if ((isnan(a) && isnan(b)) || a == b)
        return 0;
    double distance = fabs(a - b) / fabs(b);
    return isnan(distance) ? (double)INFINITY : distance;
}

bool reference_close(double a, double b, double relative)
{
    return reference_distance(a, b) <= relative;
}
