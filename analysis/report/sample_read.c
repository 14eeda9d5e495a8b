// Fills a sample from its files, one file after another.
#include "analysis/report/level.h"
#include "analysis/report/sample_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct filling {
    struct sample *sample;
    size_t file;
    const char *refusal; // why the caller's function stopped; NULL: memory
};

static size_t find_person(const struct sample *sample, size_t file, int64_t id)
{
    for (size_t i = 0; i < sample->person_count; i++)
        if (sample->people[i].file == file && sample->people[i].id == id)
            return i;
    return SAMPLE_NONE;
}

static size_t add_person(struct filling *f, const struct store_session_row *row)
{
    struct sample *s = f->sample;
    size_t found = find_person(s, f->file, row->participant_id);
    if (found != SAMPLE_NONE)
        return found;
    struct sample_person person = {f->file, row->participant_id, row->number, sample_keep(s, row->code)};
    if (!person.code || !sample_grow(&s->people, s->person_count, sizeof s->people[0]))
        return SAMPLE_NONE;
    s->people[s->person_count] = person;
    return s->person_count++;
}

static bool add_session(void *user, const struct store_session_row *row)
{
    struct filling *f = user;
    struct sample *s = f->sample;
    if (row->simulated && !s->simulated) {
        s->left_out_simulated++;
        return true;
    }
    if (!row->simulated && s->simulated) {
        f->refusal =
            "holds sessions of people; leave --simulated out, or name only files of simulated sessions";
        return false;
    }
    if (strcmp(row->protocol_name, s->protocol) != 0) {
        s->left_out_protocol++;
        return true;
    }
    struct sample_session session = {
        .file = f->file,
        .id = row->id,
        .participant_id = row->participant_id,
        .person = add_person(f, row),
        .status = row->status,
        .started_at = row->started_at,
        .ended_at = row->ended_at,
        .seed = row->seed,
        .protocol_name = row->protocol_name,
        .protocol_sha256 = row->protocol_sha256,
        .device = row->device,
        .driver = row->driver,
        .display = row->display,
        .app_version = row->app_version,
        .refresh_hz = row->refresh_hz,
        .width_px = row->width_px,
        .height_px = row->height_px,
        .fov_deg = row->fov_deg,
        .simulated_clock = row->simulated_clock,
        .segments = row->segments,
        .scenes = row->scenes,
        .observer = row->observer,
        .planned = row->planned,
        .title = row->title,
        .sitting = row->sitting,
    };
    const char **texts[] = {&session.status,        &session.started_at,      &session.ended_at,
                            &session.protocol_name, &session.protocol_sha256, &session.device,
                            &session.driver,        &session.display,         &session.app_version,
                            &session.scenes,        &session.observer,        &session.planned,
                            &session.title,         &session.sitting};
    if (session.person == SAMPLE_NONE || !sample_keep_all(s, texts, sizeof texts / sizeof texts[0]) ||
        !sample_grow(&s->sessions, s->session_count, sizeof s->sessions[0]))
        return false;
    s->sessions[s->session_count++] = session;
    return true;
}

static bool add_attribute(void *user, const struct store_member_row *row)
{
    struct filling *f = user;
    struct sample *s = f->sample;
    struct sample_attribute attribute = {find_person(s, f->file, row->owner), row->key, row->value,
                                         row->number};
    if (attribute.person == SAMPLE_NONE)
        return true;
    const char **texts[] = {&attribute.key, &attribute.value};
    if (!sample_keep_all(s, texts, 2) ||
        !sample_grow(&s->attributes, s->attribute_count, sizeof s->attributes[0]))
        return false;
    s->attributes[s->attribute_count++] = attribute;
    return true;
}

static bool add_factor(void *user, const struct store_member_row *row)
{
    struct filling *f = user;
    struct sample *s = f->sample;
    for (size_t i = 0; i < s->factor_count; i++)
        if (strcmp(s->factors[i].factors, row->owner_text) == 0 && strcmp(s->factors[i].key, row->key) == 0)
            return true; // another file has it too
    struct sample_factor factor = {row->owner_text, row->key, row->value, row->number};
    const char **texts[] = {&factor.factors, &factor.key, &factor.value};
    if (!sample_keep_all(s, texts, 3) || !sample_grow(&s->factors, s->factor_count, sizeof s->factors[0]))
        return false;
    s->factors[s->factor_count++] = factor;
    return true;
}

// Members arrive condition by condition: the first opens one, the others extend its parameter text.
static bool add_condition(void *user, const struct store_member_row *row)
{
    struct filling *f = user;
    struct sample *s = f->sample;
    if (sample_find_condition(s, f->file, row->owner) == SAMPLE_NONE) {
        struct sample_condition condition = {sample_keep(s, row->owner_text), "", NULL, NULL};
        if (!condition.mode || !sample_grow(&s->conditions, s->condition_count, sizeof s->conditions[0]) ||
            !sample_grow(&s->condition_ids, s->condition_id_count, sizeof s->condition_ids[0]))
            return false;
        s->condition_ids[s->condition_id_count++] =
            (struct sample_condition_id){f->file, row->owner, s->condition_count};
        s->conditions[s->condition_count++] = condition;
    }
    if (row->key[0] == '\0')
        return true;
    struct sample_condition *condition = &s->conditions[s->condition_count - 1];
    struct sample_parameter parameter = {s->condition_count - 1, row->key, row->value};
    const char **texts[] = {&parameter.key, &parameter.value};
    if (!sample_keep_all(s, texts, 2) ||
        !sample_grow(&s->parameters, s->parameter_count, sizeof s->parameters[0]))
        return false;
    s->parameters[s->parameter_count++] = parameter;
    size_t size = strlen(condition->parameters) + strlen(row->key) + strlen(row->value) + 3;
    char *text = malloc(size);
    if (!text)
        return false;
    snprintf(text, size, "%s%s%s=%s", condition->parameters, condition->parameters[0] ? " " : "", row->key,
             row->value);
    condition->parameters = sample_keep(s, text);
    free(text);
    return condition->parameters != NULL;
}

