#include "app/fovstudy/rules.h"

#include "app/session/record.h"
#include "studies/engine/exclude.h"
#include "studies/store/exclusions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RULES_DETAIL = 192 };

// An exclusion with the texts that it borrows.
struct found {
    struct store_exclusion row;
    char rule[PROTOCOL_NAME], reason[EXCLUDE_REASON];
};

struct applying {
    const struct rules *rules;
    struct exclude_facts *facts; // owned; block and kind of each too
    size_t fact_count, fact_capacity;
    struct found *found; // owned
    size_t found_count, found_capacity;
    int64_t participant_id;
    bool out_of_memory;
};

static bool grow(void **items, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return true;
    size_t wanted = *capacity ? 2 * *capacity : 64;
    void *grown = realloc(*items, wanted * size);
    if (!grown)
        return false;
    *items = grown;
    *capacity = wanted;
    return true;
}

static bool take_facts(void *user, const struct store_fact_row *row)
{
    struct applying *a = user;
    void *items = a->facts;
    a->out_of_memory = !grow(&items, a->fact_count, &a->fact_capacity, sizeof *a->facts);
    a->facts = items;
    if (a->out_of_memory)
        return false;
    struct exclude_facts *facts = &a->facts[a->fact_count++];
    *facts = (struct exclude_facts){
        .trial = row->trial_id,
        .session = row->session_id,
        .block = strdup(row->block),
        .kind = strdup(row->kind),
        .rated = row->rated,
        .seen_s = {row->seen_s[0], row->seen_s[1]},
        .gaze_samples = row->gaze_samples,
        .gaze_lost = row->gaze_lost,
        .gaze_gap_ms = row->gaze_gap_ms,
        .stimulus_frames = row->stimulus_frames,
        .late_frames = row->late_frames,
        .rendered_frames = row->rendered_frames,
        .fallback_frames = row->fallback_frames,
        .reaction_s = row->reaction_s,
        .caught = row->caught,
        .missed = row->missed,
    };
    a->out_of_memory = !facts->block || !facts->kind;
    return !a->out_of_memory;
}

static bool take_verdict(void *user, const struct exclude_verdict *verdict)
{
    struct applying *a = user;
    void *items = a->found;
    if (a->rules->late && verdict->rule->stricter)
        return true;
    a->out_of_memory = !grow(&items, a->found_count, &a->found_capacity, sizeof *a->found);
    a->found = items;
    if (a->out_of_memory)
        return false;
    struct found *found = &a->found[a->found_count++];
    *found = (struct found){.row = {.trial_id = verdict->trial,
                                    .participant_id = verdict->trial ? 0 : a->participant_id,
                                    .rule_set = a->rules->late            ? "late"
                                                : verdict->rule->stricter ? "stricter"
                                                                          : "planned",
                                    .by = RULES_BY}};
    exclude_rule_name(verdict->rule, found->rule);
    snprintf(found->reason, sizeof found->reason, "%s", verdict->reason);
    return true;
}

static bool write_found(struct applying *a, const struct rules_session *sessions, size_t count,
                        size_t *out_added, struct store_error *why)
{
    char now[RECORD_TIME], detail[RULES_DETAIL];
    struct store_exclusion *rows = calloc(a->found_count + 1, sizeof *rows);
    struct store_event *events = calloc(count + 1, sizeof *events);
    bool done = false;
    record_time_utc(now);
    snprintf(detail, sizeof detail, "{\"protocol\":\"%s\",\"set\":\"%s\",\"by\":\"%s\",\"at\":\"%s\"}",
             a->rules->protocol->sha256_hex, a->rules->late ? "late" : "planned", RULES_BY, now);
    snprintf(why->text, sizeof why->text, "out of memory");
    if (rows && events) {
        for (size_t i = 0; i < a->found_count; i++) {
            rows[i] = a->found[i].row;
            rows[i].rule = a->found[i].rule;
            rows[i].reason = a->found[i].reason;
            rows[i].applied_at = now;
        }
        for (size_t i = 0; i < count; i++)
            events[i] = (struct store_event){.session_id = sessions[i].session_id,
                                             .segment_id = sessions[i].segment_id,
                                             .kind = "rules_applied",
                                             .detail = detail};
        done = store_apply_exclusions(a->rules->store, rows, a->found_count, events, count, out_added, why) ==
               STORE_OK;
    }
    free(rows);
    free(events);
    return done;
}

bool rules_apply(const struct rules *rules, struct store_reader *reader, const struct rules_session *sessions,
                 size_t count, size_t *out_added, char *error, size_t error_size)
{
    struct applying a = {.rules = rules, .participant_id = sessions[0].participant_id};
    struct store_error why = {""};
    *out_added = 0;
    bool done = store_read_facts(reader, sessions[0].participant_id, sessions[0].protocol_id, take_facts, &a) &&
                exclude_apply(rules->protocol, a.facts, a.fact_count, take_verdict, &a);
    if (!done)
        snprintf(error, error_size, "%s", a.out_of_memory ? "out of memory" : store_reader_error(reader));
    if (done && !write_found(&a, sessions, count, out_added, &why)) {
        snprintf(error, error_size, "%s", why.text);
        done = false;
    }
    for (size_t i = 0; i < a.fact_count; i++) {
        free((char *)a.facts[i].block);
        free((char *)a.facts[i].kind);
    }
    free(a.facts);
    free(a.found);
    return done;
}

bool rules_end_session(struct store *store, const char *path, const struct protocol *protocol,
                       const struct store_session_ids *ids, char *error, size_t error_size)
{
    struct store_error why = {""};
    if (protocol->exclusion_count == 0)
        return true;
    if (store_flush(store, &why) != STORE_OK) {
        snprintf(error, error_size, "%s", why.text);
        return false;
    }
    struct store_reader *reader = store_reader_open(path, error, error_size);
    if (!reader)
        return false;
    struct rules rules = {.store = store, .path = path, .protocol = protocol};
    struct rules_session session = {ids->session_id, ids->segment_id, ids->participant_id, ids->protocol_id};
    size_t added = 0;
    bool done = rules_apply(&rules, reader, &session, 1, &added, error, error_size);
    store_reader_close(reader);
    return done;
}
