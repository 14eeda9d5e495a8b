// Rows of staircases become cells, people and steps.
#include "analysis/report/level.h"
#include "analysis/report/thresholds_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What is known of a cell while its rows arrive.
struct vote {
    int64_t easier;      // how often a wrong answer raised the level, less how often it lowered it
    int64_t harder;      // the same of right answers
    uint32_t parameters; // bit i: the i-th parameter of the test option had every level so far
    const char *name;    // of the first that had
    bool any;
};

struct filling {
    struct thresholds *thresholds;
    struct sample *sample;
    size_t file;
    struct vote *votes; // one per cell
    size_t vote_count;
    // The staircase whose rows arrive:
    size_t cell, session;
    double level, estimate;
    int64_t outcome;
    // Staircases of this file with a trial to come; owned.
    struct unfinished {
        int64_t session_id;
        const char *block, *factors;
    } * unfinished;
    size_t unfinished_count;
    bool ended;
};

void threshold_label_text(const struct sample *sample, const char *factors, const char *without, bool words,
                          char label[512])
{
    label[0] = '\0';
    for (size_t i = 0; i < sample->factor_count; i++) {
        const struct sample_factor *f = &sample->factors[i];
        if (strcmp(f->factors, factors) != 0 || (without && strcmp(f->key, without) == 0))
            continue;
        size_t used = strlen(label);
        char level[96];
        level_words(f->key, f->value, true, level);
        if (words)
            snprintf(label + used, 512 - used, "%s%s", used ? ", " : "", level);
        else
            snprintf(label + used, 512 - used, "%s%s %s", used ? ", " : "", f->key, f->value);
    }
    if (!label[0])
        snprintf(label, 512, "all");
}

const char *threshold_label(struct sample *sample, const char *factors, const char *without, bool words)
{
    char label[512];
    threshold_label_text(sample, factors, without, words, label);
    return sample_keep(sample, label);
}

static struct threshold_cell *find_cell(struct filling *f, const struct store_step_row *row)
{
    struct thresholds *t = f->thresholds;
    for (size_t i = 0; i < t->cell_count; i++)
        if (strcmp(t->cells[i].block, row->block) == 0 && strcmp(t->cells[i].factors, row->factors) == 0)
            return &t->cells[i];
    struct threshold_cell cell = {.block = sample_keep(f->sample, row->block),
                                  .factors = sample_keep(f->sample, row->factors),
                                  .label = threshold_label(f->sample, row->factors, NULL, false),
                                  .words = threshold_label(f->sample, row->factors, NULL, true),
                                  .quest = !isnan(row->estimate)}; // up-down has none after one step
    if (!cell.block || !cell.factors || !cell.label || !cell.words ||
        !sample_grow(&t->cells, t->cell_count, sizeof t->cells[0]) ||
        !sample_grow(&f->votes, f->vote_count, sizeof f->votes[0]))
        return NULL;
    f->votes[f->vote_count++] = (struct vote){0};
    t->cells[t->cell_count] = cell;
    return &t->cells[t->cell_count++];
}

struct threshold_person *threshold_find_person(struct threshold_cell *cell, size_t person)
{
    for (size_t i = 0; i < cell->person_count; i++)
        if (cell->people[i].person == person)
            return &cell->people[i];
    if (!sample_grow(&cell->people, cell->person_count, sizeof cell->people[0]))
        return NULL;
    cell->people[cell->person_count] = (struct threshold_person){.person = person};
    return &cell->people[cell->person_count++];
}

// Which parameters of the shown option have the level's value: the store rounds those to nine digits.
static void vote_parameter(struct filling *f, struct vote *vote, const struct store_step_row *row)
{
    size_t condition = sample_find_condition(f->sample, f->file, row->test_id);
    uint32_t same = 0;
    int index = 0;
    const char *name = NULL;
    for (size_t i = 0; i < f->sample->parameter_count && index < 32; i++) {
        const struct sample_parameter *p = &f->sample->parameters[i];
        if (p->condition != condition)
            continue;
        char *end;
        double value = strtod(p->value, &end);
        bool fits = end != p->value && *end == '\0' && fabs(value - row->level) <= 1e-6 * fabs(row->level);
        if (fits && (!vote->any || (vote->parameters & (UINT32_C(1) << index)))) {
            same |= UINT32_C(1) << index;
            name = name ? name : p->key;
        }
        index++;
    }
    vote->parameters = same;
    vote->name = name;
    vote->any = true;
}

// The rows of a staircase are over: its last estimate is its own, where it ran to its end.
static void close_staircase(struct filling *f)
{
    if (f->cell == SAMPLE_NONE)
        return;
    struct threshold_cell *cell = &f->thresholds->cells[f->cell];
    struct threshold_person *person = threshold_find_person(cell, f->sample->sessions[f->session].person);
    if (person && f->ended && !isnan(f->estimate)) {
        double before = person->estimates ? person->estimate * (double)person->estimates : 0;
        person->estimate = (before + f->estimate) / (double)++person->estimates;
    }
    f->cell = SAMPLE_NONE;
}

