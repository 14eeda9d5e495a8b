#include "power_row.h"

#include "reference.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

FILE *power_rows_open(void)
{
    char line[512];
    FILE *file = reference_open("power_plan.csv");
    assert_non_null(fgets(line, sizeof line, file)); // the headings
    return file;
}

bool power_row_next(FILE *file, struct power_row *out)
{
    char line[512], *rest = line;
    double v[10];
    if (!fgets(line, sizeof line, file))
        return false;
    line[strcspn(line, "\n")] = '\0';
    *out = (struct power_row){0};
    snprintf(out->what, sizeof out->what, "%s", reference_field(&rest, ','));
    for (int i = 0; i < 10; i++)
        v[i] = reference_number(reference_field(&rest, ','));
    out->n = (int64_t)v[0];
    out->cells = (int64_t)v[1];
    out->df = (int64_t)v[2];
    out->x = v[3];
    out->sd = v[4];
    out->margin = v[5];
    out->alpha = v[6];
    out->power = v[7];
    out->value = v[8];
    out->error = v[9];
    return true;
}

double power_row_value(const char *what, int64_t n, int64_t cells, int64_t df, double x, double alpha,
                       double power)
{
    struct power_row row;
    double value = (double)NAN;
    FILE *file = power_rows_open();
    while (isnan(value) && power_row_next(file, &row))
        if (strcmp(row.what, what) == 0 && row.n == n && row.cells == cells && row.df == df && row.x == x &&
            row.alpha == alpha && (isnan(power) || row.power == power))
            value = row.value;
    fclose(file);
    if (isnan(value))
        fail_msg("R has no %s of %d, %d cells, %d degrees of freedom, %g", what, (int)n, (int)cells, (int)df,
                 x);
    return value;
}
