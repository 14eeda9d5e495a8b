#include "analysis/report/sample.h"

#include "analysis/report/sample_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// Doubles at each power of two: the caller keeps the count only.
bool sample_grow(void *items_address, size_t count, size_t item_size)
{
    if (count != 0 && (count & (count - 1)) != 0)
        return true;
    void *items;
    memcpy(&items, items_address, sizeof items);
    if (count > SIZE_MAX / 2 / item_size)
        return false;
    items = realloc(items, (count ? 2 * count : 1) * item_size);
    if (!items)
        return false;
    memcpy(items_address, &items, sizeof items);
    return true;
}

const char *sample_keep(struct sample *sample, const char *text)
{
    if (!sample_grow(&sample->texts, sample->text_count, sizeof sample->texts[0]))
        return NULL;
    char *copy = strdup(text);
    if (copy)
        sample->texts[sample->text_count++] = copy;
    return copy;
}

bool sample_keep_all(struct sample *sample, const char **texts[], size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(*texts[i] = sample_keep(sample, *texts[i])))
            return false;
    return true;
}

size_t sample_any_session(const struct sample *sample, size_t file, int64_t id)
{
    for (size_t i = 0; i < sample->session_count; i++)
        if (sample->sessions[i].file == file && sample->sessions[i].id == id)
            return i;
    return SAMPLE_NONE;
}

size_t sample_find_session(const struct sample *sample, size_t file, int64_t id)
{
    size_t i = sample_any_session(sample, file, id);
    return i == SAMPLE_NONE || sample->sessions[i].excluded ? SAMPLE_NONE : i;
}

size_t sample_find_condition(const struct sample *sample, size_t file, int64_t id)
{
    for (size_t i = 0; i < sample->condition_id_count; i++)
        if (sample->condition_ids[i].file == file && sample->condition_ids[i].id == id)
            return sample->condition_ids[i].condition;
    return SAMPLE_NONE;
}

size_t sample_repeaters(const struct sample *sample)
{
    size_t repeaters = 0;
    for (size_t person = 0; person < sample->person_count; person++) {
        size_t sessions = 0;
        for (size_t i = 0; i < sample->session_count; i++)
            sessions += !sample->sessions[i].excluded && sample->sessions[i].person == person;
        repeaters += sessions > 1;
    }
    return repeaters;
}

size_t sample_shared_codes(const struct sample *sample)
{
    size_t shared = 0;
    for (size_t i = 0; i < sample->person_count; i++) {
        bool again = false;
        for (size_t j = 0; j < i && !again; j++)
            again = sample->people[i].file != sample->people[j].file &&
                    strcmp(sample->people[i].code, sample->people[j].code) == 0;
        shared += again;
    }
    return shared;
}

static bool excluded(const struct sample *sample, size_t file, int64_t trial_id, bool ratings)
{
    for (size_t i = 0; i < sample->exclusion_count; i++) {
        const struct sample_exclusion *e = &sample->exclusions[i];
        if (e->applied && e->file == file && e->trial_id == trial_id && trial_id != 0 &&
            (ratings || !e->ratings_only))
            return true;
    }
    return false;
}

bool sample_trial_excluded(const struct sample *sample, size_t file, int64_t trial_id)
{
    return excluded(sample, file, trial_id, false);
}

bool sample_ratings_excluded(const struct sample *sample, size_t file, int64_t trial_id)
{
    return excluded(sample, file, trial_id, true);
}

void sample_apply(struct sample *sample, enum sample_rules rules)
{
    for (size_t i = 0; i < sample->session_count; i++)
        sample->sessions[i].excluded = false;
    for (size_t k = 0; k < sample->exclusion_count; k++) {
        struct sample_exclusion *e = &sample->exclusions[k];
        e->applied =
            rules == SAMPLE_STRICTER || (rules == SAMPLE_RULES && strcmp(e->rule_set, "stricter") != 0);
        for (size_t i = 0; i < sample->session_count; i++) {
            struct sample_session *s = &sample->sessions[i];
            if (s->file == e->file && (s->id == e->session_id || s->participant_id == e->participant_id))
                s->excluded = s->excluded || e->applied;
        }
    }
}

static bool open_files(struct sample *sample, const char *const *paths, size_t path_count, char *error,
                       size_t error_size)
{
    sample->files = calloc(path_count ? path_count : 1, sizeof sample->files[0]);
    if (!sample->files)
        return false;
    for (size_t i = 0; i < path_count; i++) {
        struct stat a, b;
        for (size_t j = 0; j < i; j++)
            if (stat(paths[i], &a) == 0 && stat(paths[j], &b) == 0 && a.st_dev == b.st_dev &&
                a.st_ino == b.st_ino) {
                snprintf(error, error_size, "%s: is given twice; name each study file once", paths[i]);
                return false;
            }
        sample->files[i] = store_reader_open(paths[i], error, error_size);
        if (!sample->files[i])
            return false;
        sample->file_count++;
        if (!store_reader_whole(sample->files[i], false)) {
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
            return false;
        }
    }
    return true;
}

