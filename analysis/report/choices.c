#include "analysis/report/choices.h"

#include "analysis/report/choices_private.h"
#include "analysis/stats/multiple.h"
#include "analysis/stats/quantile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct filling {
    struct choices *choices;
    struct sample *sample;
    size_t file;
};

static void set_levels(struct choice_cell *cell, const struct sample *sample)
{
    for (size_t i = 0; i < sample->factor_count && cell->level_count < CHOICE_LEVELS; i++) {
        const struct sample_factor *factor = &sample->factors[i];
        if (strcmp(factor->factors, cell->factors) == 0)
            cell->levels[cell->level_count++] =
                (struct choice_level){factor->key, factor->value, factor->number};
    }
}

static const char *make_label(const struct choice_cell *cell, struct sample *sample)
{
    char label[512] = "";
    for (size_t i = 0; i < cell->level_count; i++) {
        size_t used = strlen(label);
        snprintf(label + used, sizeof label - used, "%s%s %s", i ? ", " : "", cell->levels[i].factor,
                 cell->levels[i].value);
    }
    if (cell->level_count == 0)
        snprintf(label, sizeof label, "%s or %s",
                 cell->test == SAMPLE_NONE ? "?" : sample->conditions[cell->test].label,
                 cell->reference == SAMPLE_NONE ? "?" : sample->conditions[cell->reference].label);
    size_t used = strlen(label);
    if (cell->right)
        snprintf(label + used, sizeof label - used, ", right answers");
    return sample_keep(sample, label);
}

static struct choice_cell *find_cell(struct filling *f, const struct store_trial_row *row)
{
    struct choices *c = f->choices;
    size_t test = sample_find_condition(f->sample, f->file, row->test_id);
    size_t reference = sample_find_condition(f->sample, f->file, row->reference_id);
    for (size_t i = 0; i < c->cell_count; i++) {
        struct choice_cell *cell = &c->cells[i];
        if (cell->test == test && cell->reference == reference && cell->right == (row->correct >= 0) &&
            strcmp(cell->block, row->block) == 0 && strcmp(cell->factors, row->factors) == 0)
            return cell;
    }
    struct choice_cell cell = {.block = sample_keep(f->sample, row->block),
                               .factors = sample_keep(f->sample, row->factors),
                               .test = test,
                               .reference = reference,
                               .right = row->correct >= 0};
    if (!cell.block || !cell.factors || !sample_grow(&c->cells, c->cell_count, sizeof c->cells[0]))
        return NULL;
    set_levels(&cell, f->sample);
    cell.label = make_label(&cell, f->sample);
    if (!cell.label)
        return NULL;
    c->cells[c->cell_count] = cell;
    return &c->cells[c->cell_count++];
}

// The counts of a person in a cell; NULL where memory ran out.
static struct stat_person *find_person(struct choice_cell *cell, size_t person, int64_t **out_equal)
{
    for (size_t i = 0; i < cell->people; i++)
        if (cell->person[i] == person) {
            *out_equal = &cell->equals[i];
            return &cell->counts[i];
        }
    if (!sample_grow(&cell->person, cell->people, sizeof cell->person[0]) ||
        !sample_grow(&cell->counts, cell->people, sizeof cell->counts[0]) ||
        !sample_grow(&cell->equals, cell->people, sizeof cell->equals[0]))
        return NULL;
    cell->person[cell->people] = person;
    cell->counts[cell->people] = (struct stat_person){0, 0};
    cell->equals[cell->people] = 0;
    *out_equal = &cell->equals[cell->people];
    return &cell->counts[cell->people++];
}

