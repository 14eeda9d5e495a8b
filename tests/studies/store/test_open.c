#include "fixture.h"
#include "studies/store/migrate.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static void refuse(const char *path, enum store_access access, const char *part)
{
    struct store_error error;
    struct store *store =
        store_open(&(struct store_desc){.path = path, .access = access, .busy_ms = 100}, &error);
    assert_null(store);
    expect_sentence(&error, part);
    assert_null(strchr(error.text, '\n'));
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static bool exists(const char *path, const char *suffix)
{
    char name[128];
    snprintf(name, sizeof name, "%s%s", path, suffix);
    return access(name, F_OK) == 0;
}

static void test_new_file(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct store *store = fixture_open(path, STORE_CREATE);
    assert_int_equal(query(path, "PRAGMA application_id"), 0x46565354);
    assert_int_equal(query(path, "PRAGMA user_version"), STORE_VERSION);
    char *mode = query_text(path, "PRAGMA journal_mode");
    assert_string_equal(mode, "wal\n");
    free(mode);
    // Every table but SQLite's own is STRICT.
    assert_int_equal(query(path,
                           "SELECT count(*) FROM pragma_table_list WHERE schema = 'main' AND type = 'table' "
                           "AND name NOT LIKE 'sqlite_%' AND NOT strict"),
                     0);
    fixture_close(store);
    expect_sound(path);
    // Nothing is left beside the file, and it opens again in each way.
    assert_false(exists(path, "-owner") || exists(path, "-wal") || exists(path, "-shm"));
    for (int access = STORE_WRITE; access <= STORE_READ; access++)
        fixture_close(fixture_open(path, (enum store_access)access));
    assert_false(exists(path, "-owner") || exists(path, "-wal") || exists(path, "-shm"));
}

static void test_header_is_the_schema(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    fixture_close(fixture_open(path, STORE_CREATE));
    // Bytes 68..71 of an SQLite file are its application id (SQLite file format, section 1.3).
    unsigned char header[100];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(header, 1, sizeof header, file), sizeof header);
    fclose(file);
    assert_memory_equal(header + 68, "FVST", 4);
}

static void test_missing(void **state)
{
    struct fixture *fixture = *state;
    refuse(fixture->path, STORE_WRITE, "No such file");
    refuse(fixture->path, STORE_READ, "No such file");
    refuse(fixture->folder, STORE_CREATE, "not a file");
    refuse("/nowhere/at/all/study.db", STORE_CREATE, "cannot be created");
    refuse(NULL, STORE_CREATE, "no study file is named");
    refuse("", STORE_CREATE, "no study file is named");
    struct store_error error;
    assert_null(store_open(
        &(struct store_desc){.path = fixture->path, .access = STORE_CREATE, .flush_ms = 1001}, &error));
    expect_sentence(&error, "flush_ms");
    assert_false(exists(fixture->path, ""));
    write_file(fixture->path, "", 0);
    refuse(fixture->path, STORE_WRITE, "an empty file");
    refuse(fixture->path, STORE_READ, "an empty file");
    fixture_close(fixture_open(fixture->path, STORE_CREATE)); // cut off before its first write
    expect_sound(fixture->path);
}

static void test_not_a_database(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    char text[8192];
    memset(text, 'x', sizeof text);
    write_file(path, text, sizeof text);
    for (int access = STORE_WRITE; access <= STORE_READ; access++)
        refuse(path, (enum store_access)access, "not a database");
    // It is as it was.
    char after[sizeof text] = {0};
    FILE *file = fopen(path, "rb");
    assert_int_equal(fread(after, 1, sizeof after, file), sizeof after);
    fclose(file);
    assert_memory_equal(after, text, sizeof text);
}

static void test_another_programs(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    write_file(path, "", 0);
    assert_int_equal(outsider(path, "PRAGMA application_id = 252006674; CREATE TABLE t (x)"), 0);
    for (int access = STORE_WRITE; access <= STORE_READ; access++)
        refuse(path, (enum store_access)access, "another program's database");
    // Not even its journal mode was touched.
    char *mode = query_text(path, "PRAGMA journal_mode");
    assert_string_equal(mode, "delete\n");
    free(mode);
    assert_false(exists(path, "-owner"));
    // Tables without an id are another program's as well.
    assert_int_equal(outsider(path, "PRAGMA application_id = 0"), 0);
    refuse(path, STORE_CREATE, "another program's database");
}

static void test_newer(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    fixture_close(fixture_open(path, STORE_CREATE));
    assert_int_equal(outsider(path, "PRAGMA user_version = 3"), 0);
    for (int access = STORE_WRITE; access <= STORE_READ; access++)
        refuse(path, (enum store_access)access, "version 3, newer than this program knows (2)");
    assert_int_equal(outsider(path, "PRAGMA user_version = 0"), 0);
    refuse(path, STORE_WRITE, "damaged (version 0)");
}

