#include "analysis/tools/binomial_json.h"

#include <math.h>

void binomial_json(struct json *json, const struct stat_binomial *test)
{
    json_integer(json, "k", test->k);
    json_integer(json, "n", test->n);
    json_number(json, "p0", test->p0);
    json_number(json, "p_value", test->p_value);
    json_number(json, "estimate", test->estimate);
    json_number(json, "ci_low", test->ci.low);
    json_number(json, "ci_high", test->ci.high);
    bool any = test->null_region.low <= test->null_region.high; // not where n is 0
    json_number(json, "null_low", any ? (double)test->null_region.low : (double)NAN);
    json_number(json, "null_high", any ? (double)test->null_region.high : (double)NAN);
}
