#include "fixture.h"

#include <dirent.h>
#include <math.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int make_folder(void **state, const char *place)
{
    struct fixture *fixture = calloc(1, sizeof *fixture);
    if (!fixture)
        return -1;
    snprintf(fixture->folder, sizeof fixture->folder, "%s/store-test-XXXXXX", place);
    if (!mkdtemp(fixture->folder) || chmod(fixture->folder, 0755) != 0) {
        free(fixture);
        return -1;
    }
    snprintf(fixture->path, sizeof fixture->path, "%s/study.db", fixture->folder);
    *state = fixture;
    return 0;
}

// Thousands of commits wait for no disk in memory; the order of writes and syncs is the same.
int fixture_setup(void **state)
{
    return make_folder(state, "/dev/shm") == 0 ? 0 : make_folder(state, "/tmp");
}

int fixture_setup_disk(void **state)
{
    return make_folder(state, "/tmp");
}

int fixture_teardown(void **state)
{
    struct fixture *fixture = *state;
    DIR *folder = opendir(fixture->folder);
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        unlinkat(dirfd(folder), entry->d_name, 0); // "." and ".." refuse
    closedir(folder);
    rmdir(fixture->folder);
    free(fixture);
    return 0;
}

void expect_result(enum store_result result, enum store_result wanted, const struct store_error *error)
{
    if (result != wanted)
        fail_msg("result %d, not %d: %s", result, wanted, error->text);
    if ((wanted == STORE_OK) != (error->text[0] == '\0'))
        fail_msg("result %d with the sentence '%s'", result, error->text);
}

void expect_sentence(const struct store_error *error, const char *part)
{
    if (!strstr(error->text, part))
        fail_msg("'%s' does not say '%s'", error->text, part);
}

struct store *fixture_open(const char *path, enum store_access access)
{
    struct store_error error;
    struct store *store = store_open(
        &(struct store_desc){.path = path, .access = access, .gaze_capacity = 4096, .log_capacity = 512},
        &error);
    if (!store)
        fail_msg("store_open: %s", error.text);
    return store;
}

void fixture_close(struct store *store)
{
    struct store_error error;
    expect_result(store_close(store, &error), STORE_OK, &error);
}

struct store_session fixture_session(struct fixture_parts *parts, const char *code, int64_t number)
{
    parts->conditions[0] = (struct store_condition){"regular", "{}"};
    parts->conditions[1] = (struct store_condition){"time_warped", "{\"epsilon\":0.2}"};
    parts->conditions[2] = (struct store_condition){"time_warped", "{\"epsilon\":0.1}"};
    for (int i = 0; i < FIXTURE_TRIALS; i++)
        parts->trials[i] = (struct store_trial){.ordinal = i + 1,
                                                .block = "main",
                                                .kind = "toggle",
                                                .scene = i % 2 ? "town" : "atrium",
                                                .factors = "{\"epsilon\":0.2}",
                                                .option_a = i % 2 ? 0 : 1 + i % 4 / 2,
                                                .option_b = i % 2 ? 1 + i % 4 / 2 : 0,
                                                .test_slot = i % 2 ? STORE_B : STORE_A,
                                                .first_shown = STORE_A,
                                                .seed = UINT64_MAX - (uint64_t)i};
    return (struct store_session){
        .protocol = {"calibration", "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef",
                     "study: x\n"},
        .participant = {.code = code,
                        .kind = "simulated",
                        .number = number,
                        .attributes = "{\"age_years\":30}"},
        .segment = {.started_at = "2026-01-02T03:04:05Z",
                    .mono_origin_ns = 1000,
                    .clock = "simulated",
                    .app_version = "0.1.0",
                    .reason = "start"},
        .seed = 7,
        .started_at = "2026-01-02T03:04:05Z",
        .refresh_hz = 90,
        .width_px = 640,
        .height_px = 720,
        .fov_deg = 100,
        .conditions = parts->conditions,
        .condition_count = FIXTURE_CONDITIONS,
        .trials = parts->trials,
        .trial_count = FIXTURE_TRIALS};
}