static void test_damaged(void **state)
{
    struct fixture *fixture = *state;
    struct store *store = fixture_open(fixture->path, STORE_CREATE);
    struct fixture_session session;
    struct store_error error;
    expect_result(fixture_create(store, "s1", 1, &session, &error), STORE_OK, &error);
    fixture_close(store);
    struct stat status;
    assert_int_equal(stat(fixture->path, &status), 0);
    size_t size = (size_t)status.st_size;
    char *bytes = malloc(size), name[128];
    FILE *file = fopen(fixture->path, "rb");
    assert_int_equal(fread(bytes, 1, size, file), size);
    fclose(file);
    snprintf(name, sizeof name, "%s/damaged.db", fixture->folder);
    // Cut off at every page, and in the middle of one: a sentence, never a crash and never success.
    for (size_t cut = 4096; cut < size; cut += 4096) {
        write_file(name, bytes, cut - (cut / 4096 % 2) * 100);
        refuse(name, STORE_WRITE, "damaged.db: ");
    }
    // A header with a page size that cannot be.
    bytes[16] = 3;
    write_file(name, bytes, size);
    refuse(name, STORE_WRITE, "not a database");
    bytes[16] = 0x10;
    // The schema's first page overwritten after the header.
    memset(bytes + 100, 0x5a, 3996);
    write_file(name, bytes, size);
    refuse(name, STORE_WRITE, "damaged");
    free(bytes);
    // A table is missing.
    assert_int_equal(outsider(fixture->path, "DROP TABLE gaze_check"), 0);
    refuse(fixture->path, STORE_WRITE, "gaze_check.id is missing");
}

static void test_check_finds_damage(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct store *store = fixture_open(path, STORE_CREATE);
    struct store_error error;
    expect_result(store_check(store, &error), STORE_OK, &error);
    fixture_close(store);
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(path, &db), 0);
    // Foreign keys are off here: a row that refers to nothing.
    assert_int_equal(sqlite3_exec(db, "INSERT INTO staircase_step VALUES (1, 99, 0.5, 1, 0, NULL)", 0, 0, 0),
                     0);
    sqlite3_close(db);
    store = fixture_open(path, STORE_READ);
    expect_result(store_check(store, &error), STORE_REFUSED, &error);
    expect_sentence(&error, "a row of staircase_step refers to a row of trial that is not there");
    fixture_close(store);
}

// Root may write anything, so the questions about rights are asked as nobody.
static void as_nobody(void (*ask)(const struct fixture *), const struct fixture *fixture)
{
    pid_t child = fork();
    if (child == 0) {
        if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0))
            _exit(77);
        ask(fixture);
        _exit(0); // fail_msg would have ended the process otherwise
    }
    int status = -1;
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

static void ask_sentence(const struct fixture *fixture, enum store_access access, const char *part)
{
    struct store_error error = {""};
    struct store *store = store_open(&(struct store_desc){.path = fixture->path, .access = access}, &error);
    if (store || !strstr(error.text, part)) {
        fprintf(stderr, "'%s' does not say '%s'\n", store ? "opened" : error.text, part);
        _exit(1);
    }
}

static void ask_read_only_file(const struct fixture *fixture)
{
    ask_sentence(fixture, STORE_WRITE, "cannot be written: Permission denied");
    ask_sentence(fixture, STORE_CREATE, "cannot be written: Permission denied");
}

static void ask_read_only_folder(const struct fixture *fixture)
{
    ask_sentence(fixture, STORE_WRITE, "the folder cannot be written");
    // Reading works, without a place for the log.
    struct store_error error;
    struct store *store = store_open(&(struct store_desc){.path = fixture->path, .access = STORE_READ}, &error);
    if (!store || store_check(store, &error) != STORE_OK) {
        fprintf(stderr, "%s\n", error.text);
        _exit(1);
    }
    store_close(store, NULL);
}

static void ask_create(const struct fixture *fixture)
{
    ask_sentence(fixture, STORE_CREATE, "cannot be created: Permission denied");
}

static void test_rights(void **state)
{
    struct fixture *fixture = *state;
    assert_int_equal(chmod(fixture->folder, 0555), 0);
    as_nobody(ask_create, fixture);
    assert_int_equal(chmod(fixture->folder, 0755), 0);
    fixture_close(fixture_open(fixture->path, STORE_CREATE));
    assert_int_equal(chmod(fixture->path, 0444), 0);
    assert_int_equal(chmod(fixture->folder, 0777), 0);
    as_nobody(ask_read_only_file, fixture);
    assert_int_equal(chmod(fixture->path, 0666), 0);
    assert_int_equal(chmod(fixture->folder, 0555), 0);
    as_nobody(ask_read_only_folder, fixture);
    assert_int_equal(chmod(fixture->folder, 0755), 0);
}

