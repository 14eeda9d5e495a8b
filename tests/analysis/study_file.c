#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <sqlite3.h>

#include <cmocka.h>

enum { PEOPLE = 22 };

static void execute(sqlite3 *db, const char *sql)
{
    char *message = NULL;
    if (sqlite3_exec(db, sql, NULL, NULL, &message) != SQLITE_OK)
        fail_msg("%s in: %s", message, sql);
}

static void run(sqlite3 *db, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *sql = sqlite3_vmprintf(format, arguments);
    va_end(arguments);
    execute(db, sql);
    sqlite3_free(sql);
}

static sqlite3 *open_database(const char *path)
{
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    return db;
}

void study_file_sql(const char *path, const char *sql)
{
    sqlite3 *db = open_database(path);
    execute(db, sql);
    sqlite3_close(db);
}

const char *study_file_ask(const char *path, const char *sql)
{
    static char answer[256];
    sqlite3 *db = NULL;
    sqlite3_stmt *statement = NULL;
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    if (sqlite3_prepare_v2(db, sql, -1, &statement, NULL) != SQLITE_OK || sqlite3_step(statement) != SQLITE_ROW)
        fail_msg("%s: %s", sqlite3_errmsg(db), sql);
    snprintf(answer, sizeof answer, "%s", (const char *)sqlite3_column_text(statement, 0));
    sqlite3_finalize(statement);
    sqlite3_close(db);
    return answer;
}

void study_file_even(const char *path)
{
    study_file_sql(path,
                   "UPDATE choice SET chosen = (SELECT iif((trial_id / 10 <= iif(trial_id % 10 = 1, 11, 9)) = "
                   "(test_slot = 'a'), 'a', 'b') FROM trial WHERE trial.id = trial_id)");
}

static void apply_schema(sqlite3 *db)
{
    char path[512];
    snprintf(path, sizeof path, "%s/studies/store/schema.sql", SOURCE_DIR);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    static char sql[65536];
    size_t size = fread(sql, 1, sizeof sql - 1, file);
    sql[size] = '\0';
    fclose(file);
    execute(db, sql);
}

static void add_person(sqlite3 *db, int i, const struct study_desc *desc)
{
    const char *code = desc->hostile ? "<script>alert(1)</script>" : "P";
    char *name = sqlite3_mprintf("%s%02d", code, i);
    run(db, "INSERT INTO participant VALUES(%d, %d, %Q, %Q, '{\"age\":%d,\"vr\":\"%s\"}')", i, i, name,
        desc->simulated ? "simulated" : "person", 20 + i % 10,
        desc->hostile ? "</table><img src=x onerror=alert(2)>"
        : i % 2       ? "never"
                      : "often");
    sqlite3_free(name);
    run(db,
        "INSERT INTO session VALUES(%d, 1, %d, 7, 'complete', '2026-02-%02dT10:00:00Z', "
        "'2026-02-%02dT10:30:00Z', NULL, NULL, "
        "%Q, 'driver 1', 'headless', 90, 640, 720, 100, '{}')",
        i, i, i, i, desc->hostile ? "\"; system('touch hacked') `touch hacked` & <b> %s" : "test device");
    run(db, "INSERT INTO segment VALUES(%d, %d, '2026-02-01T10:00:00Z', 0, %Q, NULL, '0.1.0', 'start')", i, i,
        desc->simulated ? "simulated" : "monotonic");
}

// Trial ids: 10 i + 1 and + 2 the choices, + 3 and + 4 the ratings.
static void add_choice(sqlite3 *db, int i, int cell, bool chosen, const char *status,
                       const struct study_desc *desc)
{
    char slot = i % 2 ? 'a' : 'b', other = i % 2 ? 'b' : 'a';
    int test = cell == 1 ? 2 : 3;
    char *factors = desc->hostile ? sqlite3_mprintf("{\"x`touch hacked`<b>\":\"%d\\\"\\\\ {} @ #\"}", cell)
                                  : sqlite3_mprintf("{\"epsilon\":%s}", cell == 1 ? "0.2" : "0.05");
    run(db,
        "INSERT INTO trial VALUES(%d, %d, %d, %d, 'main', 'toggle', 'atrium', '{}', %Q, %d, %d, '%c', 'a', "
        "NULL, 1, NULL, "
        "%Q, 1, 0, 1)",
        10 * i + cell, i, i, cell + 1, factors, slot == 'a' ? test : 1, slot == 'a' ? 1 : test, slot, status);
    sqlite3_free(factors);
    bool equal = desc->equal && i == PEOPLE && cell == 1;
    run(db, "INSERT INTO choice VALUES(NULL, %d, %d, '%s', NULL, %lld, 5, %d)", 10 * i + cell, i,
        equal    ? "equal"
        : chosen ? (slot == 'a' ? "a" : "b")
                 : (other == 'a' ? "a" : "b"),
        i * 500000000LL, i % 7);
}

static void add_rating(sqlite3 *db, int i, int which, int condition, int value, const struct study_desc *desc)
{
    run(db,
        "INSERT INTO trial VALUES(%d, %d, %d, %d, 'rate', 'rate', 'town', '{}', '{\"order\":\"%s\"}', %d, "
        "NULL, NULL, NULL, "
        "NULL, 1, NULL, "
        "'done', 1, 0, 1)",
        10 * i + 2 + which, i, i, which == 1 ? 1 : 4, which == 1 ? "first" : "second", condition);
    run(db, "INSERT INTO rating VALUES(NULL, %d, NULL, %d, %Q, 'a', %d, %d, 1, 10, 5)", 10 * i + 2 + which, i,
        desc->hostile ? "<i>How good?</i> \"'\\ `touch hacked`" : "How good does it look?", condition, value);
}

