// Applies a protocol's exclusion rules to sessions of a study file: facts from the store, verdicts from the
// engine, rows back into the store. Applying them again changes nothing.
#ifndef APP_FOVSTUDY_RULES_H
#define APP_FOVSTUDY_RULES_H

#include "studies/protocol/protocol.h"
#include "studies/store/facts.h"
#include "studies/store/store.h"

#include <stdbool.h>
#include <stddef.h>

#define RULES_BY "fovstudy " FOVSTUDY_VERSION

struct rules {
    struct store *store; // open for writing
    const char *path;    // of its file
    const struct protocol *protocol;
    bool late; // made after the data was seen: marked so; rules of the set 'stricter' are left away
};

// A session whose rules are to be applied, and its last segment.
struct rules_session {
    int64_t session_id, segment_id, participant_id, protocol_id;
};

// `sessions` are of one person and one protocol row; the facts are those of all the person's sessions under it.
bool rules_apply(const struct rules *rules, struct store_reader *reader, const struct rules_session *sessions,
                 size_t count, size_t *out_added, char *error, size_t error_size);

// At the end of a session: what it pushed is committed first. False with a sentence; `fovstudy exclude` makes
// up for it later.
bool rules_end_session(struct store *store, const char *path, const struct protocol *protocol,
                       const struct store_session_ids *ids, char *error, size_t error_size);

#endif
