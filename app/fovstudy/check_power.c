#include "app/fovstudy/check_power.h"

#include <stdlib.h>
#include <string.h>

struct tally {
    struct check_analyses *out;
    struct check_values *values; // of each analysis
    uint32_t person;             // from 0
};

static bool count_plan(void *user, const struct plan *plan)
{
    struct tally *tally = user;
    bool ok = true;
    for (uint32_t a = 0; ok && a < tally->out->count; a++)
        ok = tally->out->each[a].test == CHECK_ESTIMATE || tally->out->each[a].none ||
             check_values_add(&tally->values[a], tally->out->each[a].planned, plan, tally->person);
    tally->person++;
    return ok;
}

// What the language permits and nothing can mean, as analysis/report/planned.c has it.
static const char *senseless(const struct protocol_analysis *a)
{
    bool rating = strcmp(a->of, "rating") == 0, paired = strcmp(a->method, "paired_t") == 0,
         unpaired = strcmp(a->method, "unpaired_t") == 0,
         whole = *a->per == '\0' || strcmp(a->per, "study") == 0;
    if (strcmp(a->method, "binomial") == 0 && strcmp(a->of, "choice") != 0)
        return "a binomial test counts choices; these values have means";
    if (strcmp(a->per, "order") == 0 && !rating)
        return "only ratings before and after have an order of people";
    if (unpaired && whole)
        return "all people together are one group; plan it per factor, scene or order";
    if (paired && whole && !rating)
        return "one value per person makes no pair; plan it per factor, scene or cell";
    return NULL;
}

static enum check_test test_of(const char *method)
{
    return strcmp(method, "binomial") == 0     ? CHECK_BINOMIAL
           : strcmp(method, "paired_t") == 0   ? CHECK_PAIRED_T
           : strcmp(method, "unpaired_t") == 0 ? CHECK_TWO_SAMPLE_T
                                               : CHECK_ESTIMATE;
}

bool check_analyses_init(struct check_analyses *out, const struct protocol *protocol, uint64_t seed,
                         uint32_t people)
{
    struct check_values values[PROTOCOL_ANALYSES] = {{0}};
    struct tally tally = {.out = out, .values = values};
    *out = (struct check_analyses){.count = protocol->analysis_count};
    for (uint32_t i = 0; i < out->count; i++) {
        struct check_analysis *analysis = &out->each[i];
        analysis->planned = &protocol->analyses[i];
        analysis->test = test_of(analysis->planned->method);
        analysis->none = senseless(analysis->planned);
        values[i].people = people;
    }
    bool ok = plan_each(protocol, seed, 0, people, count_plan, &tally);
    for (uint32_t i = 0; i < out->count; i++) {
        if (ok && out->each[i].test != CHECK_ESTIMATE && !out->each[i].none)
            ok = check_tests(&out->each[i], &values[i]);
        check_values_finish(&values[i]);
    }
    return ok;
}

void check_analyses_finish(struct check_analyses *analyses)
{
    for (uint32_t i = 0; i < analyses->count; i++)
        free(analyses->each[i].parts);
    *analyses = (struct check_analyses){0};
}
