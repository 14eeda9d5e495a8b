// SQL by which a sitting is known in whatever file it stands: inside the store room only. `schema` is "main" or
// the name of an attached file.
#ifndef STUDIES_STORE_SITTING_H
#define STUDIES_STORE_SITTING_H

// A session's code as it was recorded: a merge may have put a laboratory before it. The aliases of the session
// and of its participant.
#define SITTING_CODE(schema, session, person)                                                                  \
    "coalesce((SELECT detail ->> '$.code' FROM " schema ".event WHERE session_id = " session                   \
    ".id AND kind = 'merged' ORDER BY id LIMIT 1), " person ".code)"

// A text that two copies of a sitting share and no two sittings: protocol, seed, number, kind, recorded code,
// begin, and the clock and computer of its first segment. Of the session s, its protocol o and participant p.
#define SITTING(schema)                                                                                        \
    "json_array(o.sha256, s.seed, p.number, p.kind, " SITTING_CODE(                                            \
        schema, "s", "p") ", s.started_at) || coalesce((SELECT json_array(g.started_at, g.mono_origin_ns, "    \
                          "g.boot_id) FROM " schema ".segment AS g WHERE g.session_id = s.id ORDER BY g.id "   \
                          "LIMIT 1), '')"

#endif
