// A person's attributes in two files. Nothing tells which of two values is the later one, so that such people
// are refused; where one file has all that the other has, it holds. Neither depends on the order of the files.
#include "studies/store/merge_private.h"

#include <stdio.h>

#define BOTH                                                                                                   \
    "FROM temp.people AS i JOIN src.participant AS s ON s.id = i.old JOIN main.participant AS p ON p.id = "    \
    "i.new "
#define LACKS(some, other)                                                                                     \
    "EXISTS (SELECT key FROM json_each(" some ".attributes) EXCEPT SELECT key FROM json_each(" other           \
    ".attributes))"

static bool refuse_values(struct merging *m, sqlite3_stmt *row)
{
    return merge_fail(
        m,
        "%s: participant %s has %s %s here and %s in another file; correct the one that is wrong, "
        "then merge",
        m->input->path, (const char *)sqlite3_column_text(row, 0), (const char *)sqlite3_column_text(row, 1),
        (const char *)sqlite3_column_text(row, 2), (const char *)sqlite3_column_text(row, 3));
}

static bool refuse_names(struct merging *m, sqlite3_stmt *row)
{
    return merge_fail(m,
                      "%s: participant %s has an attribute here that another file lacks, and the other way "
                      "round; make them the same in both, then merge",
                      m->input->path, (const char *)sqlite3_column_text(row, 0));
}

static bool say_fuller(struct merging *m)
{
    static const char sql[] =
        "SELECT s.code, " LACKS("s", "p") " " BOTH
                                          "WHERE " LACKS("s", "p") " OR " LACKS("p", "s") " ORDER BY s.id";
    sqlite3_stmt *row = NULL;
    int code = sqlite3_prepare_v2(m->db, sql, -1, &row, NULL);
    while ((code == SQLITE_OK || code == SQLITE_ROW) && (code = sqlite3_step(row)) == SQLITE_ROW)
        merge_say(m,
                  "%s: participant %s has %s attributes here than in another file; the fuller ones were taken",
                  m->input->path, (const char *)sqlite3_column_text(row, 0),
                  sqlite3_column_int(row, 1) ? "more" : "fewer");
    bool ok = code == SQLITE_DONE || merge_fail_sqlite(m);
    sqlite3_finalize(row);
    return ok;
}

bool merge_attributes(struct merging *m)
{
    static const char values[] =
        "SELECT s.code, a.key, coalesce(a.value, 'null'), coalesce(b.value, 'null') " BOTH
        "JOIN json_each(s.attributes) AS a JOIN json_each(p.attributes) AS b ON b.key = a.key WHERE a.value IS "
        "NOT b.value ORDER BY s.id, a.id LIMIT 1";
    static const char names[] =
        "SELECT s.code " BOTH "WHERE " LACKS("s", "p") " AND " LACKS("p", "s") " LIMIT 1";
    // Of two spellings of the same the first in the alphabet, whichever file comes first.
    static const char take[] =
        "UPDATE main.participant AS p SET attributes = s.attributes FROM temp.people AS i JOIN src.participant "
        "AS s ON s.id = i.old WHERE i.new = p.id AND (" LACKS("s", "p") " OR (NOT " LACKS(
            "p", "s") " AND "
                      "s.attributes < p.attributes))";
    return merge_none(m, values, refuse_values) && merge_none(m, names, refuse_names) && say_fuller(m) &&
           merge_run(m, take);
}
