// What `fovstats binom` is asked and what it says.
#ifndef ANALYSIS_TOOLS_BINOM_PRINT_H
#define ANALYSIS_TOOLS_BINOM_PRINT_H

#include "analysis/stats/alternative.h"

#include <stdbool.h>
#include <stdint.h>

struct binom_request {
    int64_t k, n;
    double p0, conf; // alpha is 1 - conf
    enum stat_alternative alternative;
    bool mid_p;
    double margin;       // of equivalence; NaN: not asked
    double prior[2];     // Beta prior of the Bayes factor
    double share, power; // true share for power and sample size, NaN: not asked; the power wanted
};

// To stdout.
void binom_print_text(const struct binom_request *request);
void binom_print_json(const struct binom_request *request);

#endif
