// Subjects, sessions, runs and their labels, in the order of the study file.
#include "analysis/report/sample.h"
#include "analysis/tools/bids_private.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool taken(const struct bids_names *names, const char *label)
{
    for (size_t i = 0; i < names->count; i++)
        if (strcasecmp(names->items[i].label, label) == 0)
            return true;
    return false;
}

static size_t find_name(const struct bids_names *names, const char *text)
{
    for (size_t i = 0; i < names->count; i++)
        if (strcmp(names->items[i].text, text) == 0)
            return i;
    return SIZE_MAX;
}

static bool add_name(struct bids_names *names, const char *prefix, const char *text)
{
    if (find_name(names, text) != SIZE_MAX)
        return true;
    char base[BIDS_LABEL_SIZE - 24], label[BIDS_LABEL_SIZE];
    size_t size = (size_t)snprintf(base, sizeof base, "%s", prefix);
    for (const char *c = text; *c && size + 1 < sizeof base; c++)
        if ((*c >= '0' && *c <= '9') || (*c >= 'A' && *c <= 'Z') || (*c >= 'a' && *c <= 'z'))
            base[size++] = *c;
    base[size] = '\0';
    snprintf(label, sizeof label, "%s", size ? base : "x");
    for (size_t i = 2; taken(names, label); i++)
        snprintf(label, sizeof label, "%sx%zu", base, i);
    if (!sample_grow(&names->items, names->count, sizeof *names->items))
        return false;
    struct bids_name *name = &names->items[names->count];
    name->text = strdup(text);
    memcpy(name->label, label, sizeof label);
    names->count += name->text != NULL;
    return name->text;
}

static bool add_person(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct bids *b = user;
    if (header)
        return true;
    b->simulated = b->simulated || strcmp(cell_text(cells, count, "participant_kind"), "simulated") == 0;
    return add_name(&b->people, "", cell_text(cells, count, "participant_id"));
}

static bool add_session(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct bids *b = user;
    if (header)
        return true;
    const char *protocol = cell_text(cells, count, "protocol");
    if (!add_name(&b->tasks, b->simulated ? "SIMULATED" : "", protocol) ||
        !sample_grow(&b->sessions, b->session_count, sizeof *b->sessions))
        return false;
    struct bids_session s = {.id = cell_integer(cells, count, "session_id", 0),
                             .person = find_name(&b->people, cell_text(cells, count, "participant_id")),
                             .task = find_name(&b->tasks, protocol),
                             .number = 1};
    for (size_t i = 0; i < b->session_count; i++)
        s.number += b->sessions[i].person == s.person;
    b->sessions[b->session_count++] = s;
    return true;
}

static bool add_run(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct bids *b = user;
    if (header)
        return true;
    int64_t session_id = cell_integer(cells, count, "session_id", 0);
    size_t session = 0;
    while (session < b->session_count && b->sessions[session].id != session_id)
        session++;
    if (session == b->session_count || !sample_grow(&b->runs, b->run_count, sizeof *b->runs))
        return false;
    struct bids_run *run = &b->runs[b->run_count++];
    *run = (struct bids_run){.segment = cell_integer(cells, count, "segment_id", 0),
                             .session = session,
                             .number = ++b->sessions[session].runs};
    snprintf(run->version, sizeof run->version, "%s", cell_text(cells, count, "app_version"));
    return true;
}

static bool add_trial(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct bids *b = user;
    if (header)
        return true;
    if (!sample_grow(&b->trials, b->trial_count, sizeof *b->trials))
        return false;
    b->trials[b->trial_count++] =
        (struct bids_trial){.id = cell_integer(cells, count, "trial_id", 0),
                            .started_ns = cell_integer(cells, count, "started_ns", INT64_MAX),
                            .ended_ns = cell_integer(cells, count, "ended_ns", 0),
                            .run = bids_find_run(b, cell_integer(cells, count, "segment_id", 0))};
    return true;
}

static bool add_condition(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct bids *b = user;
    if (header)
        return true;
    const char *mode = cell_text(cells, count, "mode"), *parameters = cell_text(cells, count, "parameters");
    size_t size = strlen(mode) + strlen(parameters) + 2;
    char *text = malloc(size);
    if (!text || !sample_grow(&b->conditions, b->condition_count, sizeof *b->conditions)) {
        free(text);
        return false;
    }
    snprintf(text, size, "%s %s", mode, parameters);
    b->conditions[b->condition_count++] =
        (struct bids_condition){cell_integer(cells, count, "condition_id", 0), text};
    return true;
}

bool bids_read(struct bids *bids, const char *table, store_export_fn each, void *user)
{
    bool ok = store_read_export(bids->reader, table, each, user);
    if (!ok && store_reader_error(bids->reader)[0])
        bids_fail(bids, "%s", store_reader_error(bids->reader));
    return ok;
}

bool bids_layout_load(struct bids *b)
{
    return bids_read(b, "participants", add_person, b) && bids_read(b, "sessions", add_session, b) &&
           bids_read(b, "segments", add_run, b) && bids_read(b, "trials", add_trial, b) &&
           bids_read(b, "conditions", add_condition, b);
}

static void free_names(struct bids_names *names)
{
    for (size_t i = 0; i < names->count; i++)
        free(names->items[i].text);
    free(names->items);
}

void bids_layout_free(struct bids *b)
{
    free_names(&b->people);
    free_names(&b->tasks);
    for (size_t i = 0; i < b->condition_count; i++)
        free(b->conditions[i].text);
    free(b->conditions);
    free(b->sessions);
    free(b->runs);
    free(b->trials);
}

size_t bids_find_run(const struct bids *bids, int64_t segment)
{
    size_t low = 0, high = bids->run_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (bids->runs[middle].segment < segment)
            low = middle + 1;
        else
            high = middle;
    }
    return low < bids->run_count && bids->runs[low].segment == segment ? low : SIZE_MAX;
}

const struct bids_trial *bids_find_trial(const struct bids *bids, int64_t id)
{
    size_t low = 0, high = bids->trial_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (bids->trials[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < bids->trial_count && bids->trials[low].id == id ? &bids->trials[low] : NULL;
}

const struct bids_session *bids_find_session(const struct bids *bids, int64_t id)
{
    for (size_t i = 0; i < bids->session_count; i++)
        if (bids->sessions[i].id == id)
            return &bids->sessions[i];
    return NULL;
}
