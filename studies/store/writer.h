// Inside the store room: the thread that commits what waits in the queue.
#ifndef STUDIES_STORE_WRITER_H
#define STUDIES_STORE_WRITER_H

#include "studies/store/sql.h"

// NULL: the thread could not be started.
struct writer *writer_start(struct store *store, uint32_t flush_ms);
void writer_stop(struct writer *writer); // does not flush; NULL is fine

#endif