static void test_two_owners(void **state)
{
    struct fixture *fixture = *state;
    struct store *store = fixture_open(fixture->path, STORE_CREATE);
    refuse(fixture->path, STORE_WRITE, "in use by another program");
    // Under another name as well.
    char link_name[128];
    snprintf(link_name, sizeof link_name, "%s/link.db", fixture->folder);
    assert_int_equal(symlink(fixture->path, link_name), 0);
    refuse(link_name, STORE_CREATE, "in use by another program");
    // The refusals did not disturb the owner, and readers need no lock.
    struct fixture_session session;
    struct store_error error;
    expect_result(fixture_create(store, "s1", 1, &session, &error), STORE_OK, &error);
    fixture_close(fixture_open(fixture->path, STORE_READ));
    fixture_close(store);
    fixture_close(fixture_open(link_name, STORE_WRITE));
}

static void test_owner_dies(void **state)
{
    struct fixture *fixture = *state;
    int ready[2];
    assert_int_equal(pipe(ready), 0);
    pid_t child = fork();
    if (child == 0) {
        struct store *store =
            store_open(&(struct store_desc){.path = fixture->path, .access = STORE_CREATE}, NULL);
        (void)!write(ready[1], store ? "1" : "0", 1);
        for (;;)
            pause();
    }
    char opened = 0;
    assert_int_equal(read(ready[0], &opened, 1), 1);
    assert_int_equal(opened, '1');
    char pid[32];
    snprintf(pid, sizeof pid, "(process %d)", (int)child);
    refuse(fixture->path, STORE_WRITE, pid);
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    assert_true(exists(fixture->path, "-owner")); // left over, and no obstacle
    fixture_close(fixture_open(fixture->path, STORE_WRITE));
    assert_false(exists(fixture->path, "-owner"));
    close(ready[0]);
    close(ready[1]);
}

// --- the ladder, with a made-up history of three versions ---

static const char v1[] =
    "PRAGMA application_id = 1180062548; PRAGMA user_version = 1;"
    "CREATE TABLE a (id INTEGER PRIMARY KEY, x INTEGER) STRICT; INSERT INTO a VALUES (1, 5);";
static const char v3[] = "PRAGMA application_id = 1180062548; PRAGMA user_version = 3;"
                         "CREATE TABLE a (id INTEGER PRIMARY KEY, x INTEGER, y TEXT) STRICT;"
                         "CREATE TABLE b (id INTEGER PRIMARY KEY, a_id INTEGER REFERENCES a (id)) STRICT;";
static const char to2[] = "ALTER TABLE a ADD COLUMN y TEXT; UPDATE a SET y = 'x is ' || x;";
static const char to3[] = "CREATE TABLE b (id INTEGER PRIMARY KEY, a_id INTEGER REFERENCES a (id)) STRICT;"
                          "INSERT INTO b SELECT id, id FROM a;";

static enum store_result climb(const char *path, const char *const *steps, enum migrate_state *out_state,
                               struct store_error *error)
{
    const struct migrate_ladder ladder = {.version = 3, .schema = v3, .steps = steps};
    struct store store = {.path = (char *)path};
    assert_int_equal(sqlite3_open(path, &store.db), 0);
    enum store_result result = migrate_identify(&store, &ladder, out_state, error);
    if (result == STORE_OK)
        result = migrate_apply(&store, &ladder, *out_state, error);
    if (result == STORE_OK)
        result = migrate_check_tables(&store, &ladder, error);
    sqlite3_close(store.db);
    return result;
}

