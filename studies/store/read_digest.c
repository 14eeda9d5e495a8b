#include "studies/store/digest.h"

#include "studies/protocol/sha256.h"
#include "studies/store/read_private.h"
#include "studies/store/sitting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RECORDED_CODE SITTING_CODE("main", "session", "participant")

// ?1 is the session. Columns and orders are part of the digest: changing one changes every digest.
static const char *const queries[] = {
    "SELECT protocol.name, protocol.sha256, " RECORDED_CODE ", number, kind, attributes, seed, status, "
    "started_at, ended_at, device, driver, display, refresh_hz, width_px, height_px, fov_deg, session.settings "
    "FROM session JOIN protocol ON protocol.id = protocol_id JOIN participant ON participant.id = "
    "participant_id WHERE session.id = ?1",
    "SELECT started_at, clock, app_version, reason FROM segment WHERE session_id = ?1 ORDER BY segment.id",
    "SELECT trial.ordinal, trial.block, trial.kind, trial.scene, trial.settings, trial.factors, a.mode, "
    "a.parameters, b.mode, b.parameters, trial.test_slot, trial.first_shown, trial.fixation, trial.seed, "
    "repeated.ordinal, trial.status, trial.attempt, trial.started_ns, trial.ended_ns FROM trial "
    "LEFT JOIN condition a ON a.id = trial.option_a LEFT JOIN condition b ON b.id = trial.option_b "
    "LEFT JOIN trial repeated ON repeated.id = trial.repeat_of "
    "WHERE trial.session_id = ?1 ORDER BY trial.ordinal",
    "SELECT ordinal, chosen, correct, reaction_ns, answered_ns, toggles FROM choice "
    "JOIN trial ON trial.id = trial_id WHERE trial.session_id = ?1 ORDER BY ordinal",
    "SELECT ordinal, question, subject, mode, parameters, value, scale_min, scale_max, answered_ns FROM rating "
    "LEFT JOIN trial ON trial.id = rating.trial_id LEFT JOIN condition ON condition.id = condition_id "
    "WHERE rating.session_id = ?1 OR rating.trial_id IN (SELECT id FROM trial WHERE session_id = ?1) "
    "ORDER BY ordinal, question, subject, answered_ns, value",
    "SELECT ordinal, question, value, expected, answered_ns, response.device FROM response "
    "JOIN trial ON trial.id = trial_id WHERE trial.session_id = ?1 ORDER BY ordinal, question",
    "SELECT ordinal, level, outcome, reversal, estimate FROM staircase_step "
    "JOIN trial ON trial.id = trial_id WHERE trial.session_id = ?1 ORDER BY ordinal, staircase_step.id",
    "SELECT at_ns, block, x_deg, y_deg, eye, accuracy_deg, rms_s2s_deg, sd_deg, loss, passed FROM gaze_check "
    "WHERE session_id = ?1 ORDER BY gaze_check.segment_id, at_ns, x_deg, y_deg, eye",
    "SELECT ordinal, exclusion.session_id IS NOT NULL, exclusion.participant_id IS NOT NULL, rule, rule_set, "
    "reason, \"by\", applied_at FROM exclusion LEFT JOIN trial ON trial.id = exclusion.trial_id "
    "WHERE exclusion.session_id = ?1 OR exclusion.participant_id = (SELECT participant_id FROM session WHERE "
    "id = ?1) OR exclusion.trial_id IN (SELECT id FROM trial WHERE session_id = ?1) "
    "ORDER BY ordinal, 2, 3, rule, rule_set, reason, \"by\", applied_at",
};

static void write_value(FILE *out, sqlite3_stmt *statement, int column)
{
    switch (sqlite3_column_type(statement, column)) {
    case SQLITE_NULL:
        fputs("n;", out);
        return;
    case SQLITE_INTEGER:
        fprintf(out, "i%lld;", (long long)sqlite3_column_int64(statement, column));
        return;
    case SQLITE_FLOAT:
        fprintf(out, "r%a;", sqlite3_column_double(statement, column)); // every bit
        return;
    default: { // the text before its size: SQLite converts first
        const unsigned char *text = sqlite3_column_text(statement, column);
        int size = sqlite3_column_bytes(statement, column);
        fprintf(out, "t%d:", size);
        if (text)
            fwrite(text, 1, (size_t)size, out);
    }
    }
}

static bool write_rows(struct store_reader *reader, const char *sql, int64_t session_id, FILE *out)
{
    sqlite3_stmt *statement = NULL;
    int code = sqlite3_prepare_v2(reader->db, sql, -1, &statement, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_bind_int64(statement, 1, session_id);
    while (code == SQLITE_OK || code == SQLITE_ROW) {
        code = sqlite3_step(statement);
        if (code != SQLITE_ROW)
            break;
        for (int i = 0; i < sqlite3_column_count(statement); i++)
            write_value(out, statement, i);
        fputc('\n', out);
    }
    if (code != SQLITE_DONE)
        store_reader_fail_sqlite(reader, code);
    sqlite3_finalize(statement);
    return code == SQLITE_DONE;
}

bool store_session_digest(struct store_reader *reader, int64_t session_id, char out[STORE_DIGEST_HEX])
{
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    bool ok = memory != NULL;
    reader->error[0] = '\0';
    for (size_t i = 0; ok && i < sizeof queries / sizeof queries[0]; i++) {
        fprintf(memory, "query %zu\n", i);
        ok = write_rows(reader, queries[i], session_id, memory);
    }
    if (memory && (ferror(memory) | fclose(memory)) != 0)
        ok = false;
    if (ok) {
        uint8_t digest[SHA256_BYTES];
        sha256(text, size, digest);
        sha256_hex(digest, out);
    } else if (!reader->error[0]) {
        store_reader_fail(reader, "%s: not enough memory", reader->path);
    }
    free(text);
    return ok && store_reader_unchanged(reader);
}

static int by_text(const void *a, const void *b)
{
    return strcmp(a, b);
}

bool store_digests_join(char (*digests)[STORE_DIGEST_HEX], size_t count, char out[STORE_DIGEST_HEX])
{
    qsort(digests, count, sizeof *digests, by_text);
    char *text = malloc(count * STORE_DIGEST_HEX + 1);
    if (!text)
        return false;
    for (size_t i = 0; i < count; i++) {
        memcpy(text + i * STORE_DIGEST_HEX, digests[i], STORE_DIGEST_HEX - 1);
        text[(i + 1) * STORE_DIGEST_HEX - 1] = '\n';
    }
    uint8_t digest[SHA256_BYTES];
    sha256(text, count * STORE_DIGEST_HEX, digest);
    sha256_hex(digest, out);
    free(text);
    return true;
}
