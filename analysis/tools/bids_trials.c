// events.tsv and beh.tsv of each run. Rows come table by table and are sorted by their time, so they are held:
// answers, trials and exposures are few beside gaze and frames, which are not.
#include "analysis/report/sample.h"
#include "analysis/tools/bids_private.h"

#include <stdlib.h>
#include <string.h>

struct line {
    size_t run, order;
    int64_t at_ns;
    char *text;
};

struct file {
    struct bids *bids;
    const char *suffix;         // "events", "beh"
    const char *const *columns; // names in the header
    size_t column_count;
    const char *kind; // of the rows that are read now
    struct line *lines;
    size_t line_count;
};

static const char *const event_columns[] = {
    "onset",         "duration",   "trial_type",      "trial_id",   "ordinal",
    "block",         "trial_kind", "scene",           "factors",    "option_a",
    "option_b",      "test_slot",  "first_shown",     "shown_slot", "trial_status",
    "attempt",       "parameter",  "parameter_value", "excluded",   "excluded_stricter",
    "excluded_rules"};

static const char *const answer_columns[] = {"answer_time",
                                             "answer",
                                             "trial_id",
                                             "ordinal",
                                             "block",
                                             "trial_kind",
                                             "scene",
                                             "factors",
                                             "trial_status",
                                             "attempt",
                                             "question",
                                             "chosen",
                                             "chosen_slot",
                                             "correct",
                                             "response_time",
                                             "toggles",
                                             "rating",
                                             "scale_min",
                                             "scale_max",
                                             "rated_subject",
                                             "response",
                                             "expected",
                                             "input_device",
                                             "level",
                                             "outcome",
                                             "reversal",
                                             "estimate",
                                             "condition_id",
                                             "test_condition_id",
                                             "reference_condition_id",
                                             "excluded",
                                             "excluded_stricter",
                                             "excluded_rules"};

static void write_seconds(FILE *out, const struct store_cell *cell)
{
    char text[CELL_SECONDS_SIZE];
    bool known = cell && cell->kind == STORE_CELL_INTEGER;
    fputs(known ? cell_seconds(cell->integer, text) : "n/a", out);
}

// Which column of the table holds a time of the row: its begin, and its end where it has one.
static const struct store_cell *begin_of(const struct store_cell *cells, size_t count)
{
    static const char *const names[] = {"answered_ns", "started_ns", "start_ns", "at_ns"};
    const struct store_cell *found = NULL;
    for (size_t i = 0; !found && i < sizeof names / sizeof names[0]; i++)
        found = cell_find(cells, count, names[i]);
    return found;
}

static void write_duration(FILE *out, const struct store_cell *cells, size_t count)
{
    const struct store_cell *begin = begin_of(cells, count), *end = cell_find(cells, count, "ended_ns");
    if (!end)
        end = cell_find(cells, count, "end_ns");
    char text[CELL_SECONDS_SIZE];
    if (begin && end && end->integer >= begin->integer)
        fputs(cell_seconds(end->integer - begin->integer, text), out);
    else if (begin && cell_find(cells, count, "at_ns"))
        fputs("0", out); // an instant
    else
        fputs("n/a", out);
}

static char *make_line(const struct file *f, const struct store_cell *cells, size_t count)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    for (size_t i = 0; i < f->column_count; i++) {
        const char *name = f->columns[i];
        if (i)
            fputc('\t', out);
        if (strcmp(name, "onset") == 0 || strcmp(name, "answer_time") == 0)
            write_seconds(out, begin_of(cells, count));
        else if (strcmp(name, "duration") == 0)
            write_duration(out, cells, count);
        else if (strcmp(name, "response_time") == 0)
            write_seconds(out, cell_find(cells, count, "reaction_ns"));
        else if (strcmp(name, "trial_type") == 0 || strcmp(name, "answer") == 0)
            fputs(f->kind, out);
        else
            cell_write_tsv(out, cell_find(cells, count, name));
    }
    fputc('\n', out);
    if (fclose(out) == 0)
        return text;
    free(text);
    return NULL;
}

