// The query of views.h.
#include "studies/store/views.h"

#include "studies/store/read_private.h"

#include <math.h>

static char letter(sqlite3_stmt *statement, int column)
{
    const unsigned char *value = sqlite3_column_text(statement, column);
    return value ? (char)value[0] : '\0';
}

static double real(sqlite3_stmt *statement, int column)
{
    return sqlite3_column_type(statement, column) == SQLITE_NULL ? (double)NAN
                                                                 : sqlite3_column_double(statement, column);
}

bool store_read_views(struct store_reader *reader, store_view_fn each, void *user)
{
    static const char sql[] =
        "SELECT t.id, t.test_slot, t.first_shown,"
        " (SELECT l.option FROM exposure l WHERE l.trial_id = t.id AND l.attempt = t.attempt"
        "  ORDER BY l.start_ns DESC, l.id DESC LIMIT 1),"
        " sum(iif(e.option = 'a', coalesce(e.full_end_ns - e.full_start_ns, 0), 0)) / 1e9,"
        " sum(iif(e.option = 'b', coalesce(e.full_end_ns - e.full_start_ns, 0), 0)) / 1e9,"
        " count(e.id) FROM trial t LEFT JOIN exposure e ON e.trial_id = t.id AND e.attempt = t.attempt"
        " GROUP BY t.id ORDER BY t.session_id, t.ordinal";
    reader->error[0] = '\0';
    sqlite3_stmt *s = NULL;
    int code = sqlite3_prepare_v2(reader->db, sql, -1, &s, NULL);
    bool going = code == SQLITE_OK;
    while (going && (code = sqlite3_step(s)) == SQLITE_ROW) {
        bool seen = sqlite3_column_int64(s, 6) > 0;
        struct store_view_row row = {.trial_id = sqlite3_column_int64(s, 0),
                                     .test_slot = letter(s, 1),
                                     .first_shown = letter(s, 2),
                                     .last_shown = letter(s, 3),
                                     .a_s = seen ? real(s, 4) : (double)NAN,
                                     .b_s = seen ? real(s, 5) : (double)NAN};
        going = each(user, &row);
    }
    if (code != SQLITE_DONE && code != SQLITE_ROW) {
        store_reader_fail_sqlite(reader, code);
        going = false;
    }
    sqlite3_finalize(s);
    return going && store_reader_unchanged(reader);
}
