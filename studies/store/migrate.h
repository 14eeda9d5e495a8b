// Inside the store room: which version a file has, and the ladder from older ones to ours.
//
// Adding version N + 1: change schema.sql (and its user_version), raise STORE_VERSION, add the step N -> N + 1.
#ifndef STUDIES_STORE_MIGRATE_H
#define STUDIES_STORE_MIGRATE_H

#include "studies/store/sql.h"

enum {
    STORE_VERSION = 2,
    STORE_APPLICATION_ID = 0x46565354, // "FVST"
};

struct migrate_ladder {
    int version;              // of new files
    const char *schema;       // makes a new file; sets application_id and user_version
    const char *const *steps; // version - 1 texts; steps[i] leads from version i + 1 to i + 2
};

enum migrate_state {
    MIGRATE_EMPTY,   // no table: never used
    MIGRATE_CURRENT, // ours, as the ladder's schema makes it
    MIGRATE_OLDER,   // ours, and the ladder leads up
};

// Of a file of `version`, what to select from its frames so that they have the columns of ours.
const char *migrate_frame_columns(int version);

// Looks without writing. Refuses another program's database and a newer version.
enum store_result migrate_identify(struct store *store, const struct migrate_ladder *ladder,
                                   enum migrate_state *out_state, struct store_error *error);

// Makes an empty or older file current, in one transaction; a failure leaves it as it was.
enum store_result migrate_apply(struct store *store, const struct migrate_ladder *ladder,
                                enum migrate_state state, struct store_error *error);

// Refuses a file whose tables are not those of the schema (cut off by other tools, damaged).
enum store_result migrate_check_tables(struct store *store, const struct migrate_ladder *ladder,
                                       struct store_error *error);

#endif
