#include "app/fovstudy/check_number.h"

#include "studies/store/read.h"

#include <stdio.h>
#include <string.h>

enum { HOLDERS = 4096 }; // more participants than a laboratory sees; those beyond count as absent

struct search {
    const char *code;
    int64_t found; // 0: not in the file
    int64_t excluded[HOLDERS], numbers[HOLDERS];
    size_t excluded_count, number_count;
};

static bool take_exclusion(void *user, const struct store_exclusion_row *row)
{
    struct search *search = user;
    if (row->participant_id && strcmp(row->rule_set, "stricter") != 0 && search->excluded_count < HOLDERS)
        search->excluded[search->excluded_count++] = row->participant_id;
    return true;
}

static bool holds(const int64_t *list, size_t count, int64_t value)
{
    for (size_t i = 0; i < count; i++)
        if (list[i] == value)
            return true;
    return false;
}

static bool take_session(void *user, const struct store_session_row *row)
{
    struct search *search = user;
    if (strcmp(row->code, search->code) == 0)
        search->found = row->number;
    if (!holds(search->excluded, search->excluded_count, row->participant_id) && search->number_count < HOLDERS)
        search->numbers[search->number_count++] = row->number;
    return true;
}

bool check_number(const char *path, const char *code, uint64_t *out, char *error, size_t error_size)
{
    struct search search = {.code = code};
    struct store_reader *reader = store_reader_open(path, error, error_size);
    if (!reader)
        return false;
    bool done = store_read_exclusions(reader, take_exclusion, &search) &&
                store_read_sessions(reader, take_session, &search);
    if (!done)
        snprintf(error, error_size, "%s", store_reader_error(reader));
    store_reader_close(reader);
    int64_t number = search.found ? search.found : 1;
    while (!search.found && holds(search.numbers, search.number_count, number))
        number++;
    *out = (uint64_t)number;
    return done;
}
