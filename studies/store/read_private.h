// Shared by read.c and read_rows.c only.
#ifndef STUDIES_STORE_READ_PRIVATE_H
#define STUDIES_STORE_READ_PRIVATE_H

#include <sqlite3.h>

struct store_reader {
    sqlite3 *db;
    char *path;
    char error[512];
};

void store_reader_fail(struct store_reader *reader, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void store_reader_fail_sqlite(struct store_reader *reader, int code);

#endif
