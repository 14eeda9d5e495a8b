#include "analysis/tools/cell.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *cell_number(double value, char text[CELL_NUMBER_SIZE])
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, CELL_NUMBER_SIZE, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    return text;
}

const char *cell_seconds(int64_t ns, char text[CELL_SECONDS_SIZE])
{
    uint64_t size = ns < 0 ? 0 - (uint64_t)ns : (uint64_t)ns;
    snprintf(text, CELL_SECONDS_SIZE, "%s%" PRIu64 ".%09" PRIu64, ns < 0 ? "-" : "", size / 1000000000,
             size % 1000000000);
    return text;
}

const struct store_cell *cell_find(const struct store_cell *cells, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(cells[i].name, name) == 0)
            return cells[i].kind == STORE_CELL_NONE ? NULL : &cells[i];
    return NULL;
}

const char *cell_text(const struct store_cell *cells, size_t count, const char *name)
{
    const struct store_cell *cell = cell_find(cells, count, name);
    return cell && cell->kind == STORE_CELL_TEXT ? cell->text : "";
}

int64_t cell_integer(const struct store_cell *cells, size_t count, const char *name, int64_t missing)
{
    const struct store_cell *cell = cell_find(cells, count, name);
    return cell && cell->kind == STORE_CELL_INTEGER ? cell->integer : missing;
}

void cell_write_tsv(FILE *out, const struct store_cell *cell)
{
    char text[CELL_NUMBER_SIZE];
    if (cell && cell->kind == STORE_CELL_INTEGER)
        fprintf(out, "%" PRId64, cell->integer);
    else if (cell && cell->kind == STORE_CELL_REAL && isfinite(cell->real))
        fputs(cell_number(cell->real, text), out);
    else if (cell && cell->kind == STORE_CELL_TEXT && cell->text[0])
        for (const char *c = cell->text; *c; c++)
            fputc(strchr("\t\r\n", *c) ? ' ' : *c, out);
    else
        fputs("n/a", out);
}
