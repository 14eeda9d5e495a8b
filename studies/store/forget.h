// Erases a person from a study file.
//
// Use: store_open -> store_forget. Does not: touch other files (event lines, exports, copies).
#ifndef STUDIES_STORE_FORGET_H
#define STUDIES_STORE_FORGET_H

#include "studies/store/store.h"

struct store_forgotten {
    int64_t number, sessions, trials, answers, frames, gaze; // rows that were erased
};

// Every row of the code's sessions goes. What stays is a participant row without a code of its own
// ("forgotten-ID"), without attributes and without sessions, and an exclusion of rule "forgotten": the number
// may be given again, and a count of participants stays explainable. The file is then rewritten (VACUUM) and
// its log emptied, so that no byte of it is left in either; that needs as much room as the file has, and nobody
// reading it. Where the rewriting fails the rows are gone but their bytes may not be: STORE_FAILED, and the
// same call (of any code) finishes it.
enum store_result store_forget(struct store *store, const char *code, const char *applied_at,
                               struct store_forgotten *out, struct store_error *error);

#endif
