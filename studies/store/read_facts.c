// The facts of facts.h: per trial one query on its exposures, one pass over its gaze, one query on its frames.
#include "studies/store/facts.h"

#include "studies/store/read_private.h"

#include <math.h>
#include <string.h>

// Two stretches of a stimulus at most this far apart are one: a fade is gray for a quarter of a second, a
// sequential trial for half a second; a pause is longer, or short enough not to matter.
#define FACTS_JOIN_NS 1000000000

enum { FACTS_STRETCHES = 512 }; // of one trial; a participant who switches more often is measured up to here

// Modes that draw every pixel alike: where the fovea is does not matter to them.
#define UNFOVEATED "('regular', 'ray_traced_full')"

// A trial's rows lie together, so that they are read as one range of ids and not one by one through the index.
#define RANGE(table)                                                                                           \
    "id BETWEEN (SELECT id FROM " table " WHERE trial_id = ?1 ORDER BY id LIMIT 1) AND"                        \
    " (SELECT id FROM " table " WHERE trial_id = ?1 ORDER BY id DESC LIMIT 1) AND +trial_id = ?1"

static const char trials_sql[] =
    "SELECT t.id, t.session_id, t.ordinal, t.block, t.kind, EXISTS (SELECT 1 FROM rating WHERE trial_id = "
    "t.id),"
    " t.option_a IS NOT NULL, t.option_b IS NOT NULL, c.reaction_ns / 1e9,"
    " t.kind = 'catch' AND c.id IS NOT NULL AND (c.correct IS NOT NULL OR c.chosen = 'equal' OR t.test_slot IS "
    "NOT NULL),"
    " CASE WHEN t.kind <> 'catch' OR c.id IS NULL THEN 0 WHEN c.correct IS NOT NULL THEN c.correct = 0"
    "  ELSE c.chosen = 'equal' OR c.chosen = t.test_slot END,"
    " coalesce(s.settings ->> '$.gaze', 'none') <> 'none',"
    " coalesce(t.settings ->> '$.foveate', 'gaze') = 'gaze', t.segment_id, t.attempt"
    " FROM trial t JOIN session s ON s.id = t.session_id LEFT JOIN choice c ON c.trial_id = t.id"
    " WHERE s.participant_id = ?1 AND s.protocol_id = ?2 AND t.status = 'done' AND t.kind <> 'practice'"
    " ORDER BY t.session_id, t.ordinal";
static const char exposures_sql[] =
    "SELECT option = 'b', start_ns, end_ns, full_end_ns - full_start_ns FROM exposure"
    " WHERE trial_id = ?1 AND attempt = ?2 ORDER BY start_ns, id";
static const char gaze_sql[] =
    "SELECT host_ns, valid FROM gaze WHERE " RANGE("gaze") " AND segment_id = ?2 ORDER BY id";
static const char frames_sql[] =
    "SELECT count(late) FILTER (WHERE phase = 'stimulus'), total(late) FILTER (WHERE phase = 'stimulus'),"
    " count(condition_id), total(condition_id IS NOT NULL AND"
    "  ((" NOT_AS_ASKED(
        "frame.") " AND (condition_id IN foveated OR effective ->> '$.fovea' IS NULL))"
                  "   OR (?3 AND fovea_source IN ('fixed', 'lost') AND condition_id IN foveated)))"
                  " FROM frame WHERE " RANGE("frame") " AND attempt = ?2";
static const char foveated_sql[] =
    "WITH foveated AS (SELECT id FROM condition WHERE mode NOT IN " UNFOVEATED ") ";

enum part { TRIALS, EXPOSURES, GAZE, FRAMES, PARTS };

struct trial_keys {
    int64_t id, segment, attempt;
    bool tracker, by_gaze;
};

struct stretch {
    int64_t start_ns, end_ns;
};

struct facts {
    struct store_reader *reader;
    sqlite3_stmt *statements[PARTS];
    struct stretch stretches[FACTS_STRETCHES];
    size_t stretch_count;
};

