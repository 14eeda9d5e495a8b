// Constant levels: answers of toggle and sequential trials by the numbers of a factor.
#include "analysis/report/thresholds_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEAST_RIGHT = 3, LEAST_PREFERENCE = 5 }; // distinct levels: more than the function has numbers to find

struct filling {
    struct thresholds *thresholds;
    struct sample *sample;
    size_t file, first; // cells before are staircases'
};

static struct threshold_cell *find_cell(struct filling *f, const struct store_trial_row *row,
                                        const char *factor)
{
    struct thresholds *t = f->thresholds;
    char label[512];
    bool preference = row->correct < 0;
    threshold_label_text(f->sample, row->factors, factor, false, label);
    for (size_t i = f->first; i < t->cell_count; i++) {
        struct threshold_cell *cell = &t->cells[i];
        if (cell->preference == preference && strcmp(cell->block, row->block) == 0 &&
            strcmp(cell->parameter, factor) == 0 && strcmp(cell->label, label) == 0)
            return cell;
    }
    struct threshold_cell cell = {.source = THRESHOLD_LEVELS,
                                  .preference = preference,
                                  .block = sample_keep(f->sample, row->block),
                                  .label = sample_keep(f->sample, label),
                                  .words = threshold_label(f->sample, row->factors, factor, true),
                                  .parameter = factor};
    cell.factors = cell.label;
    if (!cell.label || !cell.block || !cell.words || !sample_grow(&t->cells, t->cell_count, sizeof t->cells[0]))
        return NULL;
    t->cells[t->cell_count] = cell;
    return &t->cells[t->cell_count++];
}

static bool add_answer(struct filling *f, const struct store_trial_row *row, size_t person,
                       const struct sample_factor *factor)
{
    struct threshold_cell *cell = find_cell(f, row, factor->key);
    struct threshold_person *p = cell ? threshold_find_person(cell, person) : NULL;
    if (!p || !sample_grow(&p->steps, p->step_count, sizeof p->steps[0]))
        return false;
    bool yes = cell->preference ? row->chosen == 't' : row->correct == 1;
    p->steps[p->step_count++] = (struct stat_answers){.level = factor->number, .k = yes, .n = 1};
    cell->steps++;
    return true;
}

// The same answers are left out as choices.h leaves out.
static bool add_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    size_t session = sample_find_session(f->sample, f->file, row->session_id);
    bool pair = strcmp(row->kind, "toggle") == 0 || strcmp(row->kind, "sequential") == 0;
    if (row->choice_id == 0 || session == SAMPLE_NONE || !pair || strcmp(row->status, "done") != 0 ||
        sample_trial_excluded(f->sample, f->file, row->id) || row->chosen == '?' || row->chosen == '=')
        return true;
    for (size_t i = 0; i < f->sample->factor_count; i++) {
        const struct sample_factor *factor = &f->sample->factors[i];
        if (strcmp(factor->factors, row->factors) == 0 && isfinite(factor->number) &&
            !add_answer(f, row, f->sample->sessions[session].person, factor))
            return false;
    }
    return true;
}

static int by_level(const void *x, const void *y)
{
    const struct stat_answers *a = x, *b = y;
    return (a->level > b->level) - (a->level < b->level);
}

// Distinct levels of a person; sorts their answers.
static size_t distinct(struct threshold_person *p)
{
    size_t count = p->step_count > 0;
    if (p->step_count)
        qsort(p->steps, p->step_count, sizeof p->steps[0], by_level);
    for (size_t i = 1; i < p->step_count; i++)
        count += p->steps[i].level > p->steps[i - 1].level;
    return count;
}

// All answers become one entry's. False where memory ran out.
static bool pool(struct threshold_cell *cell)
{
    struct threshold_person all = {.person = SAMPLE_NONE, .steps = malloc(cell->steps * sizeof *all.steps)};
    if (!all.steps)
        return false;
    for (size_t i = 0; i < cell->person_count; i++) {
        const struct threshold_person *p = &cell->people[i];
        memcpy(all.steps + all.step_count, p->steps, p->step_count * sizeof *p->steps);
        all.step_count += p->step_count;
        free(p->steps);
    }
    cell->pooled = cell->person_count;
    cell->people[0] = all;
    cell->person_count = 1;
    return true;
}

// Covariance of answer and level, times their number.
static double together(const struct threshold_cell *cell)
{
    double n = 0, level = 0, yes = 0, both = 0, first = cell->people[0].steps[0].level;
    for (size_t i = 0; i < cell->person_count; i++)
        for (size_t j = 0; j < cell->people[i].step_count; j++) {
            double x = cell->people[i].steps[j].level - first, k = (double)cell->people[i].steps[j].k;
            n++;
            level += x;
            yes += k;
            both += x * k;
        }
    return both - level * yes / n;
}

// False where memory ran out; *out_keep: whether the cell has levels enough.
static bool finish_cell(struct threshold_cell *cell, enum threshold_larger larger, bool *out_keep)
{
    bool once = true;
    size_t most = 0;
    for (size_t i = 0; i < cell->person_count; i++) {
        size_t levels = distinct(&cell->people[i]);
        once = once && levels == cell->people[i].step_count;
        most = levels > most ? levels : most;
    }
    *out_keep = true;
    if (once && cell->person_count > 1) { // one person's answers have intervals of their own
        if (!pool(cell))
            return false;
        most = distinct(&cell->people[0]);
    }
    *out_keep = most >= (cell->preference ? LEAST_PREFERENCE : LEAST_RIGHT);
    for (size_t i = 0; i < cell->person_count; i++)
        cell->people[i].estimate = (double)NAN; // there is no staircase
    cell->undirected = larger == THRESHOLD_AS_SHOWN && together(cell) == 0;
    cell->falling = larger == THRESHOLD_AS_SHOWN ? together(cell) < 0 : larger == THRESHOLD_HARDER;
    return true;
}

bool thresholds_read_levels(struct thresholds *out, struct sample *sample, char *error, size_t error_size)
{
    bool ok = true;
    size_t first = out->cell_count, kept = first;
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        struct filling f = {out, sample, i, first};
        ok = store_read_trials(sample->files[i], add_trial, &f);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    for (size_t i = first; ok && i < out->cell_count; i++) {
        bool keep;
        ok = finish_cell(&out->cells[i], out->options.larger, &keep);
        if (ok && keep) {
            struct threshold_cell cell = out->cells[kept];
            out->cells[kept++] = out->cells[i];
            out->cells[i] = cell; // still owned, and freed below
        }
    }
    for (size_t i = kept; ok && i < out->cell_count; i++)
        threshold_cell_free(&out->cells[i]);
    if (ok)
        out->cell_count = kept;
    return ok;
}
