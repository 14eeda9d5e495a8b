// participants.tsv, a column for each attribute the protocols asked for, and the sessions of each person.
#include "analysis/report/sample.h"
#include "analysis/tools/bids_private.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char *const fixed[] = {"participant_id",   "participant_code", "participant_number",
                                    "participant_kind", "excluded",         "excluded_stricter",
                                    "excluded_rules"};
enum { FIXED = sizeof fixed / sizeof fixed[0] };

struct value {
    size_t person, key;
    char *text;
};

struct people {
    struct bids *bids;
    char **keys;
    struct value *values;
    size_t key_count, value_count, at;
    FILE *out;
};

static size_t person_of(const struct bids *b, const char *code)
{
    size_t i = 0;
    while (i < b->people.count && strcmp(b->people.items[i].text, code) != 0)
        i++;
    return i;
}

static bool has_session(const struct bids *b, size_t person)
{
    for (size_t i = 0; i < b->session_count; i++)
        if (b->sessions[i].person == person)
            return true;
    return false;
}

static size_t key_of(struct people *p, const char *text)
{
    size_t i = 0;
    while (i < p->key_count && strcmp(p->keys[i], text) != 0)
        i++;
    if (i < p->key_count)
        return i;
    if (!sample_grow(&p->keys, p->key_count, sizeof *p->keys) || !(p->keys[i] = strdup(text)))
        return SIZE_MAX;
    p->key_count++;
    return i;
}

static bool add_value(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct people *p = user;
    if (header)
        return true;
    size_t key = key_of(p, cell_text(cells, count, "attribute"));
    if (key == SIZE_MAX || !sample_grow(&p->values, p->value_count, sizeof *p->values))
        return false;
    char *text = strdup(cell_text(cells, count, "attribute_value"));
    if (!text)
        return false;
    p->values[p->value_count++] =
        (struct value){person_of(p->bids, cell_text(cells, count, "participant_id")), key, text};
    return true;
}

// An attribute must not stand under a name that means something else.
static const char *column_of(const char *key, char out[256])
{
    bool other = key[0] == '\0';
    for (size_t i = 0; i < FIXED; i++)
        other = other || strcmp(key, fixed[i]) == 0;
    snprintf(out, 256, "%s%s", other ? "attribute_" : "", key);
    for (char *c = out; *c; c++)
        if (strchr("\t\r\n", *c))
            *c = ' ';
    return out;
}

static bool write_person(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct people *p = user;
    char text[256];
    if (header) {
        for (size_t i = 0; i < FIXED; i++)
            fprintf(p->out, "%s%s", i ? "\t" : "", fixed[i]);
        for (size_t i = 0; i < p->key_count; i++)
            fprintf(p->out, "\t%s", column_of(p->keys[i], text));
        fputc('\n', p->out);
        return true;
    }
    size_t person = person_of(p->bids, cell_text(cells, count, "participant_id"));
    if (!has_session(p->bids, person)) // BIDS lists subjects that have a folder
        return true;
    p->bids->counts.participants++;
    fprintf(p->out, "sub-%s", p->bids->people.items[person].label);
    static const char *const columns[] = {"participant_id", "participant_number", "participant_kind",
                                          "excluded",       "excluded_stricter",  "excluded_rules"};
    for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++) {
        fputc('\t', p->out);
        cell_write_tsv(p->out, cell_find(cells, count, columns[i]));
    }
    for (size_t key = 0; key < p->key_count; key++) {
        struct store_cell cell = {.kind = STORE_CELL_NONE};
        for (size_t i = 0; i < p->value_count; i++)
            if (p->values[i].person == person && p->values[i].key == key)
                cell = (struct store_cell){.kind = STORE_CELL_TEXT, .text = p->values[i].text};
        fputc('\t', p->out);
        cell_write_tsv(p->out, &cell);
    }
    fputc('\n', p->out);
    return true;
}

static bool describe_people(struct people *p)
{
    FILE *out = bids_open(p->bids, "participants.json");
    if (!out)
        return false;
    struct json json = {out, false};
    json_open(&json, NULL, '{');
    json_open(&json, "participant_code", '{');
    json_text(&json, "Description",
              "The participant's code in the study; participant_id is its letters and digits.");
    json_close(&json, '}');
    bids_describe(p->bids, &json, fixed + 2, FIXED - 2);
    for (size_t i = 0; i < p->key_count; i++) {
        char text[256];
        json_open(&json, column_of(p->keys[i], text), '{');
        json_text(&json, "Description",
                  strcmp(p->keys[i], "age") == 0
                      ? "The participant's age as told."
                      : "What the participant said to this question of the protocol; may be free text.");
        if (strcmp(p->keys[i], "age") == 0)
            json_text(&json, "Units", "year");
        json_close(&json, '}');
    }
    json_close(&json, '}');
    fputc('\n', out);
    return bids_close(p->bids, out, "participants.json");
}

bool bids_write_people(struct bids *b)
{
    struct people p = {.bids = b};
    bool ok = bids_read(b, "attributes", add_value, &p) && (p.out = bids_open(b, "participants.tsv"));
    if (ok) {
        ok = bids_read(b, "participants", write_person, &p);
        ok = bids_close(b, p.out, "participants.tsv") && ok;
    }
    ok = ok && describe_people(&p);
    for (size_t i = 0; i < p.key_count; i++)
        free(p.keys[i]);
    for (size_t i = 0; i < p.value_count; i++)
        free(p.values[i].text);
    free(p.keys);
    free(p.values);
    return ok;
}
