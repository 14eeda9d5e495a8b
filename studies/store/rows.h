// Inside the store room: writes the queue's span as rows, within a transaction.
#ifndef STUDIES_STORE_ROWS_H
#define STUDIES_STORE_ROWS_H

#include "studies/store/sql.h"

// A row that breaks a rule of the schema is left out, counted in the span and reported by an event; drops are
// reported by an event. Only what stops all writing (disk full, ...) is a failure.
enum store_result rows_write(struct store *store, struct store_error *error);

// The columns of `event` in the statement's order.
enum { ROWS_EVENT_COLUMNS = 6 };
void rows_event(const struct store_event *event, const char *kind, const char *detail,
                struct sql_value out[ROWS_EVENT_COLUMNS]);

#endif