static bool add_answer(struct choice_cell *cell, const struct store_trial_row *row, size_t person)
{
    int64_t *equal = NULL;
    struct stat_person *counts = find_person(cell, person, &equal);
    bool toggled = strcmp(row->kind, "toggle") == 0; // there is nothing to switch in a sequential trial
    if (!counts || (toggled && !sample_grow(&cell->toggle, cell->toggled, sizeof cell->toggle[0])))
        return false;
    if (!isnan(row->reaction_s)) {
        if (!sample_grow(&cell->reaction_s, cell->reactions, sizeof cell->reaction_s[0]))
            return false;
        cell->reaction_s[cell->reactions++] = row->reaction_s;
    }
    if (toggled)
        cell->toggle[cell->toggled++] = (double)row->toggles;
    cell->answers++;
    cell->equal += row->chosen == '=';
    cell->n += row->chosen != '=';
    const bool counted = row->chosen != '=' && (cell->right ? row->correct == 1 : row->chosen == 't');
    cell->chosen += counted;
    counts->n += row->chosen != '=';
    counts->k += counted;
    *equal += row->chosen == '=';
    return true;
}

static bool add_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    struct choices *c = f->choices;
    size_t session = sample_find_session(f->sample, f->file, row->session_id);
    if (row->choice_id == 0 || session == SAMPLE_NONE)
        return true;
    if (strcmp(row->kind, "toggle") != 0 && strcmp(row->kind, "sequential") != 0) {
        c->other_kinds++;
        return true;
    }
    if (strcmp(row->status, "done") != 0) {
        c->not_done++;
        return true;
    }
    if (sample_trial_excluded(f->sample, f->file, row->id)) {
        c->excluded++;
        return true;
    }
    if (row->chosen == '?') {
        c->no_test_slot++;
        return true;
    }
    struct choice_cell *cell = find_cell(f, row);
    if (!cell || !add_answer(cell, row, f->sample->sessions[session].person))
        return false;
    c->answers++;
    c->equal += row->chosen == '=';
    c->chosen_first += row->chosen_first == 1;
    c->first_known += row->chosen != '=' && row->chosen_first >= 0;
    c->chosen_a += row->chosen_a;
    return true;
}

// Largest level first, as the papers print them; words in alphabetical order.
static int by_levels(const void *x, const void *y)
{
    const struct choice_cell *a = x, *b = y;
    int order = strcmp(a->block, b->block);
    for (size_t i = 0; order == 0 && i < a->level_count && i < b->level_count; i++) {
        double p = a->levels[i].number, q = b->levels[i].number;
        if (isnan(p) || isnan(q))
            order = strcmp(a->levels[i].value, b->levels[i].value);
        else
            order = (q > p) - (q < p);
    }
    if (order == 0)
        order = strcmp(a->label, b->label);
    if (order == 0)
        order = (a->test > b->test) - (a->test < b->test);
    return order ? order : (a->reference > b->reference) - (a->reference < b->reference);
}

// Cells may differ in what is no factor, a parameter or the reference: their options then tell them apart.
static bool tell_apart(struct choices *c, struct sample *sample)
{
    for (size_t i = 0; i < c->cell_count; i++) {
        struct choice_cell *a = &c->cells[i];
        bool alike = false;
        if (a->test == SAMPLE_NONE || a->reference == SAMPLE_NONE || a->level_count == 0)
            continue; // without levels the label is the options
        for (size_t j = 0; j < c->cell_count && !alike; j++)
            alike = i != j && strcmp(a->block, c->cells[j].block) == 0 && a->right == c->cells[j].right &&
                    strcmp(a->factors, c->cells[j].factors) == 0;
        char label[1024];
        if (!alike)
            continue;
        snprintf(label, sizeof label, "%s, %s or %s", a->label, sample->conditions[a->test].label,
                 sample->conditions[a->reference].label);
        a->label = sample_keep(sample, label);
        snprintf(label, sizeof label, "%s or %s", sample->conditions[a->test].words,
                 sample->conditions[a->reference].words);
        a->options = sample_keep(sample, label);
        if (!a->label || !a->options)
            return false;
    }
    return true;
}

static void finish_cell(struct choice_cell *cell, const struct choices_desc *desc)
{
    choice_cell_test(cell, desc);
    cell->toggles = stat_moments(cell->toggle, cell->toggled);
    stat_sort(cell->reaction_s, cell->reactions);
    cell->reaction_median_s = stat_quantile(cell->reaction_s, cell->reactions, 0.5);
}