static bool prepare(struct facts *facts)
{
    static const char *const texts[PARTS] = {trials_sql, exposures_sql, gaze_sql, NULL};
    for (int part = 0; part < PARTS; part++) {
        char *frames = texts[part] ? NULL : sqlite3_mprintf("%s%s", foveated_sql, frames_sql);
        const char *sql = texts[part] ? texts[part] : frames;
        int code =
            sql ? sqlite3_prepare_v2(facts->reader->db, sql, -1, &facts->statements[part], NULL) : SQLITE_NOMEM;
        sqlite3_free(frames);
        if (code != SQLITE_OK) {
            store_reader_fail_sqlite(facts->reader, code);
            return false;
        }
    }
    return true;
}

static sqlite3_stmt *bind(struct facts *facts, enum part part, int64_t first, int64_t second, int64_t third)
{
    sqlite3_stmt *statement = facts->statements[part];
    sqlite3_reset(statement);
    sqlite3_bind_int64(statement, 1, first);
    sqlite3_bind_int64(statement, 2, second);
    if (part == FRAMES)
        sqlite3_bind_int64(statement, 3, third);
    return statement;
}

// False where a step neither gave a row nor the end.
static bool ended(struct facts *facts, int code)
{
    if (code == SQLITE_DONE)
        return true;
    store_reader_fail_sqlite(facts->reader, code);
    return false;
}

// Seconds without fade, and the stretches of the stimulus.
static bool add_exposures(struct facts *facts, const struct trial_keys *trial, struct store_fact_row *row)
{
    sqlite3_stmt *s = bind(facts, EXPOSURES, trial->id, trial->attempt, 0);
    int64_t seen[2] = {0, 0}, rows = 0;
    int code;
    facts->stretch_count = 0;
    while ((code = sqlite3_step(s)) == SQLITE_ROW) {
        struct stretch stretch = {sqlite3_column_int64(s, 1), sqlite3_column_int64(s, 2)};
        struct stretch *last = facts->stretch_count ? &facts->stretches[facts->stretch_count - 1] : NULL;
        seen[sqlite3_column_int(s, 0)] += sqlite3_column_int64(s, 3); // NULL, never full, counts 0
        rows++;
        if (last && stretch.start_ns - last->end_ns <= FACTS_JOIN_NS)
            last->end_ns = stretch.end_ns > last->end_ns ? stretch.end_ns : last->end_ns;
        else if (facts->stretch_count < FACTS_STRETCHES)
            facts->stretches[facts->stretch_count++] = stretch;
    }
    for (int slot = 0; slot < 2; slot++)
        row->seen_s[slot] = rows == 0 || isnan(row->seen_s[slot]) ? (double)NAN : (double)seen[slot] / 1e9;
    return ended(facts, code);
}

// Samples of the stimulus, those without a direction, and the longest time without one.
struct gaze_pass {
    const struct facts *facts;
    size_t stretch;   // the one that times have reached
    int64_t valid_ns; // of the last sample with a direction; INT64_MIN: none yet
    int64_t gap_ns, samples, lost;
};

static void widen_gap(struct gaze_pass *pass, int64_t from_ns, int64_t to_ns)
{
    if (to_ns - from_ns > pass->gap_ns)
        pass->gap_ns = to_ns - from_ns;
}