static void add_ratings(sqlite3 *db, int i, const struct study_desc *desc)
{
    static const int first[] = {6, 7, 5, 8, 6, 4, 6, 7, 9, 6, 6, 6, 9, 5, 8, 6, 4, 7, 6, 6, 5, 5};
    static const int change[] = {1, 1, 1, 1, 1, 1, 1, -1, -1, 0, 0, -2, -2, -1, -1, -1, -1, 0, 0, 0};
    bool test_first = i <= 11 || i == 21;
    add_rating(db, i, 1, test_first ? 2 : 1, first[i - 1], desc);
    if (i <= 20)
        add_rating(db, i, 2, test_first ? 1 : 2, first[i - 1] + change[i - 1], desc);
}

static void add_frames(sqlite3 *db)
{
    for (int i = 0; i < 200; i++) {
        int ms = i / 2 * 37 % 100 + 1; // 1 to 100 once per option
        run(db,
            "INSERT INTO frame (session_id, segment_id, trial_id, attempt, number, option, condition_id, "
            "phase, fade_level, "
            "start_ns, cpu_us, gpu_us, present_estimated, late, shaded_px) VALUES(1, 1, 11, 1, %d, 'a', %d, "
            "'stimulus', 0, "
            "%lld, 250, %d, 1, %d, 1000)",
            i, i % 2 + 1, 11000000LL * i, i % 2 ? ms * 500 : ms * 1000, i % 10 == 0);
    }
    run(db, "INSERT INTO frame (session_id, segment_id, number, phase, fade_level, start_ns, "
            "present_estimated, late) "
            "VALUES(1, 1, 200, 'fade', 1, 2200000000, 1, 0)");
    run(db, "INSERT INTO gaze (session_id, segment_id, device_ns, host_ns, eye, x_deg, y_deg, valid) VALUES(1, "
            "1, 0, 0, "
            "'both', 1, 2, 1), (1, 1, 1, 1, 'both', NULL, NULL, 0)");
}

static void fill(sqlite3 *db, const struct study_desc *desc)
{
    run(db, "INSERT INTO protocol VALUES(1, %Q, '%064d', 'study: test')",
        desc->hostile ? "</title><script>alert(3)</script>" : "small", 1);
    run(db, "INSERT INTO condition VALUES(1, 'regular', '{}')");
    run(db, "INSERT INTO condition VALUES(2, %Q, '{\"epsilon\":0.2,\"fovea_deg\":10}')",
        desc->hostile ? "time\"<svg onload=alert(4)>`touch hacked`\n" : "time_warped");
    run(db, "INSERT INTO condition VALUES(3, 'time_warped', '{\"epsilon\":0.05,\"fovea_deg\":10}')");
    for (int i = 1; i <= PEOPLE; i++) {
        add_person(db, i, desc);
        if (desc->bare)
            continue;
        add_choice(db, i, 1, i <= 6, "done", desc);
        add_choice(db, i, 2, i <= 4, i > 19 ? "invalid" : "done", desc);
        add_ratings(db, i, desc);
    }
    if (desc->bare)
        return;
    add_frames(db);
    if (desc->pooled)
        run(db, "INSERT INTO trial VALUES(19, 1, 1, 5, 'main', 'toggle', 'town', '{}', '{\"epsilon\":0.2}', 2, "
                "1, 'a', 'a', "
                "NULL, 1, NULL, 'done', 1, 0, 1); INSERT INTO choice VALUES(NULL, 19, 1, 'a', NULL, 1, 5, 0)");
    for (int i = 1; desc->several && i <= PEOPLE; i++)
        for (int j = 0; j < 8; j++)
            run(db,
                "INSERT INTO trial VALUES(%d, %d, %d, %d, 'main', 'toggle', 'atrium', '{}', "
                "'{\"epsilon\":0.2}', 2, 1, "
                "'a', 'a', NULL, 1, NULL, 'done', 1, 0, 1); INSERT INTO choice VALUES(NULL, %d, %d, '%s', "
                "NULL, 1, 5, "
                "0)",
                1000 + 10 * i + j, i, i, 10 + j, 1000 + 10 * i + j, i, j < 5 * i % 9 ? "a" : "b");
    if (desc->excluded)
        run(db, "INSERT INTO exclusion VALUES(NULL, NULL, 22, NULL, 'gaze_loss', 'planned', 'half of the gaze "
                "was lost', "
                "'fovstudy', '2026'), (NULL, NULL, NULL, 1, 'toggles', 'stricter', 'too few toggles', "
                "'fovstudy', '2026')");
}

void study_file_make(const char *path, const struct study_desc *desc)
{
    unlink(path);
    sqlite3 *db = open_database(path);
    execute(db, "PRAGMA foreign_keys = ON; PRAGMA synchronous = OFF");
    apply_schema(db);
    execute(db, "BEGIN");
    if (!desc->empty)
        fill(db, desc);
    execute(db, "COMMIT");
    sqlite3_close(db);
}
