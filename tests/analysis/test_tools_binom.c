// fovstats binom: numbers against R and exact integers, text against golden files.
#include "program.h"
#include "reference.h"
#include "said.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

static void binom_prints(void **state)
{
    (void)state;
    struct program_result r = FOVSTATS("binom", "6", "22");
    assert_int_equal(r.code, 0);
    said_golden(r.out, "binom.txt");
    assert_string_equal(r.err, "");
    program_free(&r);
    r = FOVSTATS("binom", "4", "19", "--json");
    assert_int_equal(strncmp(r.out, "{\"k\":4,\"n\":19,\"p0\":0.5,\"p_value\":", 33), 0);
    said_number(r.out, "{", "p_value", "cell2.p_value");
    said_number(r.out, "{", "ci_low", "cell2.ci_low");
    said_number(r.out, "{", "ci_high", "cell2.ci_high");
    assert_true(said_after(r.out, "{", "null_low") == 5 && said_after(r.out, "{", "null_high") == 14);
    assert_true(reference_close(said_after(r.out, "{", "estimate"), 4.0 / 19, 1e-15));
    program_free(&r);
    r = FOVSTATS("binom", "3", "10", "--p", "0.2", "--alternative", "greater", "--conf", "0.9", "--json");
    assert_int_equal(r.code, 0);
    // R: binom.test(3, 10, 0.2, "greater", 0.9)
    assert_true(reference_close(said_after(r.out, "{", "p_value"), 0.32220047360000004, 1e-12));
    assert_true(said_after(r.out, "{", "ci_high") == 1);
    program_free(&r);
}

static void binom_prints_all(void **state)
{
    (void)state;
    struct program_result r =
        FOVSTATS("binom", "6", "22", "--mid-p", "--margin", "0.1", "--prior", "2,7", "--share", "0.75");
    assert_int_equal(r.code, 0);
    said_golden(r.out, "binom_all.txt");
    program_free(&r);
    // row(6, 22, 0.5, 0.95, 0.1) of tests/reference/binomial_exact.py; 30 and 35 are counts.R's
    r = FOVSTATS("binom", "6", "22", "--margin", "0.1", "--prior", "2,7", "--share", "0.75", "--json");
    assert_true(reference_close(said_after(r.out, "{", "ln_p"), -2.94734618561802, 1e-12));
    assert_true(reference_close(log(said_after(r.out, "{", "mid_p")), -3.3613134796009644, 1e-12));
    assert_true(reference_close(said_after(r.out, "{", "wilson_low"), 0.13150760287989472, 1e-12));
    assert_true(reference_close(said_after(r.out, "{", "jeffreys_high"), 0.47823117669052994, 1e-12));
    assert_true(reference_close(said_after(r.out, "{", "ln_bf10"), 1.6126960271244198, 1e-12));
    assert_true(
        reference_close(log(said_after(r.out, "equivalence", "p_value")), -0.074967491637748123, 1e-12));
    assert_true(said_after(r.out, "power", "n_first") == 30 && said_after(r.out, "power", "n_stays") == 35);
    assert_non_null(strstr(r.out, "\"shown\":\"undecided\""));
    program_free(&r);
    r = FOVSTATS("binom", "0", "100000"); // 2^-99999
    assert_non_null(strstr(r.out, "p            2.002e-30103\n"));
    assert_null(strstr(r.out, "equality")); // a difference is shown
    program_free(&r);
}

// No difference is never said to be equality, and equality only where the margin's test shows it.
static void no_difference_is_not_equality(void **state)
{
    (void)state;
    const struct {
        const char *k, *n, *margin, *says;
    } cases[] = {{"11", "22", NULL, "equality     not shown"},
                 {"11", "22", "0.1", "neither a difference nor equality"},
                 {"500", "1000", "0.05", "so           equality within the margin is shown"},
                 {"540", "1000", "0.1", "a difference is shown, and that it is within the margin"},
                 {"600", "1000", "0.05", "a difference is shown, and not that it is within the margin"}};
    for (int i = 0; i < 5; i++) {
        struct program_result r = cases[i].margin
                                      ? FOVSTATS("binom", cases[i].k, cases[i].n, "--margin", cases[i].margin)
                                      : FOVSTATS("binom", cases[i].k, cases[i].n);
        if (r.code != 0 || !strstr(r.out, cases[i].says))
            fail_msg("%s of %s: no \"%s\" in %s", cases[i].k, cases[i].n, cases[i].says, r.out);
        program_free(&r);
    }
}

// At 0 and 1 any margin would leave what probabilities can be: none is advised that is then refused.
static void no_margin_is_advised_where_none_fits(void **state)
{
    (void)state;
    const char *const cases[][2] = {{"0", "0"}, {"10", "1"}};
    for (int i = 0; i < 2; i++) {
        struct program_result r = FOVSTATS("binom", cases[i][0], "10", "--p", cases[i][1]);
        assert_non_null(
            strstr(r.out, i ? "no margin fits around a p0 of 1\n" : "no margin fits around a p0 of 0\n"));
        assert_null(strstr(r.out, "--margin"));
        program_free(&r);
        said_sentence(FOVSTATS("binom", cases[i][0], "10", "--p", cases[i][1], "--margin", "0.1"), 2,
                      "--margin is");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(binom_prints),
        cmocka_unit_test(binom_prints_all),
        cmocka_unit_test(no_difference_is_not_equality),
        cmocka_unit_test(no_margin_is_advised_where_none_fits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
