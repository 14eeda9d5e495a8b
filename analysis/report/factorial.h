// Ratings over crossed factors: analysis of variance within participants, means of levels, pairs of levels.
//
// One analysis per question and block. A person's ratings in one cell are averaged; a person without a rating
// in every cell is named and left out, nothing is filled. Factors with one level, and factors that follow from
// another one, are named and left out. Pairs of levels are tested where their factor's corrected p is at most
// 1 - conf. Does not: analyse factors that lie between people by the design (factor_design.h), whoever rated at
// several of their levels, and says so.
#ifndef ANALYSIS_REPORT_FACTORIAL_H
#define ANALYSIS_REPORT_FACTORIAL_H

#include "analysis/report/sample.h"
#include "analysis/stats/anova.h"
#include "analysis/stats/effect.h"
#include "analysis/stats/moments.h"
#include "analysis/stats/ttest.h"

enum { FACTORIAL_CELLS = 4096, FACTORIAL_KEYS = 16 };

struct factorial_pair {
    size_t a, b;               // levels
    struct stat_ttest test;    // level a less level b, of people's means over all other factors
    struct stat_effect effect; // d_z
    double p_holm;             // over the factor's pairs
};

struct factorial_factor {
    const char *name;
    size_t level_count;
    const char **levels;       // by number, else by alphabet
    double *mean, *half_width; // per level: what stat_within_intervals() says
    bool significant;
    size_t pair_count;
    struct factorial_pair *pairs; // none where the factor is not significant
};

struct factorial_rating {
    size_t person, cell; // of `texts`
    double value;
    size_t place; // of `cells`, where there is an analysis
};

struct factorial_left {     // an incomplete person
    size_t person, missing; // cells
};

struct factorial {
    const char *question, *block;
    double scale_min, scale_max;
    size_t rating_count;
    struct factorial_rating *ratings;
    size_t text_count;
    const char **texts; // the factors' JSON of each cell, as they came

    struct stat_moments overall; // of people's means over all their ratings, incomplete people too
    char refusal[256];           // why there is no analysis; "" where there is one
    char dropped[256];           // factors that are left out, and why; "" for none
    size_t factor_count;         // of those analysed
    struct factorial_factor factors[STAT_ANOVA_FACTORS];
    size_t cells;
    size_t people;                // complete ones
    double *values;               // people x cells
    size_t least, most;           // ratings that a complete person gave in one cell
    struct stat_moments *cell_of; // cells; the last factor's level runs fastest
    size_t left_count;
    struct factorial_left *left;
    struct stat_anova anova;
};

struct factorial_list {
    size_t count;
    struct factorial *items;
    int64_t used; // ratings
};

bool factorial_add(struct factorial_list *list, struct sample *sample, const struct store_rating_row *row,
                   size_t person); // false where memory ran out
bool factorial_finish(struct factorial_list *list, const struct sample *sample, double conf);
void factorial_free(struct factorial_list *list);

// Why there is no analysis, and what can be said nevertheless.
void factorial_refusal(const struct factorial *f, char out[512]);

// The names of factors whose own effect has no F, joined by commas: nothing spreads that it could be held
// against, as where everybody's ratings differ by the same. Such an effect may be perfect; it is not tested.
// Returns how many.
size_t factorial_untested(const struct factorial *f, char out[256]);

// "scene x region", for the bits of an effect; `cross` stands between names.
void factorial_effect_name(const struct factorial *f, unsigned factors, const char *cross, char out[256]);

#endif
