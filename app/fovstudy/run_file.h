// What a study file holds already, before `fovstudy run` adds to it. Does not: write, or make the file.
#ifndef APP_FOVSTUDY_RUN_FILE_H
#define APP_FOVSTUDY_RUN_FILE_H

#include "app/fovstudy/run_study.h"
#include "studies/protocol/protocol.h"

#include <stdbool.h>
#include <stddef.h>

// One file is one study: false with a sentence where its sessions are of other protocols only, or showed other
// scenes, or where it cannot be read. Another text is another protocol, whatever its name.
bool run_file_protocol(const struct run_options *options, const struct protocol *protocol, char *error,
                       size_t error_size);

// Says where an earlier session of the protocol was shown at another size, rate or field of view.
void run_file_remark(const struct run_options *options, const struct protocol *protocol,
                     const struct run_view *view);

enum { RUN_CODE = 32 }; // bytes, with the end
// The code of the i-th of --participants, from 1.
void run_file_code(uint64_t i, char out[RUN_CODE]);
// Which of --participants, out_complete[1..participants], have sessions of the protocol that are all complete.
// Returns how many; 0 also where there is no file yet, or none that can be read: the run then says why.
uint64_t run_file_complete(const struct run_options *options, const char *sha256,
                           bool out_complete[RUN_PARTICIPANTS + 1]);

#endif