static int64_t later(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static void take_sample(struct gaze_pass *pass, int64_t at_ns, bool valid)
{
    const struct facts *facts = pass->facts;
    while (pass->stretch < facts->stretch_count && at_ns > facts->stretches[pass->stretch].end_ns) {
        const struct stretch *over = &facts->stretches[pass->stretch++];
        widen_gap(pass, later(over->start_ns, pass->valid_ns), over->end_ns);
    }
    bool inside = pass->stretch < facts->stretch_count && at_ns >= facts->stretches[pass->stretch].start_ns;
    pass->samples += inside;
    pass->lost += inside && !valid;
    if (inside && valid)
        widen_gap(pass, later(facts->stretches[pass->stretch].start_ns, pass->valid_ns), at_ns);
    if (valid)
        pass->valid_ns = at_ns;
}

static bool add_gaze(struct facts *facts, const struct trial_keys *trial, struct store_fact_row *row)
{
    struct gaze_pass pass = {.facts = facts, .valid_ns = INT64_MIN};
    row->gaze_gap_ms = NAN;
    if (!trial->tracker || facts->stretch_count == 0)
        return true;
    sqlite3_stmt *s = bind(facts, GAZE, trial->id, trial->segment, 0);
    int code;
    while ((code = sqlite3_step(s)) == SQLITE_ROW)
        take_sample(&pass, sqlite3_column_int64(s, 0), sqlite3_column_int(s, 1));
    take_sample(&pass, INT64_MAX, false); // closes the stretches that are left
    row->gaze_samples = pass.samples;
    row->gaze_lost = pass.lost;
    row->gaze_gap_ms = (double)pass.gap_ns / 1e6;
    return ended(facts, code);
}

static bool add_frames(struct facts *facts, const struct trial_keys *trial, struct store_fact_row *row)
{
    sqlite3_stmt *s = bind(facts, FRAMES, trial->id, trial->attempt, trial->by_gaze);
    int code = sqlite3_step(s);
    if (code != SQLITE_ROW) {
        store_reader_fail_sqlite(facts->reader, code);
        return false;
    }
    row->stimulus_frames = sqlite3_column_int64(s, 0);
    row->late_frames = sqlite3_column_int64(s, 1);
    row->rendered_frames = sqlite3_column_int64(s, 2);
    row->fallback_frames = sqlite3_column_int64(s, 3);
    return true;
}

static bool take_trial(struct facts *facts, store_fact_fn each, void *user)
{
    sqlite3_stmt *s = facts->statements[TRIALS];
    const unsigned char *block = sqlite3_column_text(s, 3), *kind = sqlite3_column_text(s, 4);
    struct trial_keys trial = {.id = sqlite3_column_int64(s, 0),
                               .segment = sqlite3_column_int64(s, 13),
                               .attempt = sqlite3_column_int64(s, 14),
                               .tracker = sqlite3_column_int(s, 11),
                               .by_gaze = sqlite3_column_int(s, 12)};
    struct store_fact_row row = {
        .trial_id = trial.id,
        .session_id = sqlite3_column_int64(s, 1),
        .ordinal = sqlite3_column_int64(s, 2),
        .block = block ? (const char *)block : "",
        .kind = kind ? (const char *)kind : "",
        .rated = sqlite3_column_int(s, 5),
        .seen_s = {sqlite3_column_int(s, 6) ? 0 : (double)NAN, sqlite3_column_int(s, 7) ? 0 : (double)NAN},
        .reaction_s = sqlite3_column_type(s, 8) == SQLITE_NULL ? (double)NAN : sqlite3_column_double(s, 8),
        .caught = sqlite3_column_int(s, 9),
        .missed = sqlite3_column_int(s, 10),
    };
    return add_exposures(facts, &trial, &row) && add_gaze(facts, &trial, &row) &&
           add_frames(facts, &trial, &row) && each(user, &row);
}

bool store_read_facts(struct store_reader *reader, int64_t participant_id, int64_t protocol_id,
                      store_fact_fn each, void *user)
{
    struct facts facts = {.reader = reader};
    reader->error[0] = '\0';
    bool going = prepare(&facts);
    if (going) {
        sqlite3_stmt *trials = bind(&facts, TRIALS, participant_id, protocol_id, 0);
        int code;
        while (going && (code = sqlite3_step(trials)) == SQLITE_ROW)
            going = take_trial(&facts, each, user);
        going = going && ended(&facts, code);
    }
    for (int part = 0; part < PARTS; part++)
        sqlite3_finalize(facts.statements[part]);
    return going && store_reader_unchanged(reader);
}