enum store_result fixture_create(struct store *store, const char *code, int64_t number,
                                 struct fixture_session *out_session, struct store_error *error)
{
    struct fixture_parts parts;
    struct store_session session = fixture_session(&parts, code, number);
    *out_session = (struct fixture_session){0};
    out_session->ids.condition_ids = out_session->condition_ids;
    out_session->ids.trial_ids = out_session->trial_ids;
    return store_create_session(store, &session, &out_session->ids, error);
}

struct store_choice fixture_choice(const struct fixture_session *session, int trial)
{
    return (struct store_choice){.trial_id = session->trial_ids[trial],
                                 .segment_id = session->ids.segment_id,
                                 .chosen = STORE_A,
                                 .reaction_ns = 1500000000,
                                 .answered_ns = 9000000000 + trial,
                                 .toggles = 3,
                                 .ends_trial = true};
}

struct store_gaze fixture_gaze(const struct fixture_session *session, int64_t n)
{
    return (struct store_gaze){.session_id = session->ids.session_id,
                               .segment_id = session->ids.segment_id,
                               .trial_id = session->trial_ids[0],
                               .sample = {.device_ns = n * 1000000,
                                          .host_ns = n * 1000000 + 5,
                                          .eye = GAZE_BOTH,
                                          .x_deg = 0.25 * (double)(n % 40),
                                          .y_deg = -1.5,
                                          .pupil_mm = NAN,
                                          .confidence = 0.9,
                                          .valid = true}};
}

struct store_frame fixture_frame(const struct fixture_session *session, uint64_t number, int64_t gaze_id)
{
    return (struct store_frame){.session_id = session->ids.session_id,
                                .segment_id = session->ids.segment_id,
                                .trial_id = session->trial_ids[0],
                                .attempt = 1,
                                .number = number,
                                .option = STORE_A,
                                .condition_id = session->condition_ids[1],
                                .phase = STORE_STIMULUS,
                                .start_ns = (int64_t)number * 11111111,
                                .cpu_us = 150.5,
                                .gpu_us = NAN,
                                .present_ns = STORE_UNKNOWN,
                                .gaze_id = gaze_id,
                                .gaze_age_us = 900,
                                .fovea_deg = {{1.5, -2}, {1.25, -2}},
                                .fovea_source = STORE_FOVEA_GAZE,
                                .target_x_deg = NAN,
                                .target_y_deg = NAN,
                                .target_m = NAN,
                                .head_pose = {{1, 1.6, -2}, {0, 0, 0, 1}},
                                .shaded_px = 12345,
                                .triangles = 678};
}

static sqlite3 *look(const char *path)
{
    sqlite3 *db = NULL;
    if (sqlite3_open_v2(path, &db, SQLITE_OPEN_READWRITE, NULL) != SQLITE_OK)
        fail_msg("%s: %s", path, sqlite3_errmsg(db));
    sqlite3_busy_timeout(db, 5000);
    return db;
}

char *query_text(const char *path, const char *sql)
{
    sqlite3 *db = look(path);
    sqlite3_stmt *statement = NULL;
    size_t size = 0;
    char *text = NULL;
    FILE *stream = open_memstream(&text, &size);
    if (sqlite3_prepare_v2(db, sql, -1, &statement, NULL) != SQLITE_OK)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
    int code;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW) {
        const unsigned char *column = sqlite3_column_text(statement, 0);
        fprintf(stream, "%s\n", column ? (const char *)column : "NULL");
    }
    if (code != SQLITE_DONE)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
    sqlite3_finalize(statement);
    sqlite3_close(db);
    fclose(stream);
    return text;
}

int64_t query(const char *path, const char *sql)
{
    char *text = query_text(path, sql);
    int64_t number = strtoll(text, NULL, 10);
    free(text);
    return number;
}

int outsider(const char *path, const char *sql)
{
    sqlite3 *db = look(path);
    sqlite3_exec(db, "PRAGMA foreign_keys = ON", NULL, NULL, NULL);
    int code = sqlite3_exec(db, sql, NULL, NULL, NULL);
    sqlite3_close(db);
    return code;
}

void expect_sound(const char *path)
{
    char *integrity = query_text(path, "PRAGMA integrity_check");
    assert_string_equal(integrity, "ok\n");
    free(integrity);
    assert_int_equal(query(path, "SELECT count(*) FROM pragma_foreign_key_check"), 0);
}