static bool add_line(void *user, bool header, const struct store_cell *cells, size_t count)
{
    struct file *f = user;
    if (header)
        return true;
    // Steps of a staircase have no time of their own: they stand where their trial ended.
    const struct bids_trial *trial = bids_find_trial(f->bids, cell_integer(cells, count, "trial_id", 0));
    const struct store_cell *segment = cell_find(cells, count, "segment_id"), *begin = begin_of(cells, count);
    size_t run = segment ? bids_find_run(f->bids, segment->integer) : trial ? trial->run : SIZE_MAX;
    if (run == SIZE_MAX || (f->columns == event_columns && !begin))
        return true; // a trial that was never started
    if (!sample_grow(&f->lines, f->line_count, sizeof *f->lines))
        return false;
    struct line line = {run, f->line_count,
                        begin   ? begin->integer
                        : trial ? trial->ended_ns
                                : 0,
                        make_line(f, cells, count)};
    if (!line.text)
        return false;
    f->lines[f->line_count++] = line;
    return true;
}

static int compare(const void *a, const void *b)
{
    const struct line *x = a, *y = b;
    if (x->run != y->run)
        return x->run < y->run ? -1 : 1;
    if (x->at_ns != y->at_ns)
        return x->at_ns < y->at_ns ? -1 : 1;
    return x->order < y->order ? -1 : x->order > y->order;
}

static bool describe(struct file *f, size_t task)
{
    struct bids *b = f->bids;
    char name[BIDS_PATH_SIZE];
    snprintf(name, sizeof name, "task-%s_%s.json", b->tasks.items[task].label, f->suffix);
    FILE *out = bids_open(b, name);
    if (!out)
        return false;
    struct json json = {out, false};
    json_open(&json, NULL, '{');
    if (f->columns != event_columns) // bids-validator 1.15 takes it for a column there; BIDS only recommends it
        json_text(&json, "TaskName", b->tasks.items[task].text);
    bids_describe(b, &json, f->columns, f->column_count);
    if (f->columns == event_columns) {
        json_open(&json, "StimulusPresentation", '{');
        json_text(&json, "SoftwareName", "fovstudy");
        json_close(&json, '}');
    }
    json_close(&json, '}');
    fputc('\n', out);
    return bids_close(b, out, name);
}

// The lines of one run; the index after them, or SIZE_MAX.
static size_t write_run(struct file *f, size_t from)
{
    char name[BIDS_PATH_SIZE], tail[32];
    snprintf(tail, sizeof tail, "%s.tsv", f->suffix);
    bids_run_name(f->bids, f->lines[from].run, tail, name);
    FILE *out = bids_open(f->bids, name);
    if (!out)
        return SIZE_MAX;
    for (size_t i = 0; i < f->column_count; i++)
        fprintf(out, "%s%s", i ? "\t" : "", f->columns[i]);
    fputc('\n', out);
    size_t i = from;
    for (; i < f->line_count && f->lines[i].run == f->lines[from].run; i++)
        fputs(f->lines[i].text, out);
    return bids_close(f->bids, out, name) ? i : SIZE_MAX;
}

static bool write_file(struct file *f, const char *const (*tables)[2], size_t table_count)
{
    bool ok = true;
    for (size_t i = 0; ok && i < table_count; i++) {
        f->kind = tables[i][1];
        ok = bids_read(f->bids, tables[i][0], add_line, f);
    }
    if (f->line_count)
        qsort(f->lines, f->line_count, sizeof *f->lines, compare);
    size_t at = 0;
    while (ok && at < f->line_count) {
        at = write_run(f, at);
        ok = at != SIZE_MAX;
    }
    for (size_t task = 0; ok && task < f->bids->tasks.count; task++)
        ok = describe(f, task);
    for (size_t i = 0; i < f->line_count; i++)
        free(f->lines[i].text);
    free(f->lines);
    return ok;
}

bool bids_write_trials(struct bids *b)
{
    static const char *const events[][2] = {
        {"trials", "trial"}, {"exposures", "exposure"}, {"adjustments", "adjust_step"}};
    static const char *const answers[][2] = {{"choices", "choice"},
                                             {"ratings", "rating"},
                                             {"responses", "response"},
                                             {"staircases", "staircase_step"}};
    struct file event = {.bids = b,
                         .suffix = "events",
                         .columns = event_columns,
                         .column_count = sizeof event_columns / sizeof event_columns[0]};
    struct file answer = {.bids = b,
                          .suffix = "beh",
                          .columns = answer_columns,
                          .column_count = sizeof answer_columns / sizeof answer_columns[0]};
    return write_file(&event, events, sizeof events / sizeof events[0]) &&
           write_file(&answer, answers, sizeof answers / sizeof answers[0]);
}
