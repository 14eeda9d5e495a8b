// Who was to answer what, from the trials that sessions planned.
#include "analysis/report/sample_private.h"

#include <string.h>

struct filling {
    struct sample *sample;
    size_t file;
};

static struct sample_cell *find_cell(struct sample *sample, const struct store_trial_row *row)
{
    for (size_t i = 0; i < sample->cell_count; i++) {
        struct sample_cell *cell = &sample->cells[i];
        if (strcmp(cell->block, row->block) == 0 && strcmp(cell->factors, row->factors) == 0 &&
            strcmp(cell->scene, row->scene) == 0)
            return cell;
    }
    struct sample_cell cell = {.block = row->block, .factors = row->factors, .scene = row->scene};
    const char **texts[] = {&cell.block, &cell.factors, &cell.scene};
    if (!sample_keep_all(sample, texts, 3) ||
        !sample_grow(&sample->cells, sample->cell_count, sizeof sample->cells[0]))
        return NULL;
    sample->cells[sample->cell_count] = cell;
    return &sample->cells[sample->cell_count++];
}

static bool add_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    size_t session = sample_any_session(f->sample, f->file, row->session_id);
    if (session == SAMPLE_NONE || strcmp(row->kind, "practice") == 0 || strcmp(row->kind, "catch") == 0 ||
        strcmp(row->kind, "null") == 0)
        return true;
    struct sample_cell *cell = find_cell(f->sample, row);
    if (!cell)
        return false;
    for (size_t i = cell->session_count; i-- > 0;) // the last one mostly
        if (cell->sessions[i] == session)
            return true;
    if (!sample_grow(&cell->sessions, cell->session_count, sizeof cell->sessions[0]))
        return false;
    cell->sessions[cell->session_count++] = session;
    return true;
}

bool sample_read_cells(struct sample *sample, size_t file)
{
    return store_read_trials(sample->files[file], add_trial, &(struct filling){sample, file});
}