static void open_staircase(struct filling *f, size_t cell, size_t session, struct threshold_person *person)
{
    close_staircase(f);
    f->cell = cell;
    f->session = session;
    f->level = (double)NAN;
    person->staircases++;
}

static bool add_unfinished(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    if (strcmp(row->kind, "staircase") != 0 ||
        (strcmp(row->status, "planned") != 0 && strcmp(row->status, "running") != 0))
        return true;
    const struct unfinished *last = f->unfinished_count ? &f->unfinished[f->unfinished_count - 1] : NULL;
    if (last && last->session_id == row->session_id && strcmp(last->block, row->block) == 0 &&
        strcmp(last->factors, row->factors) == 0)
        return true;
    if (!sample_grow(&f->unfinished, f->unfinished_count, sizeof f->unfinished[0]))
        return false;
    struct unfinished *one = &f->unfinished[f->unfinished_count++];
    *one = (struct unfinished){row->session_id, sample_keep(f->sample, row->block),
                               sample_keep(f->sample, row->factors)};
    return one->block && one->factors;
}

static bool is_unfinished(const struct filling *f, const struct store_step_row *row)
{
    for (size_t i = 0; i < f->unfinished_count; i++)
        if (f->unfinished[i].session_id == row->session_id && strcmp(f->unfinished[i].block, row->block) == 0 &&
            strcmp(f->unfinished[i].factors, row->factors) == 0)
            return true;
    return false;
}

static bool add_step(void *user, const struct store_step_row *row)
{
    struct filling *f = user;
    struct thresholds *t = f->thresholds;
    size_t session = sample_find_session(f->sample, f->file, row->session_id);
    if (session == SAMPLE_NONE)
        return true;
    if (!isfinite(row->level) || isinf(row->estimate)) { // which no program of ours writes
        t->not_finite++;
        return true;
    }
    struct threshold_cell *cell = find_cell(f, row);
    struct threshold_person *person =
        cell ? threshold_find_person(cell, f->sample->sessions[session].person) : NULL;
    if (!person)
        return false;
    size_t index = (size_t)(cell - t->cells);
    if (f->cell != index || f->session != session) {
        open_staircase(f, index, session, person);
        f->ended = !is_unfinished(f, row);
    }
    struct vote *vote = &f->votes[index];
    if (!isnan(f->level))
        *(f->outcome == 0 ? &vote->easier : &vote->harder) += (row->level > f->level) - (row->level < f->level);
    vote_parameter(f, vote, row);
    f->level = row->level;
    f->outcome = row->outcome;
    f->estimate = row->estimate;
    cell->graded = cell->graded || row->graded;
    person->reversals += row->reversal;
    if (strcmp(row->status, "done") != 0) {
        t->not_done++;
        return true;
    }
    if (sample_trial_excluded(f->sample, f->file, row->trial_id)) {
        t->excluded++;
        return true;
    }
    if (!sample_grow(&person->steps, person->step_count, sizeof person->steps[0]))
        return false;
    person->steps[person->step_count++] =
        (struct stat_answers){.level = row->level, .k = row->outcome == 1, .n = 1};
    t->steps++;
    cell->steps++;
    return true;
}

static void finish_cell(struct threshold_cell *cell, const struct vote *vote, enum threshold_larger larger)
{
    cell->parameter = vote->name ? vote->name : "level";
    cell->undirected = larger == THRESHOLD_AS_SHOWN && !vote->easier && !vote->harder;
    bool shown = vote->easier ? vote->easier < 0 : vote->harder > 0;
    cell->falling = larger == THRESHOLD_AS_SHOWN ? shown : larger == THRESHOLD_HARDER;
    for (size_t i = 0; i < cell->person_count; i++)
        if (cell->people[i].estimates == 0)
            cell->people[i].estimate = (double)NAN;
}

bool thresholds_read(struct thresholds *out, struct sample *sample, char *error, size_t error_size)
{
    struct filling f = {.thresholds = out, .sample = sample, .cell = SAMPLE_NONE};
    bool ok = true;
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        f.file = i;
        f.unfinished_count = 0;
        ok = store_read_trials(sample->files[i], add_unfinished, &f) &&
             store_read_staircase_steps(sample->files[i], add_step, &f);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
        close_staircase(&f);
    }
    for (size_t i = 0; ok && i < out->cell_count; i++)
        finish_cell(&out->cells[i], &f.votes[i], out->options.larger);
    free(f.votes);
    free(f.unfinished);
    return ok;
}