// The same sitting in two files: a copy, also where a merge put a laboratory before its code.
static bool no_copies(const struct sample *sample, char *error, size_t error_size)
{
    for (size_t i = 0; i < sample->session_count; i++)
        for (size_t j = 0; j < i; j++) {
            const struct sample_session *a = &sample->sessions[i], *b = &sample->sessions[j];
            const char *code = sample->people[a->person].code, *other = sample->people[b->person].code;
            bool renamed = strcmp(code, other) != 0;
            if (a->file == b->file || strcmp(a->sitting, b->sitting) != 0)
                continue;
            snprintf(error, error_size,
                     "%s: the session of participant %s is also in %s%s%s; leave one of the files out, or it "
                     "counts twice",
                     store_reader_path(sample->files[a->file]), code, store_reader_path(sample->files[b->file]),
                     renamed ? ", as participant " : "", renamed ? other : "");
            return false;
        }
    return true;
}

struct protocols {
    struct sample *sample;
    size_t count;
    struct protocol_sessions {
        const char *name;
        size_t sessions;
    } * each; // owned; the names are the sample's
};

static bool count_protocol(void *user, const struct store_session_row *row)
{
    struct protocols *p = user;
    if (row->simulated != p->sample->simulated)
        return true;
    size_t i = 0;
    while (i < p->count && strcmp(p->each[i].name, row->protocol_name) != 0)
        i++;
    if (i == p->count) {
        if (!sample_grow(&p->each, p->count, sizeof p->each[0]))
            return false;
        p->each[p->count] = (struct protocol_sessions){sample_keep(p->sample, row->protocol_name), 0};
        if (!p->each[p->count++].name)
            return false;
    }
    p->each[i].sessions++;
    return true;
}

// A cell of one protocol is none of another's, whatever both are called.
static bool choose_protocol(struct sample *sample, const char *wanted, char *error, size_t error_size)
{
    struct protocols p = {.sample = sample};
    bool ok = true;
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        ok = store_read_sessions(sample->files[i], count_protocol, &p);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    size_t best = 0;
    for (size_t i = 1; ok && i < p.count; i++)
        if (p.each[i].sessions > p.each[best].sessions)
            best = i;
    for (size_t i = 0; ok && wanted && i < p.count; i++)
        if (strcmp(p.each[i].name, wanted) == 0)
            best = i;
    sample->protocol = ok && p.count ? p.each[best].name : "";
    if (ok && wanted && p.count && strcmp(sample->protocol, wanted) != 0) {
        snprintf(error, error_size, "%s: no session is of the protocol '%s'; there are sessions of '%s'%s",
                 store_reader_path(sample->files[0]), wanted, sample->protocol,
                 p.count > 1 ? " and others" : "");
        ok = false;
    }
    free(p.each);
    return ok;
}

static bool sessions_left(const struct sample *sample, char *error, size_t error_size)
{
    const char *path = store_reader_path(sample->files[0]),
               *more = sample->file_count > 1 ? " and the others" : "";
    size_t used = 0;
    for (size_t i = 0; i < sample->session_count; i++)
        used += !sample->sessions[i].excluded;
    if (used)
        return true;
    if (sample->session_count)
        snprintf(error, error_size, "%s%s: every session is excluded, so there is nothing to analyse", path,
                 more);
    else if (sample->left_out_simulated)
        snprintf(error, error_size,
                 "%s%s: only simulated sessions (%zu) are in it; add --simulated to analyse them", path, more,
                 sample->left_out_simulated);
    else if (sample->simulated)
        snprintf(error, error_size, "%s%s: there is no simulated session in it; leave --simulated out", path,
                 more);
    else
        snprintf(error, error_size, "%s%s: the study is empty: no session was recorded", path, more);
    return false;
}

static bool hash_sessions(struct sample *sample, char *error, size_t error_size)
{
    char(*digests)[STORE_DIGEST_HEX] = calloc(sample->session_count, sizeof *digests);
    bool ok = digests != NULL;
    for (size_t i = 0; ok && i < sample->session_count; i++) {
        struct store_reader *reader = sample->files[sample->sessions[i].file];
        ok = store_session_digest(reader, sample->sessions[i].id, digests[i]);
        if (!ok)
            snprintf(error, error_size, "%s", store_reader_error(reader));
    }
    ok = ok && store_digests_join(digests, sample->session_count, sample->data_hash);
    free(digests);
    return ok;
}

bool sample_load(struct sample *out, const char *const *paths, size_t path_count, bool simulated,
                 const char *protocol, char *error, size_t error_size)
{
    *out = (struct sample){.simulated = simulated};
    snprintf(error, error_size, "not enough memory");
    if (open_files(out, paths, path_count, error, error_size) &&
        choose_protocol(out, protocol, error, error_size) && sample_read(out, error, error_size) &&
        no_copies(out, error, error_size) && sessions_left(out, error, error_size) &&
        hash_sessions(out, error, error_size)) {
        error[0] = '\0';
        return true;
    }
    sample_free(out);
    return false;
}

void sample_free(struct sample *sample)
{
    for (size_t i = 0; i < sample->file_count; i++)
        store_reader_close(sample->files[i]);
    for (size_t i = 0; i < sample->text_count; i++)
        free(sample->texts[i]);
    for (size_t i = 0; i < sample->cell_count; i++)
        free(sample->cells[i].sessions);
    free(sample->cells);
    free(sample->files);
    free(sample->sessions);
    free(sample->people);
    free(sample->attributes);
    free(sample->conditions);
    free(sample->condition_ids);
    free(sample->parameters);
    free(sample->factors);
    free(sample->exclusions);
    free(sample->texts);
    *sample = (struct sample){0};
}
