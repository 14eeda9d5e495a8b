// The parts of `fovstats ratings`, shared by ratings*.c only.
#ifndef ANALYSIS_TOOLS_RATINGS_PARTS_H
#define ANALYSIS_TOOLS_RATINGS_PARTS_H

#include "analysis/report/ratings.h"
#include "analysis/tools/json.h"

// False where memory ran out.
bool ratings_print_options(const struct sample *sample, const struct rating_options *q, double conf);
bool ratings_print_factorial(const struct sample *sample, const struct factorial *f, double conf);

void ratings_options_json(struct json *json, const struct sample *sample, const struct rating_options *q);
void ratings_factorial_json(struct json *json, const struct sample *sample, const struct factorial *f);

void ratings_ttest_json(struct json *json, const char *key, const struct stat_ttest *t);
void ratings_rank_json(struct json *json, const char *key, const struct stat_wilcoxon *w);
void ratings_effect_json(struct json *json, const char *key, const struct stat_effect *e);

#endif
