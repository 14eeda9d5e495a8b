// Of SQLite's file format (sqlite.org/fileformat2.html, section 1.6): a page of a b-tree begins with its kind
// (2 and 10 index, 5 and 13 table, the first of each not a leaf) and has its number of cells at byte 3; in an
// inner page the list of cells begins at byte 12, and a cell with the number of the page below.
#include "damaged_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <sqlite3.h>

#include <cmocka.h>

enum { PAGE = 4096 };

void damaged_file_bytes(const char *path, int byte, size_t count)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    for (size_t i = 0; i < count; i++)
        fputc(byte, file);
    assert_int_equal(fclose(file), 0);
}

static long size_of(const char *path)
{
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    return (long)info.st_size;
}

void damaged_file_cut(const char *path)
{
    assert_int_equal(truncate(path, size_of(path) / 2), 0);
}

static void page(const char *path, long number, unsigned char *bytes, bool write)
{
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, (number - 1) * PAGE, SEEK_SET), 0);
    assert_int_equal(write ? fwrite(bytes, 1, PAGE, file) : fread(bytes, 1, PAGE, file), PAGE);
    assert_int_equal(fclose(file), 0);
}

void damaged_file_middle(const char *path)
{
    unsigned char bytes[PAGE];
    memset(bytes, 0xa5, sizeof bytes);
    page(path, size_of(path) / PAGE / 2, bytes, true);
}

static long root(const char *path, const char *name)
{
    sqlite3 *db = NULL;
    sqlite3_stmt *statement = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(
        sqlite3_prepare_v2(db, "SELECT rootpage FROM sqlite_schema WHERE name = ?1", -1, &statement, NULL),
        SQLITE_OK);
    sqlite3_bind_text(statement, 1, name, -1, SQLITE_STATIC);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    long number = (long)sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    sqlite3_close(db);
    return number;
}

void damaged_file_index(const char *path, const char *index)
{
    unsigned char bytes[PAGE];
    long number = root(path, index);
    page(path, number, bytes, false);
    assert_true(bytes[0] == 10 && bytes[4] > 1);
    bytes[4]--;
    page(path, number, bytes, true);
}

static long below(const unsigned char *inner, int cell)
{
    const unsigned char *at = inner + 12 + 2 * cell;
    at = inner + at[0] * 256 + at[1];
    return ((long)at[0] << 24) + (at[1] << 16) + (at[2] << 8) + at[3];
}

void damaged_file_twice(const char *path, const char *table)
{
    unsigned char inner[PAGE], leaf[PAGE];
    page(path, root(path, table), inner, false);
    assert_true(inner[0] == 5 && inner[3] * 256 + inner[4] > 6);
    page(path, below(inner, 5), leaf, false);
    assert_int_equal(leaf[0], 13);
    page(path, below(inner, 2), leaf, true);
}
