#include "analysis/tools/table.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void add(struct table *table, const char *text)
{
    char **cells = realloc(table->cells, (table->count + 1) * sizeof *cells);
    if (cells)
        table->cells = cells;
    char *copy = cells ? strdup(text) : NULL;
    if (copy)
        table->cells[table->count++] = copy;
    else
        table->failed = true;
}

void table_init(struct table *table, const char *const *headings)
{
    *table = (struct table){0};
    while (headings[table->columns])
        add(table, headings[table->columns++]);
}

void table_cell(struct table *table, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 0x20) // a line break or an escape from the study file would spoil the terminal
            *c = ' ';
    add(table, text);
}

// Columns on screen: UTF-8 continuation bytes take none.
static size_t width_of(const char *text)
{
    size_t width = 0;
    for (; *text; text++)
        width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

bool table_print(const struct table *table, FILE *out)
{
    if (table->failed)
        return false;
    size_t width[TABLE_COLUMNS] = {0};
    for (size_t i = 0; i < table->count; i++) {
        const char *cell = table->cells[i];
        size_t w = width_of(i < table->columns && cell[0] == '<' ? cell + 1 : cell),
               *most = &width[i % table->columns];
        *most = w > *most ? w : *most;
    }
    for (size_t i = 0; i < table->count; i++) {
        size_t column = i % table->columns;
        bool words = table->cells[column][0] == '<', last = column + 1 == table->columns;
        const char *cell = i < table->columns && words ? table->cells[i] + 1 : table->cells[i];
        int pad = (int)(width[column] - width_of(cell));
        if (words)
            fprintf(out, "%s%*s", cell, last ? 0 : pad, "");
        else
            fprintf(out, "%*s%s", pad, "", cell);
        fputs(last ? "\n" : "  ", out);
    }
    return true;
}

void table_finish(struct table *table)
{
    for (size_t i = 0; i < table->count; i++)
        free(table->cells[i]);
    free(table->cells);
    *table = (struct table){0};
}
