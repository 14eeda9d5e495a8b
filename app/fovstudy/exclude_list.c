#include "app/fovstudy/exclude_list.h"

#include "app/command/json.h"
#include "studies/store/facts.h"

#include <inttypes.h>
#include <stdio.h>

struct listing {
    bool json;
    size_t rows;
};

static void print_json(const struct store_excluded_row *row, bool first)
{
    const struct {
        const char *key, *value;
    } texts[] = {{"participant", row->code}, {"rule", row->rule}, {"rule_set", row->rule_set},
                 {"reason", row->reason},    {"by", row->by},     {"applied_at", row->applied_at}};
    printf("%s\n{\"what\":\"%s\"", first ? "" : ",",
           row->trial_id     ? "trial"
           : row->session_id ? "session"
                             : "person");
    if (row->trial_id)
        printf(",\"trial\":%" PRId64 ",\"ordinal\":%" PRId64, row->trial_id, row->ordinal);
    if (row->session_id)
        printf(",\"session\":%" PRId64, row->session_id);
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        json_key(stdout, texts[i].key, false);
        json_string(stdout, texts[i].value);
    }
    putchar('}');
}

static bool print_row(void *user, const struct store_excluded_row *row)
{
    struct listing *listing = user;
    char what[64] = "the person";
    if (row->trial_id)
        snprintf(what, sizeof what, "trial %" PRId64 " (place %" PRId64 ")", row->trial_id, row->ordinal);
    else if (row->session_id)
        snprintf(what, sizeof what, "session %" PRId64, row->session_id);
    if (listing->json)
        print_json(row, listing->rows == 0);
    else
        printf("%-12s %-24s %-26s %-9s %s (%s, %s)\n", row->code, what, row->rule, row->rule_set, row->reason,
               row->by, row->applied_at);
    listing->rows++;
    return true;
}

bool exclude_list(const char *path, bool json, char *error, size_t error_size)
{
    struct listing listing = {.json = json};
    struct store_reader *reader = store_reader_open(path, error, error_size);
    if (!reader)
        return false;
    if (json)
        putchar('[');
    bool done = store_read_excluded(reader, print_row, &listing);
    if (json)
        fputs(listing.rows ? "\n]" : "]", stdout);
    else if (done && listing.rows == 0)
        puts("Nothing is out.");
    else if (done)
        puts("Rules of the set 'stricter' are listed only; the analysis applies 'planned' and 'late' ones.");
    if (!done)
        snprintf(error, error_size, "%s", store_reader_error(reader));
    store_reader_close(reader);
    return done;
}
