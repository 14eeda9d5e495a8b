#include "app/fovbench/csv.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static char *read_file(const char *path, char *error, size_t error_size)
{
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    size_t size = 0, room = 0;
    while (file && !feof(file) && !ferror(file)) {
        if (room - size < 4096) {
            room = 2 * room + 65536;
            char *more = realloc(text, room);
            if (!more)
                break;
            text = more;
        }
        size += fread(text + size, 1, room - size - 1, file);
    }
    if (!file || !feof(file) || !text) {
        snprintf(error, error_size, "%s cannot be read: %s", path, strerror(errno));
        free(text);
        text = NULL;
    } else {
        text[size] = '\0';
    }
    if (file)
        fclose(file);
    return text;
}

// Ends the cell at *at (unquoted in place) and moves *at behind it; the character that ended it, 0 at the end
// of the text, -1 for a quote that is not closed or followed by something else.
static int take_cell(char **at, char **out)
{
    char *from = *at, *to = *at;
    *out = to;
    if (*from == '"') {
        for (from++; *from && !(from[0] == '"' && from[1] != '"'); from++) {
            from += *from == '"';
            *to++ = *from;
        }
        if (*from != '"')
            return -1;
        from++;
    } else {
        from = to += strcspn(from, ",\r\n");
    }
    if (from[0] == '\r' && from[1] == '\n')
        from++;
    int end = (unsigned char)*from;
    *to = '\0';
    *at = from + (end != 0);
    return end == ',' || end == '\n' || end == 0 ? end : -1;
}

static size_t count_most(const char *text)
{
    size_t count = 2;
    for (; *text; text++)
        count += *text == ',' || *text == '\n';
    return count;
}

static bool take_rows(struct csv_table *table, const char *path, char *error, size_t error_size)
{
    char *at = table->text;
    size_t count = 0, in_row = 0, rows = 0;
    while (*at || in_row) {
        int end = take_cell(&at, &table->cells[count]);
        count++;
        in_row++;
        if (end == ',')
            continue;
        if (end < 0 || (rows && in_row != table->column_count)) {
            snprintf(error, error_size,
                     end < 0 ? "%s:%zu: a quoted cell is not closed" : "%s:%zu: %zu cells, not %zu", path,
                     rows + 1, in_row, table->column_count);
            return false;
        }
        table->column_count = in_row;
        in_row = 0;
        rows++;
    }
    table->row_count = rows ? rows - 1 : 0;
    if (rows)
        return true;
    snprintf(error, error_size, "%s is empty", path);
    return false;
}

bool csv_read(struct csv_table *out, const char *path, char *error, size_t error_size)
{
    *out = (struct csv_table){.text = read_file(path, error, error_size)};
    if (!out->text)
        return false;
    out->cells = calloc(count_most(out->text), sizeof *out->cells);
    if (out->cells && take_rows(out, path, error, error_size))
        return true;
    if (!out->cells)
        snprintf(error, error_size, "out of memory");
    csv_finish(out);
    return false;
}

void csv_finish(struct csv_table *table)
{
    free(table->text);
    free(table->cells);
    *table = (struct csv_table){0};
}

int csv_column(const struct csv_table *table, const char *name)
{
    for (size_t i = 0; i < table->column_count; i++)
        if (strcmp(table->cells[i], name) == 0)
            return (int)i;
    return -1;
}

const char *csv_cell(const struct csv_table *table, size_t row, int column)
{
    return column < 0 ? "" : table->cells[(row + 1) * table->column_count + (size_t)column];
}

double csv_number(const struct csv_table *table, size_t row, int column)
{
    const char *text = csv_cell(table, row, column);
    char *end = NULL;
    double value = strtod(text, &end);
    return end == text || *end ? (double)NAN : value;
}
