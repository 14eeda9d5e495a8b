// Writing what exclusion rules take out (facts.h reads what they decide from).
#ifndef STUDIES_STORE_EXCLUSIONS_H
#define STUDIES_STORE_EXCLUSIONS_H

#include "studies/store/store.h"

// All or nothing, in one transaction. An exclusion whose target is out already by the same rule, of the same
// set or as planned, is left away, so that applying rules twice changes nothing; out_added: how many were not.
// The events (kind "rules_applied", JSON with "protocol", the hash of the rules' file) say of sessions that
// their rules were applied, also where they took nothing out.
enum store_result store_apply_exclusions(struct store *store, const struct store_exclusion *exclusions,
                                         size_t count, const struct store_event *events, size_t event_count,
                                         size_t *out_added, struct store_error *error);

#endif
