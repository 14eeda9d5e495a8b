// The keys of a protocol file: one table each section, from which the reader knows what it takes, and from
// which the schema for editors and the reference page are made. A key that is not here is not read.
#ifndef STUDIES_PROTOCOL_LANGUAGE_H
#define STUDIES_PROTOCOL_LANGUAGE_H

#include <stdbool.h>
#include <stdint.h>

enum language_type {
    LANGUAGE_NAME, // letters, digits, _ and -
    LANGUAGE_TEXT,
    LANGUAGE_NUMBER,
    LANGUAGE_INTEGER,
    LANGUAGE_SECONDS,
    LANGUAGE_WORD,   // one of words
    LANGUAGE_NAMES,  // a name, or a list of names
    LANGUAGE_LIST,   // of what `of` names, or of `items`; or, where `words` are given, one of them
    LANGUAGE_MAP,    // the section `of`
    LANGUAGE_TABLE,  // names of the file's own, each with the section `of`, or with a name
    LANGUAGE_VARIANT // a list of plain values, or a table of the section `of`
};

// What may stand in the place of a whole section.
enum language_short {
    LANGUAGE_NO_SHORT,
    LANGUAGE_SHORT_NAME,  // its name alone
    LANGUAGE_SHORT_VALUES // a list of values
};

struct language_key {
    const char *name;
    enum language_type type;
    bool required;
    double min, max; // of numbers, inclusive; of lists and tables: entries
    const char *const *words;
    const char *of;            // title of a section
    const char *unit;          // of numbers; NULL: none
    const char *fallback;      // the default, as people read it; NULL: none
    const char *about;         // one sentence
    const char *example;       // as it stands in a file, in one line
    enum language_type items;  // of a list of plain values
    double item_min, item_max; // inclusive
};

struct language_section {
    const char *title; // in errors: "in the block, key ..."
    const char *about;
    const struct language_key *keys; // ends with a NULL name
    bool open;                       // further keys are parameters of a mode, or settings of the renderer
    enum language_short shorthand;
};

extern const struct language_section language_protocol, language_scene, language_option, language_settings,
    language_fade, language_question, language_consent, language_attribute, language_analysis,
    language_exclusion, language_block, language_factor, language_level, language_catch, language_adjust,
    language_staircase, language_model, language_grid, language_parameters;
extern const struct language_section
    *const language_sections[]; // all, in the order of the reference page; NULL ends

const struct language_key *language_find(const struct language_section *section, const char *key); // NULL: none

#endif
