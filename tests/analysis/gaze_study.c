// Writes a study with as much gaze as asked for: gaze_study FILE PEOPLE TRIALS SECONDS GAZE_HZ FRAME_HZ.
// Simulated people, one cell of choices, fixations and saccades along a main sequence of 600 deg/s and 6
// degrees; in every other trial a target at rest, half a degree left of where the eyes are and two metres away.
// FRAME_HZ 0: no frames.
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <sqlite3.h>

struct study {
    sqlite3 *db;
    sqlite3_stmt *gaze, *frame;
    int people, trials;
    double seconds, gaze_hz, frame_hz;
    uint64_t random;
    int64_t gaze_id;
};

static void check(sqlite3 *db, int code)
{
    if (code == SQLITE_OK || code == SQLITE_DONE || code == SQLITE_ROW)
        return;
    fprintf(stderr, "gaze_study: %s\n", sqlite3_errmsg(db));
    exit(1);
}

static void run(struct study *s, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *sql = sqlite3_vmprintf(format, arguments);
    va_end(arguments);
    check(s->db, sqlite3_exec(s->db, sql, NULL, NULL, NULL));
    sqlite3_free(sql);
}

static double uniform(struct study *s)
{
    s->random = s->random * 6364136223846793005U + 1442695040888963407U;
    return (double)(s->random >> 11) / 9007199254740992.0;
}

static void schema(struct study *s)
{
    static char sql[1 << 16];
    FILE *file = fopen(SOURCE_DIR "/studies/store/schema.sql", "r");
    if (!file || fread(sql, 1, sizeof sql - 1, file) == 0) {
        fputs("gaze_study: no schema\n", stderr);
        exit(1);
    }
    fclose(file);
    run(s, "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA foreign_keys = OFF;");
    check(s->db, sqlite3_exec(s->db, sql, NULL, NULL, NULL));
}

// Where the eyes are: at rest for 300 ms, then a saccade whose speed is the main sequence's raised cosine.
struct eyes {
    double from[2], to[2], since, rest, moving;
};

static void look(struct study *s, struct eyes *e, double step, double out[2])
{
    e->since += step;
    if (e->since > e->rest + e->moving) {
        memcpy(e->from, e->to, sizeof e->from);
        for (int i = 0; i < 2; i++)
            e->to[i] = 16 * uniform(s) - 8;
        double amplitude = hypot(e->to[0] - e->from[0], e->to[1] - e->from[1]);
        e->moving = 2 * amplitude / (600 * (1 - exp(-amplitude / 6)));
        e->rest = 0.2 + 0.2 * uniform(s);
        e->since = 0;
    }
    double t = e->since < e->rest ? 0 : (e->since - e->rest) / e->moving;
    double share = t - sin(2 * 3.14159265358979 * t) / (2 * 3.14159265358979);
    for (int i = 0; i < 2; i++)
        out[i] = e->from[i] + share * (e->to[i] - e->from[i]) + 0.05 * (uniform(s) - 0.5);
}

static void write_gaze(struct study *s, int session, int trial, int64_t at_ns, const double where[2],
                       bool valid)
{
    sqlite3_stmt *g = s->gaze;
    sqlite3_bind_int64(g, 1, ++s->gaze_id);
    sqlite3_bind_int(g, 2, session);
    sqlite3_bind_int(g, 3, trial);
    sqlite3_bind_int64(g, 4, at_ns + 12345678);
    sqlite3_bind_int64(g, 5, at_ns);
    if (valid) {
        sqlite3_bind_double(g, 6, where[0]);
        sqlite3_bind_double(g, 7, where[1]);
    } else {
        sqlite3_bind_null(g, 6);
        sqlite3_bind_null(g, 7);
    }
    sqlite3_bind_int(g, 8, valid);
    check(s->db, sqlite3_step(g));
    sqlite3_reset(g);
}

static void write_frame(struct study *s, int session, int trial, int64_t number, int64_t at_ns,
                        const double where[2])
{
    sqlite3_stmt *f = s->frame;
    sqlite3_bind_int(f, 1, session);
    sqlite3_bind_int(f, 2, trial);
    sqlite3_bind_int64(f, 3, number);
    sqlite3_bind_text(f, 4, number / 45 % 2 ? "b" : "a", 1, SQLITE_STATIC);
    sqlite3_bind_int(f, 5, number / 45 % 2 ? 2 : 1);
    sqlite3_bind_int64(f, 6, at_ns);
    sqlite3_bind_double(f, 7, 4000 + 100 * uniform(s));
    sqlite3_bind_int64(f, 8, at_ns + 11000000);
    sqlite3_bind_int64(f, 9, s->gaze_id);
    if (trial % 2) {
        sqlite3_bind_double(f, 10, where[0] + 0.5);
        sqlite3_bind_double(f, 11, where[1]);
    } else {
        sqlite3_bind_null(f, 10);
        sqlite3_bind_null(f, 11);
    }
    check(s->db, sqlite3_step(f));
    sqlite3_reset(f);
}

