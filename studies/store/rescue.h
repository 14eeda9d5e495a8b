// Inside the store room: a study file that is deleted while it is open is not lost, since the system keeps it
// until it is closed.
#ifndef STUDIES_STORE_RESCUE_H
#define STUDIES_STORE_RESCUE_H

#include "studies/store/sql.h"

enum { RESCUE_SUFFIX = 24 };

// All within the store's mutex, outside a transaction.
//
// Where the open file has no name any more: copies it beside itself, once, and tells how the copy is called
// ("study.db" + out_suffix). False: it only has another name, or it could not be copied.
bool rescue_copy(struct store *store, char out_suffix[RESCUE_SUFFIX]);
// Whether the copy now has the file's own name; then the store goes on in it.
bool rescue_returned(struct store *store, struct store_error *error);

#endif