// The same condition of several files becomes one.
static void unite_conditions(struct sample *s)
{
    for (size_t i = 0; i < s->condition_id_count; i++) {
        const struct sample_condition *mine = &s->conditions[s->condition_ids[i].condition];
        for (size_t j = 0; j < s->condition_ids[i].condition; j++)
            if (strcmp(s->conditions[j].mode, mine->mode) == 0 &&
                strcmp(s->conditions[j].parameters, mine->parameters) == 0) {
                s->condition_ids[i].condition = j;
                break;
            }
    }
}

static bool parameter_varies(const struct sample *s, size_t index)
{
    const struct sample_parameter *mine = &s->parameters[index];
    for (size_t i = 0; i < s->parameter_count; i++) {
        const struct sample_parameter *other = &s->parameters[i];
        if (strcmp(s->conditions[other->condition].mode, s->conditions[mine->condition].mode) == 0 &&
            strcmp(other->key, mine->key) == 0 && strcmp(other->value, mine->value) != 0)
            return true;
    }
    return false;
}

static bool label_condition(struct sample *s, size_t condition)
{
    char label[256], words[256];
    snprintf(label, sizeof label, "%s", s->conditions[condition].mode);
    snprintf(words, sizeof words, "%s", s->conditions[condition].mode);
    const char *comma = "";
    for (size_t i = 0; i < s->parameter_count; i++) {
        size_t used = strlen(label), words_used = strlen(words);
        if (s->parameters[i].condition != condition || !parameter_varies(s, i))
            continue;
        char word[96];
        level_words(s->parameters[i].key, s->parameters[i].value, true, word);
        snprintf(label + used, sizeof label - used, "%s %s %s", comma, s->parameters[i].key,
                 s->parameters[i].value);
        snprintf(words + words_used, sizeof words - words_used, "%s %s", comma, word);
        comma = ",";
    }
    s->conditions[condition].label = sample_keep(s, label);
    s->conditions[condition].words = sample_keep(s, words);
    return s->conditions[condition].label && s->conditions[condition].words;
}

static bool add_exclusion(void *user, const struct store_exclusion_row *row)
{
    struct filling *f = user;
    struct sample *s = f->sample;
    struct sample_exclusion e = {.file = f->file,
                                 .trial_id = row->trial_id,
                                 .session_id = row->session_id,
                                 .participant_id = row->participant_id,
                                 .rule = row->rule,
                                 .rule_set = row->rule_set,
                                 .reason = row->reason,
                                 .by = row->by,
                                 .code = "",
                                 .ratings_only = row->ratings_only};
    for (size_t i = 0; i < s->session_count; i++) {
        struct sample_session *session = &s->sessions[i];
        if (session->file != f->file ||
            (session->id != e.session_id && session->participant_id != e.participant_id))
            continue;
        e.code = s->people[session->person].code;
    }
    const char **texts[] = {&e.rule, &e.rule_set, &e.reason, &e.by};
    if (!sample_keep_all(s, texts, 4) ||
        !sample_grow(&s->exclusions, s->exclusion_count, sizeof s->exclusions[0]))
        return false;
    s->exclusions[s->exclusion_count++] = e;
    return true;
}

// An exclusion of a trial names its person through the trial.
static bool name_exclusion(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    struct sample *s = f->sample;
    for (size_t i = 0; i < s->exclusion_count; i++)
        if (s->exclusions[i].file == f->file && s->exclusions[i].trial_id == row->id)
            for (size_t j = 0; j < s->session_count; j++)
                if (s->sessions[j].file == f->file && s->sessions[j].id == row->session_id)
                    s->exclusions[i].code = s->people[s->sessions[j].person].code;
    return true;
}

bool sample_read(struct sample *s, char *error, size_t error_size)
{
    for (size_t i = 0; i < s->file_count; i++) {
        struct store_reader *reader = s->files[i];
        struct filling f = {s, i, NULL};
        if (store_read_sessions(reader, add_session, &f) && store_read_attributes(reader, add_attribute, &f) &&
            store_read_factors(reader, add_factor, &f) && sample_read_cells(s, i) &&
            store_read_conditions(reader, add_condition, &f) &&
            store_read_exclusions(reader, add_exclusion, &f) &&
            (s->exclusion_count == 0 || store_read_trials(reader, name_exclusion, &f)))
            continue;
        if (store_reader_error(reader)[0])
            snprintf(error, error_size, "%s", store_reader_error(reader));
        else if (f.refusal)
            snprintf(error, error_size, "%s: %s", store_reader_path(reader), f.refusal);
        return false;
    }
    sample_apply(s, SAMPLE_RULES);
    unite_conditions(s);
    for (size_t i = 0; i < s->condition_count; i++)
        if (!label_condition(s, i))
            return false;
    return true;
}
