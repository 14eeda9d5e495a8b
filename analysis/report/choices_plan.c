// Who was to answer in a cell.
#include "analysis/report/choices_private.h"

#include <string.h>

struct filling {
    struct choices *choices;
    const struct sample *sample;
    size_t file;
};

// In order: sessions come mostly by person, so that a new one goes to the end.
static bool add_person(struct choice_cell *cell, size_t person)
{
    size_t at = cell->planned_count;
    while (at > 0 && cell->planned[at - 1] > person)
        at--;
    if (at > 0 && cell->planned[at - 1] == person)
        return true;
    if (!sample_grow(&cell->planned, cell->planned_count, sizeof cell->planned[0]))
        return false;
    memmove(&cell->planned[at + 1], &cell->planned[at], (cell->planned_count - at) * sizeof cell->planned[0]);
    cell->planned[at] = person;
    cell->planned_count++;
    return true;
}

static bool add_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    size_t session = sample_find_session(f->sample, f->file, row->session_id);
    if (session == SAMPLE_NONE || (strcmp(row->kind, "toggle") != 0 && strcmp(row->kind, "sequential") != 0))
        return true;
    size_t test = sample_find_condition(f->sample, f->file, row->test_id);
    size_t reference = sample_find_condition(f->sample, f->file, row->reference_id);
    for (size_t i = 0; i < f->choices->cell_count; i++) {
        struct choice_cell *cell = &f->choices->cells[i];
        if (cell->test == test && cell->reference == reference && strcmp(cell->block, row->block) == 0 &&
            strcmp(cell->factors, row->factors) == 0 && !add_person(cell, f->sample->sessions[session].person))
            return false;
    }
    return true;
}

bool choices_plan(struct choices *choices, const struct sample *sample, size_t file)
{
    struct filling f = {choices, sample, file};
    return store_read_trials(sample->files[file], add_trial, &f);
}
