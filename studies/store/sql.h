// Inside the store room: the open database, bound values, fixed prepared statements, transactions.
//
// Every statement's text is in statements.c or, for readers, passed as a constant to sqlite3_prepare_v2 on
// store->db; values are bound, never pasted.
#ifndef STUDIES_STORE_SQL_H
#define STUDIES_STORE_SQL_H

#include "studies/store/owner.h"
#include "studies/store/statements.h"
#include "studies/store/store.h"

#include <pthread.h>
#include <sqlite3.h>
#include <sys/types.h>

struct queue;
struct writer;

struct store {
    sqlite3 *db;  // owned
    char *path;   // owned, absolute, no symbolic links
    bool reading; // STORE_READ
    bool made;    // there was no such file before
    uint32_t busy_ms;
    dev_t device; // of the file as it was opened
    ino_t inode;
    int rescued; // 0: no; -1: it failed; else the number of the copy (rescue.h), which is the file below
    dev_t rescued_device;
    ino_t rescued_inode;
    struct owner owner;
    pthread_mutex_t mutex;                    // held from sql_begin to sql_end: guards db and statements
    sqlite3_stmt *statements[SQL_STATEMENTS]; // owned, prepared at first use
    struct queue *queue;                      // owned; NULL for STORE_READ
    struct writer *writer;                    // owned; NULL for STORE_READ
};

// Writes a sentence; error may be NULL.
void sql_say(struct store_error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));
// Turns an SQLite result code into ours, with a sentence that names the file.
enum store_result sql_failure(struct store *store, int code, struct store_error *error);
// Another connection to what the path now names, in place of the one there was.
enum store_result sql_reconnect(struct store *store, struct store_error *error);
// Whether the path still names the file that was opened.
bool sql_file_there(const struct store *store);
enum store_result sql_execute(struct store *store, const char *sql, struct store_error *error);

struct sql_value {
    enum { SQL_NULL, SQL_INTEGER, SQL_REAL, SQL_TEXT } kind;
    int64_t integer;
    double real;
    const char *text; // borrowed until the statement has run
};

struct sql_value sql_integer(int64_t value); // STORE_UNKNOWN is NULL
struct sql_value sql_id(int64_t id);         // 0 is NULL
struct sql_value sql_seed(uint64_t seed);    // the same bits
struct sql_value sql_truth(bool value);
struct sql_value sql_real(double value);      // NaN is NULL
struct sql_value sql_text(const char *value); // NULL is NULL
struct sql_value sql_json(const char *value); // NULL is {}
struct sql_value sql_slot(enum store_slot slot);
struct sql_value sql_eye(enum gaze_eye eye);

// Runs a statement that returns no row. out_id (may be NULL): the id of the row it inserted.
enum store_result sql_run(struct store *store, enum sql_statement statement, const struct sql_value *values,
                          size_t count, int64_t *out_id, struct store_error *error);
// Reads `columns` numbers of the first row; out_found false where there is none.
enum store_result sql_get(struct store *store, enum sql_statement statement, const struct sql_value *values,
                          size_t count, struct sql_value *out, size_t columns, bool *out_found,
                          struct store_error *error);

// A transaction of one call. sql_begin takes the lock and first writes what waits in the queue; sql_end commits
// where `result` is STORE_OK, else rolls back (what waits stays in the queue), and releases the lock. Always in
// pairs, also where sql_begin failed.
enum store_result sql_begin(struct store *store, struct store_error *error);
enum store_result sql_end(struct store *store, enum store_result result, struct store_error *error);

#define countof(array) (sizeof(array) / sizeof((array)[0]))

#endif
