// A sheet of pictures of one size in rows and columns, each under its label, in one PNG.
#ifndef APP_FOVSTUDY_SHEET_H
#define APP_FOVSTUDY_SHEET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SHEET_COLUMNS = 3, SHEET_LABEL = 192 };

struct sheet_cell {
    char label[SHEET_LABEL];
    uint8_t *rgba; // owned; NULL: the place stays empty
};

struct sheet {
    const char *title;      // borrowed
    uint32_t width, height; // of a picture
    uint32_t rows;
    struct sheet_cell (*cells)[SHEET_COLUMNS]; // owned
};

// False: out of memory.
bool sheet_init(struct sheet *sheet, uint32_t rows, uint32_t width, uint32_t height);
void sheet_finish(struct sheet *sheet);
// False with a sentence.
bool sheet_write(const struct sheet *sheet, const char *path, char *error, size_t error_size);

#endif