// Over all answers; `values` has room for two per answer.
static void finish_totals(struct choices *c, double *values, size_t total)
{
    size_t toggles = 0, reactions = 0;
    for (size_t i = 0; i < c->cell_count; i++) {
        const struct choice_cell *cell = &c->cells[i];
        for (size_t j = 0; j < cell->toggled; j++)
            values[toggles++] = cell->toggle[j];
        for (size_t j = 0; j < cell->reactions; j++)
            values[total + reactions++] = cell->reaction_s[j];
    }
    c->toggles = stat_moments(values, toggles);
    stat_sort(values + total, reactions);
    c->reaction_median_s = stat_quantile(values + total, reactions, 0.5);
}

// `values` has room for two per cell.
static void finish_holm(struct choices *c, double *values)
{
    double *adjusted = values + c->cell_count;
    for (size_t i = 0; i < c->cell_count; i++)
        values[i] = c->cells[i].p_value;
    stat_adjust_holm(values, c->cell_count, adjusted);
    for (size_t i = 0; i < c->cell_count; i++)
        c->cells[i].holm = adjusted[i];
}

static bool finish(struct choices *c, const struct choices_desc *desc)
{
    size_t total = 0;
    for (size_t i = 0; i < c->cell_count; i++)
        total += c->cells[i].answers;
    double *values = malloc((2 * total + 1) * sizeof *values); // a cell has an answer at least
    if (!values)
        return false;
    for (size_t i = 0; i < c->cell_count; i++) {
        struct choice_cell *cell = &c->cells[i];
        finish_cell(cell, desc);
        c->several = c->several || cell->several;
        c->one_each = c->one_each || (cell->n > 0 && !cell->several);
        c->tested += isnan(cell->p_value) ? 0 : 1; // as Holm's procedure counts them
    }
    finish_totals(c, values, total);
    finish_holm(c, values);
    free(values);
    if (c->cell_count > 1)
        qsort(c->cells, c->cell_count, sizeof c->cells[0], by_levels);
    for (size_t i = 0; i < c->cell_count; i++)
        c->cells[i].name_block = strcmp(c->cells[0].block, c->cells[c->cell_count - 1].block) != 0;
    return choices_contrast(c);
}

bool choices_load(struct choices *out, struct sample *sample, double conf, char *error, size_t error_size)
{
    return choices_load_for(out, sample, &(struct choices_desc){.conf = conf}, error, error_size);
}

bool choices_load_for(struct choices *out, struct sample *sample, const struct choices_desc *desc, char *error,
                      size_t error_size)
{
    struct choices_desc d = {desc->conf == 0 ? 0.95 : desc->conf, desc->p0 == 0 ? 0.5 : desc->p0,
                             desc->alternative};
    *out = (struct choices){.conf = d.conf, .p0 = d.p0, .alternative = d.alternative};
    bool ok = true;
    snprintf(error, error_size, "not enough memory");
    for (size_t i = 0; ok && i < sample->file_count; i++) {
        struct filling f = {out, sample, i};
        ok = store_read_trials(sample->files[i], add_trial, &f);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    for (size_t i = 0; ok && i < sample->file_count; i++) { // once every file's cells are known
        ok = choices_plan(out, sample, i);
        if (!ok && store_reader_error(sample->files[i])[0])
            snprintf(error, error_size, "%s", store_reader_error(sample->files[i]));
    }
    if (ok && tell_apart(out, sample) && finish(out, &d)) {
        error[0] = '\0';
        return true;
    }
    choices_free(out);
    return false;
}

void choices_free(struct choices *choices)
{
    for (size_t i = 0; i < choices->cell_count; i++) {
        free(choices->cells[i].person);
        free(choices->cells[i].counts);
        free(choices->cells[i].equals);
        free(choices->cells[i].planned);
        free(choices->cells[i].toggle);
        free(choices->cells[i].reaction_s);
    }
    free(choices->cells);
    free(choices->contrasts);
    *choices = (struct choices){0};
}
