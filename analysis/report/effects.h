// Effects on choices that are no preference: of the side, the order, the place in the session, the previous
// answer, and how often and how long the options were looked at.
//
// Counted are the choices of choices.h that are for one of the two options. Each check gives every person one
// value that is 0 on average where there is no such effect, whatever the person prefers; answers are never
// pooled over people:
//   side, first, last: the share of choices of slot a, of the option shown first, and of the one on screen when
//   the answer came, less one half: the mean of the shares among trials in which that was the test option and
//   among those in which it was not, so that no preference counts; of people who had one of the two at least
//   half as often as the other
//
//   place: share for the test option in the later less that in the earlier half of each sitting's choices
//
//   repetition: share of choices of the same slot as the choice before in the sitting, less what is expected
//   where the sitting's choices come in random order
//
//   toggles: mean switches before choosing the test option less those before choosing the other
//
//   viewing: mean share of viewing time, free of fades, that the test option had where it was chosen, less the
//   same where it was not
//
// Whoever has no such value (always one side, always the same answer) is left out of that check and counted.
// The test is the sign-flip test over people, above STAT_FLIP_VALUES people Student's t; the interval is
// t's. Holm's p is over the checks that have a p: the family. Choosing what was looked at last or longest may
// be a habit of looking at what one prefers: an effect of that kind is no proof of a bias.
#ifndef ANALYSIS_REPORT_EFFECTS_H
#define ANALYSIS_REPORT_EFFECTS_H

#include "analysis/report/sample.h"
#include "analysis/stats/signflip_values.h"
#include "analysis/stats/ttest.h"

enum effect_check {
    EFFECT_SIDE,
    EFFECT_FIRST,
    EFFECT_LAST,
    EFFECT_PLACE,
    EFFECT_REPETITION,
    EFFECT_TOGGLES,
    EFFECT_VIEWING,
    EFFECT_CHECKS
};

struct effect {
    size_t people, left_out; // with a value; with choices and without one
    double estimate;         // mean of the people's values, a share or a number of switches; NaN without people
    double d;                // over the SD of the values; NaN for fewer than two people or an SD of 0
    struct stat_ttest t;     // its interval; NaN as in ttest.h
    struct stat_flip_values flip;
    bool exact;     // p is the sign-flip test's
    double p_value; // NaN for fewer than two people, and where every value is 0
    double holm;
};

struct effects {
    double conf;
    int64_t choices;
    size_t tested; // checks with a p
    struct effect checks[EFFECT_CHECKS];
};

const char *effect_key(enum effect_check check);   // "side", for JSON
const char *effect_words(enum effect_check check); // "slot a chosen"
const char *effect_null(enum effect_check check);  // what nobody has where it cannot be estimated, a sentence
// An estimate or a bound as it is printed: shares about one half in percent, others in points or switches.
double effect_shown(enum effect_check check, double value);
const char *effect_unit(enum effect_check check); // "%", "points", "switches"

bool effects_load(struct effects *out, struct sample *sample, double conf, char *error, size_t error_size);

#endif
