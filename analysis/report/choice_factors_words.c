// What a test is called and what is to be said beside it.
#include "analysis/report/choice_factors.h"

#include <stdio.h>
#include <string.h>

const char *choice_factor_word(enum choice_factor_method method)
{
    static const char *const words[] = {[FACTOR_FISHER] = "Fisher",
                                        [FACTOR_EXCHANGE] = "exchange of people",
                                        [FACTOR_MCNEMAR] = "McNemar",
                                        [FACTOR_COCHRAN] = "Cochran's Q"};
    return words[method];
}

void choice_factor_words(const struct choice_factor_test *x, char out[CHOICE_FACTOR_WORDS])
{
    snprintf(out, CHOICE_FACTOR_WORDS, "%s%s%s", x->name_block ? x->block : "", x->name_block ? ": " : "",
             x->factor);
    for (size_t i = 0; i < x->levels; i++) {
        size_t used = strlen(out);
        snprintf(out + used, CHOICE_FACTOR_WORDS - used, "%s%s",
                 i == 0              ? " "
                 : i + 1 < x->levels ? ", "
                                     : " and ",
                 x->level[i]);
    }
    size_t used = strlen(out);
    if (x->where[0])
        snprintf(out + used, CHOICE_FACTOR_WORDS - used, ", at %s", x->where);
}

void choice_factor_note(const struct choice_factor_test *x, char out[CHOICE_FACTOR_NOTE])
{
    const bool within = x->design.within;
    out[0] = '\0';
    if (x->design.one && x->design.several)
        snprintf(out, CHOICE_FACTOR_NOTE,
                 "%zu %s to answer at one level and %zu at several, so it is compared %s people", x->design.one,
                 x->design.one == 1 ? "person was" : "people were", x->design.several,
                 within ? "within" : "between");
    size_t used = strlen(out);
    if (x->left_out)
        snprintf(out + used, CHOICE_FACTOR_NOTE - used, "%sleft out, people %s: %zu", used ? "; " : "",
                 within ? "without an answer at every level" : "with answers at several levels", x->left_out);
}