static void write_trial(struct study *s, int session, int trial, int64_t start_ns, int64_t *frame)
{
    struct eyes eyes = {.rest = 0.3, .since = 0.0, .moving = 0};
    int64_t samples = (int64_t)(s->seconds * s->gaze_hz);
    double where[2], shown = 0;
    for (int64_t i = 0; i < samples; i++) {
        double at = (double)i / s->gaze_hz;
        look(s, &eyes, 1 / s->gaze_hz, where);
        write_gaze(s, session, trial, start_ns + (int64_t)(at * 1e9), where, i % 1000 < 950);
        for (; s->frame_hz > 0 && shown <= at; shown += 1 / s->frame_hz)
            write_frame(s, session, trial, ++*frame, start_ns + (int64_t)(shown * 1e9), where);
    }
}

static void write_person(struct study *s, int person)
{
    int64_t frame = 0;
    run(s,
        "BEGIN; INSERT INTO participant VALUES (%d, %d, 'S%03d', 'simulated', '{\"age\":30}');"
        "INSERT INTO session VALUES (%d, 1, %d, 1, 'complete', '2026-01-01T10:00:00Z', '2026-01-01T11:00:00Z', "
        "NULL,"
        " NULL, 'gpu', 'driver', 'headless', 90, 640, 720, 100, '{\"gaze\":\"sim\",\"ipd_m\":0.063}');"
        "INSERT INTO segment VALUES (%d, %d, '2026-01-01T10:00:00Z', 0, 'simulated', NULL, 'test', 'start');",
        person, person, person, person, person, person, person);
    for (int i = 0; i < s->trials; i++) {
        int trial = (person - 1) * s->trials + i + 1;
        int64_t start_ns = (int64_t)i * ((int64_t)(s->seconds * 1e9) + 1000000000);
        run(s,
            "INSERT INTO trial VALUES (%d, %d, %d, %d, 'main', 'toggle', 'town', '{}', '{\"epsilon\":%s}', 1, "
            "2, 'a',"
            " 'a', '%s', 1, NULL, 'done', 1, %lld, %lld);"
            "INSERT INTO choice VALUES (%d, %d, %d, '%s', NULL, 1000000000, 0, 3);"
            "INSERT INTO exposure VALUES (NULL, %d, %d, 1, 'a', %lld, %lld, %lld, %lld);",
            trial, person, person, i + 1, i % 4 < 2 ? "0.1" : "0.2", trial % 2 ? "cross" : "free", start_ns,
            start_ns + (int64_t)(s->seconds * 1e9), trial, trial, person, uniform(s) < 0.5 ? "a" : "b", trial,
            person, start_ns, start_ns + (int64_t)(s->seconds * 1e9), start_ns,
            start_ns + (int64_t)(s->seconds * 1e9));
        write_trial(s, person, trial, start_ns, &frame);
    }
    run(s, "COMMIT;");
}

int main(int argc, char **argv)
{
    if (argc != 7) {
        fputs("usage: gaze_study FILE PEOPLE TRIALS SECONDS GAZE_HZ FRAME_HZ\n", stderr);
        return 2;
    }
    struct study s = {.people = atoi(argv[2]),
                      .trials = atoi(argv[3]),
                      .seconds = atof(argv[4]),
                      .gaze_hz = atof(argv[5]),
                      .frame_hz = atof(argv[6]),
                      .random = 1};
    remove(argv[1]);
    check(s.db, sqlite3_open(argv[1], &s.db));
    schema(&s);
    run(&s,
        "INSERT INTO protocol VALUES (1, 'large', '%064d', 'large');"
        "INSERT INTO condition VALUES (1, 'time_warped', '{\"epsilon\":0.2}'), (2, 'regular', '{}');",
        1);
    check(s.db,
          sqlite3_prepare_v2(s.db, "INSERT INTO gaze VALUES (?1, ?2, ?2, ?3, ?4, ?5, 'both', ?6, ?7, 3, ?8, 1)",
                             -1, &s.gaze, NULL));
    check(
        s.db,
        sqlite3_prepare_v2(
            s.db,
            "INSERT INTO frame VALUES (NULL, ?1, ?1, ?2, 1, ?3, ?4, ?5, 'stimulus', 0, ?6, 1000, ?7, ?8, 1, 0,"
            " ?9, 2000, '{\"left\":[1.25,2.5],\"right\":[1.5,2.5]}', 'gaze', NULL, ?10, ?11,"
            " '{\"position\":[1,2,3],\"orientation\":[0,0,0,1]}', 100000, 200000, iif(?10 IS NULL, NULL, 2))",
            -1, &s.frame, NULL));
    for (int person = 1; person <= s.people; person++)
        write_person(&s, person);
    sqlite3_finalize(s.gaze);
    sqlite3_finalize(s.frame);
    sqlite3_close(s.db);
    return 0;
}
