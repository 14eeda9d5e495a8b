// The protocol language told from its tables (language.h) and a catalogue: for editors, and for people.
//
// Both return a heap string to free, NULL: out of memory. Threads: any.
#ifndef STUDIES_PROTOCOL_SCHEMA_H
#define STUDIES_PROTOCOL_SCHEMA_H

#include "studies/protocol/catalogue.h"

// JSON Schema (draft 2020-12) of a protocol file. It knows keys, types, ranges, words and each mode's
// parameters; not what depends on the file's own names (an option that is not there, a question of the wrong
// type): that is for `fovstudy check`. Written so that the YAML language server, which reads older drafts,
// completes from it too.
char *protocol_schema(const struct catalogue *catalogue);

// The reference page in Markdown: every key by section, then the modes' parameters and the settings of
// rendering.
char *protocol_reference(const struct catalogue *catalogue);

#endif
