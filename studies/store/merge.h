// Joins study files of several laboratories, or copies of one, into a new one without counting a session twice.
//
// The same session is recognised by protocol, seed, number, kind, the code it was recorded under, its start and
// the clock and computer of its first segment. Of two copies the one that goes on further is kept, and only
// where every answer and every log row of the other stands in it, in the same order; copies that went on
// differently are refused. A trial that is done in one and invalid in the other was flagged after its answer:
// the copy that has it so goes on further, and it is said. Of a person's attributes the fuller ones hold; two
// values of one attribute are refused, since nothing tells the later one. Which file is named first decides
// none of this. Inputs are only read. Numbers that decide trial orders are kept, so that two laboratories'
// first participants both have number 1.
//
// Refused, with a sentence: a file that cannot be read, is damaged, or is of a newer version; people beside
// simulated observers; several protocols (unless new_protocol); several seeds of one protocol; a code that two
// files have without a session in common (unless a laboratory's name tells them apart); a person that was
// erased from one of two copies (fovstudy forget) and is still in the other; an output that exists.
#ifndef STUDIES_STORE_MERGE_H
#define STUDIES_STORE_MERGE_H

#include <stdbool.h>
#include <stddef.h>

struct store_merge_input {
    const char *path;
    const char *lab; // codes become "LAB-CODE"; NULL: as they are
};

typedef void (*store_merge_say_fn)(void *user, const char *sentence);

struct store_merge_desc {
    const struct store_merge_input *inputs;
    size_t input_count;
    const char *output;     // written beside itself as "OUTPUT.part" and renamed when it is whole
    bool new_protocol;      // sessions of several protocols may share the file
    store_merge_say_fn say; // a sentence for each session that was counted once and each value not taken
    void *user;
};

struct store_merge_counts {
    long long sessions, participants, twice; // in the output; sessions that stood in several inputs
};

// False with a sentence in `error`; nothing is left of the output then. Every session of the output has an
// event "merged" for each time it was taken: JSON with file (its name without folders), sha256 of the file,
// session (its id there), code, lab, program.
bool store_merge(const struct store_merge_desc *desc, struct store_merge_counts *out, char *error,
                 size_t error_size);

#endif