static void test_ladder(void **state)
{
    const char *path = ((struct fixture *)*state)->path;
    struct store_error error = {""};
    enum migrate_state before;
    write_file(path, "", 0);
    assert_int_equal(outsider(path, v1), 0);
    // A step that fails half-way, and one that breaks a reference, leave version 1 as it was.
    const char *const failing[] = {to2, "CREATE TABLE c (id INTEGER); INSERT INTO nowhere VALUES (1)"};
    assert_int_equal(climb(path, failing, &before, &error), STORE_FAILED);
    const char *const dangling[] = {to2,
                                    "CREATE TABLE b (id INTEGER PRIMARY KEY, a_id INTEGER REFERENCES a (id)) "
                                    "STRICT; INSERT INTO b VALUES (1, 99)"};
    assert_int_equal(climb(path, dangling, &before, &error), STORE_REFUSED);
    expect_sentence(&error, "left as it is");
    assert_int_equal(query(path, "PRAGMA user_version"), 1);
    assert_int_equal(query(path, "SELECT count(*) FROM pragma_table_info('a')"), 2);
    assert_int_equal(query(path, "SELECT count(*) FROM sqlite_schema"), 1);
    // The whole ladder, in one go.
    const char *const steps[] = {to2, to3};
    error.text[0] = '\0';
    expect_result(climb(path, steps, &before, &error), STORE_OK, &error);
    assert_int_equal(before, MIGRATE_OLDER);
    assert_int_equal(query(path, "PRAGMA user_version"), 3);
    assert_int_equal(query(path, "SELECT count(*) FROM b JOIN a ON a.id = a_id WHERE y = 'x is 5'"), 1);
    // Again: nothing to do. Newer than the ladder: refused.
    expect_result(climb(path, steps, &before, &error), STORE_OK, &error);
    assert_int_equal(before, MIGRATE_CURRENT);
    assert_int_equal(outsider(path, "PRAGMA user_version = 4"), 0);
    assert_int_equal(climb(path, steps, &before, &error), STORE_REFUSED);
    expect_sentence(&error, "version 4, newer");
}

// --- files of each earlier version, made by the schema of then ---

static void make_old(const char *path, const char *schema)
{
    static char sql[1 << 16];
    FILE *file = fopen(schema, "r");
    assert_non_null(file);
    size_t size = fread(sql, 1, sizeof sql - 1, file);
    fclose(file);
    sql[size] = '\0';
    write_file(path, "", 0);
    assert_int_equal(outsider(path, sql), 0);
}

// An older file gets the columns of a new one, in their order, keeps its rows, and is read only once it has
// them.
static void test_older(void **state)
{
    static const char columns[] =
        "SELECT t.name || '.' || c.cid || c.name || c.type || c.\"notnull\" FROM sqlite_schema AS t, "
        "pragma_table_info(t.name) AS c WHERE t.type = 'table' ORDER BY t.name, c.cid";
    struct fixture *fixture = *state;
    char fresh[128];
    snprintf(fresh, sizeof fresh, "%s-new", fixture->path);
    fixture_close(fixture_open(fresh, STORE_CREATE));
    make_old(fixture->path, SOURCE_DIR "/tests/studies/store/schema_1.sql");
    assert_int_equal(
        outsider(fixture->path,
                 "PRAGMA foreign_keys = OFF; INSERT INTO protocol VALUES (1, 'p', printf('%064d', 1), 'text');"
                 "INSERT INTO participant VALUES (1, 1, 'A', 'person', '{}');"
                 "INSERT INTO session (id, protocol_id, participant_id, seed, status, started_at, settings)"
                 " VALUES (1, 1, 1, 1, 'running', '2026-01-01T10:00:00Z', '{}');"
                 "INSERT INTO segment VALUES (1, 1, '2026-01-01T10:00:00Z', 0, 'simulated', NULL, 'old', "
                 "'start'); INSERT INTO frame (session_id, segment_id, number, phase, fade_level, start_ns,"
                 " present_estimated, target_x_deg, triangles) VALUES (1, 1, 7, 'rest', 0, 5, 1, 2.5, 9)"),
        0);
    refuse(fixture->path, STORE_READ, "older version");
    fixture_close(fixture_open(fixture->path, STORE_WRITE));
    assert_int_equal(query(fixture->path, "PRAGMA user_version"), STORE_VERSION);
    char *ours = query_text(fixture->path, columns), *theirs = query_text(fresh, columns);
    assert_string_equal(ours, theirs);
    free(ours);
    free(theirs);
    assert_int_equal(query(fixture->path, "SELECT count(*) FROM frame WHERE number = 7 AND triangles = 9 AND "
                                          "target_x_deg = 2.5 AND target_m IS NULL"),
                     1);
    assert_int_not_equal(outsider(fixture->path, "UPDATE frame SET target_m = 0"), 0);
    assert_int_equal(outsider(fixture->path, "UPDATE frame SET target_m = 1.5"), 0);
    expect_sound(fixture->path);
    fixture_close(fixture_open(fixture->path, STORE_READ));
    unlink(fresh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_new_file, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_header_is_the_schema, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_missing, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_not_a_database, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_another_programs, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_newer, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_older, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_damaged, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_check_finds_damage, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_rights, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_two_owners, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_owner_dies, fixture_setup, fixture_teardown),
        cmocka_unit_test_setup_teardown(test_ladder, fixture_setup, fixture_teardown),
    };
    return cmocka_run_group_tests_name("studies/store open", tests, NULL, NULL);
}
