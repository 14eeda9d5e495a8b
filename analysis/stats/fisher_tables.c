// Fisher's exact test of tables larger than 2 x 2: Freeman, G. H. & Halton, J. H. (1951), Biometrika 38,
// 141-149.
//   Tables with the same margins are built column by column, without dead ends. After each column two bounds
//   may settle all its completions at once, as in Mehta, C. R. & Patel, N. R. (1983), Journal of the American
//   Statistical Association 78, 427-434: where even the most probable one counts, all do, and their sum is
//   known, N! / (prod r! prod c!) of what is left; where not even the least probable one counts, none does. The
//   most probable is bounded by Lagrange multipliers ln(r c / N), which are the solution but for rounding to
//   whole counts; the least by each row for itself (or each column), filled into as few cells as the other
//   margins let it. Ties as in fisher.c.
#include "analysis/stats/fisher.h"

#include <Rmath.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

struct walk {
    int rows, columns;
    int64_t row_left[STAT_COUNTS_MOST]; // what the columns so far leave of the rows
    int64_t column[STAT_COUNTS_MOST];   // descending
    const double *ln_factorial;         // borrowed
    double limit, p;
    int64_t steps;
};

static int descending(const void *a, const void *b)
{
    int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x < y) - (x > y);
}

// The largest sum of ln x! over one line that holds `left`, its cells at most `room`, which descends.
static double fullest(const struct walk *w, int64_t left, const int64_t *room, int cells)
{
    double sum = 0;
    for (int i = 0; i < cells && left > 0; i++) {
        int64_t x = left < room[i] ? left : room[i];
        sum += w->ln_factorial[x];
        left -= x;
    }
    return sum;
}

// No completion from `column` on has a larger sum of ln x!.
static double most_sum(const struct walk *w, int column)
{
    int64_t rows[STAT_COUNTS_MOST];
    double by_row = 0, by_column = 0;
    for (int i = 0; i < w->rows; i++) {
        rows[i] = w->row_left[i];
        by_row += fullest(w, w->row_left[i], w->column + column, w->columns - column);
    }
    qsort(rows, (size_t)w->rows, sizeof *rows, descending);
    for (int j = column; j < w->columns; j++)
        by_column += fullest(w, w->column[j], rows, w->rows);
    return by_row < by_column ? by_row : by_column;
}

// None has a smaller one: sum of ln x! - t x over the cells is least where x is the largest whole number below
// e^t.
static double least_sum(const struct walk *w, int column, double all)
{
    double sum = 0;
    for (int i = 0; i < w->rows; i++)
        for (int j = column; j < w->columns; j++) {
            double expected = (double)w->row_left[i] * (double)w->column[j] / all;
            if (expected > 0) {
                double t = log(expected), x = floor(expected);
                sum += w->ln_factorial[(int64_t)x] - t * x + t * expected;
            }
        }
    return sum;
}

// Whether bounds settle all completions of the first `column` columns; adds them where they count.
static bool settled(struct walk *w, int column, double ln_p)
{
    const double slack = 1e-9; // bounds are rounded; a table at the limit is looked at itself
    int64_t all = 0;
    double total = ln_p;
    for (int i = 0; i < w->rows; i++) {
        all += w->row_left[i];
        total -= w->ln_factorial[w->row_left[i]];
    }
    for (int j = column; j < w->columns; j++)
        total -= w->ln_factorial[w->column[j]];
    if (all == 0)
        return false;
    if (ln_p - least_sum(w, column, (double)all) <= w->limit - slack) {
        w->p += exp(total + w->ln_factorial[all]);
        return true;
    }
    return ln_p - most_sum(w, column) > w->limit + slack;
}

static void finish_table(struct walk *w, double ln_p)
{
    for (int i = 0; i < w->rows; i++)
        ln_p -= w->ln_factorial[w->row_left[i]];
    if (ln_p <= w->limit)
        w->p += exp(ln_p);
}

// Fills the cells from (row, column) on, `left` of the column being still to place. False where it takes too
// long.
static bool fill(struct walk *w, int row, int column, int64_t left, double ln_p)
{
    if (row == 0 && ++w->steps > STAT_FISHER_MAX_STEPS)
        return false;
    if (column == w->columns - 1) {
        finish_table(w, ln_p);
        return true;
    }
    if (row == 0 && settled(w, column, ln_p))
        return true;
    int64_t room = 0; // in the rows below
    for (int i = row + 1; i < w->rows; i++)
        room += w->row_left[i];
    int64_t least = left > room ? left - room : 0, most = left < w->row_left[row] ? left : w->row_left[row];
    bool go_on = true;
    for (int64_t x = least; x <= most && go_on; x++) {
        w->row_left[row] -= x;
        double with_cell = ln_p - w->ln_factorial[x];
        if (row == w->rows - 1)
            go_on = fill(w, 0, column + 1, w->column[column + 1], with_cell);
        else
            go_on = fill(w, row + 1, column, left - x, with_cell);
        w->row_left[row] += x;
    }
    return go_on;
}

// The shorter side becomes the rows: bounds then come more often.
static bool margins(struct stat_counts table, struct walk *w, int64_t *all)
{
    *all = 0;
    if (!table.counts || table.rows < 2 || table.columns < 2 || table.rows > STAT_COUNTS_MOST ||
        table.columns > STAT_COUNTS_MOST)
        return false;
    bool turned = table.rows > table.columns;
    w->rows = turned ? table.columns : table.rows;
    w->columns = turned ? table.rows : table.columns;
    for (int i = 0; i < table.rows; i++)
        for (int j = 0; j < table.columns; j++) {
            int64_t count = table.counts[i * table.columns + j];
            if (count < 0 || count > STAT_FISHER_MAX_N)
                return false;
            w->row_left[turned ? j : i] += count;
            w->column[turned ? i : j] += count;
            *all += count;
        }
    qsort(w->column, (size_t)w->columns, sizeof *w->column, descending);
    return *all > 0 && *all <= STAT_FISHER_MAX_N;
}

double stat_fisher_p(struct stat_counts table)
{
    struct walk w = {.steps = 0};
    int64_t all;
    if (!margins(table, &w, &all))
        return (double)NAN;
    double *ln_factorial = malloc((size_t)(all + 1) * sizeof *ln_factorial);
    if (!ln_factorial)
        return (double)NAN;
    for (int64_t i = 0; i <= all; i++)
        ln_factorial[i] = lgammafn((double)i + 1);
    w.ln_factorial = ln_factorial;
    double margin = -ln_factorial[all], ours = 0;
    for (int i = 0; i < w.rows; i++)
        margin += ln_factorial[w.row_left[i]];
    for (int j = 0; j < w.columns; j++)
        margin += ln_factorial[w.column[j]];
    for (int i = 0; i < w.rows * w.columns; i++)
        ours += ln_factorial[table.counts[i]];
    w.limit = margin - ours + log1p(1e-7);
    bool done = fill(&w, 0, 0, w.column[0], margin);
    free(ln_factorial);
    return !done ? (double)NAN : w.p < 1 ? w.p : 1;
}
