// The parts of `fovstats ratings`, shared by ratings*.c only.
#ifndef ANALYSIS_TOOLS_RATINGS_PARTS_H
#define ANALYSIS_TOOLS_RATINGS_PARTS_H

#include "analysis/report/ratings.h"
#include "analysis/tools/json.h"
#include "analysis/tools/table.h"

// False where memory ran out.
bool ratings_print_options(const struct sample *sample, const struct rating_options *q, double conf);
bool ratings_print_factorial(const struct sample *sample, const struct factorial *f, double conf);

// Cells of numbers: a dash where there is none; a small p as a bound, not as 0.
void ratings_number(struct table *t, const char *format, double value);
void ratings_interval(struct table *t, double low, double high);
void ratings_p(struct table *t, double p);

void ratings_options_json(struct json *json, const struct sample *sample, const struct rating_options *q);
void ratings_factorial_json(struct json *json, const struct sample *sample, const struct factorial *f);

void ratings_ttest_json(struct json *json, const char *key, const struct stat_ttest *t);
void ratings_rank_json(struct json *json, const char *key, const struct stat_wilcoxon *w);
void ratings_effect_json(struct json *json, const char *key, const struct stat_effect *e);

#endif
