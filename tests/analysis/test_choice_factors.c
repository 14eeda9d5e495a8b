// Levels of factors of one answer each, and between people, against R (tests/reference/choice_factors.R);
// whether a factor lies between or within people, from hand-made cells and from study files.
#include "analysis/report/choice_factors.h"
#include "program.h"
#include "reference.h"
#include "said.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PEOPLE = 30, LEVELS = 3 };

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

struct study {
    struct choices choices;
    struct choice_cell cells[LEVELS];
    struct stat_person counts[LEVELS][PEOPLE];
    size_t persons[LEVELS][PEOPLE];
    size_t planned[LEVELS][PEOPLE];
};

static const char *const names[LEVELS] = {"1", "2", "3"};

static void answer(struct study *s, int person, int level, int64_t k, int64_t n)
{
    struct choice_cell *cell = &s->cells[level - 1];
    cell->person[cell->people] = (size_t)person;
    cell->counts[cell->people++] = (struct stat_person){k, n};
    cell->chosen += k;
    cell->n += n;
}

// A person who was to answer at a level.
static void plan(struct study *s, int person, int level)
{
    struct choice_cell *cell = &s->cells[level - 1];
    cell->planned[cell->planned_count++] = (size_t)person;
}

static int yes(int p, int l)
{
    return (7 * p + 4 * l + p * l) % 5 < 2 + l % 2;
}

// The studies of choice_factors.R. Everybody with an answer was to give it, and within people everybody was to
// answer at every level.
static void make(struct study *s, const char *name)
{
    bool within = strncmp(name, "within", 6) == 0, several = strcmp(name, "several2") == 0;
    int levels = name[strlen(name) - 1] - '0';
    int people = !within ? (several ? 9 : 17) : levels == 2 ? 18 : 8;
    *s = (struct study){.choices = {.conf = 0.95, .cell_count = (size_t)levels, .cells = s->cells}};
    for (int l = 0; l < LEVELS; l++)
        s->cells[l] = (struct choice_cell){.block = "main",
                                           .levels = {{"a", names[l], l + 1}},
                                           .level_count = 1,
                                           .person = s->persons[l],
                                           .counts = s->counts[l],
                                           .planned = s->planned[l]};
    for (int p = 1; p <= people; p++)
        for (int l = 1; l <= levels; l++) {
            if (!within && l != (levels == 3 ? p % 3 + 1 : p % 2 ? 1 : 2))
                continue;
            plan(s, p, l);
            if (several)
                answer(s, p, l, (3 * p + 4 * (p % 2) + 1) % 11, 10);
            else if (!within || p < 18 || l == 1)
                answer(s, p, l, yes(p, l), 1);
        }
}

// Somebody who was to answer at all levels and did, `n` times each.
static void add_stray(struct study *s, int person, int64_t n)
{
    for (int l = 1; l <= (int)s->choices.cell_count; l++) {
        plan(s, person, l);
        answer(s, person, l, l == 1 ? n : 0, n);
    }
}

static struct choice_factors load(const struct study *s, size_t tests)
{
    struct choice_factors f;
    assert_true(choice_factors_load(&f, &s->choices));
    assert_int_equal(f.count, tests);
    return f;
}

static const struct choice_factor_test *find(const struct choice_factors *f, const char *a, const char *b)
{
    for (size_t i = 0; i < f->count; i++) {
        const struct choice_factor_test *x = &f->tests[i];
        if (x->levels == 2 ? strcmp(x->level[0], a) == 0 && strcmp(x->level[1], b) == 0 : a[0] == '0')
            return x;
    }
    fail_msg("no test of %s and %s", a, b);
    return NULL;
}

// The rows of choice_factors.csv, each of a study to which `strays` people were added who do not fit its
// design.
static void agree(int strays)
{
    FILE *file = reference_open("choice_factors.csv");
    char line[1024];
    assert_non_null(fgets(line, sizeof line, file));
    size_t rows = 0;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *rest = line;
        const char *name = reference_field(&rest, ','), *a = reference_field(&rest, ','),
                   *b = reference_field(&rest, ',');
        struct study s;
        make(&s, name);
        if (strays && strncmp(name, "within", 6) == 0)
            continue;
        for (int i = 0; i < strays; i++)
            add_stray(&s, 20 + i, strcmp(name, "several2") == 0 ? 10 : 1);
        struct choice_factors f = load(&s, name[strlen(name) - 1] == '3' ? 4 : 1);
        const struct choice_factor_test *x = find(&f, a, b);
        const double got[] = {(double)x->people, x->p_value, x->statistic,  x->p_asymptotic, x->difference,
                              x->ci.low,         x->ci.high, x->odds_ratio, x->odds_ci.low,  x->odds_ci.high};
        for (int i = 0; i < 10; i++) {
            double known = reference_number(reference_field(&rest, ','));
            // fisher.test finds the odds ratio and its ends to 1.22e-4 (uniroot)
            double within = strncmp(name, "between", 7) == 0 && i >= 7 ? 1e-3 : 1e-10;
            if (!(isnan(known) && isnan(got[i])) && !(fabs(got[i] - known) <= within * fmax(1, fabs(known))))
                fail_msg("%s %s %s, value %d: %.17g, R %.17g", name, a, b, i, got[i], known);
        }
        assert_true(x->p_error == 0 && x->none[0] == '\0');
        if (strays)
            assert_int_equal(x->left_out, strays);
        choice_factors_free(&f);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, strays ? 6 : 11);
}

static void agrees_with_r(void **state)
{
    (void)state;
    agree(0);
}

// One or a few people at several levels of a factor between people change no number: they are left out and
// counted.
static void strays_change_nothing(void **state)
{
    (void)state;
    agree(1);
    agree(8);
    struct study s;
    make(&s, "between2");
    add_stray(&s, 20, 3); // several answers, of nobody who is tested: still one answer each
    struct choice_factors f = load(&s, 1);
    assert_int_equal(f.tests[0].method, FACTOR_FISHER);
    assert_true(f.tests[0].design.one == 17 && f.tests[0].design.several == 1);
    char note[CHOICE_FACTOR_NOTE], words[CHOICE_FACTOR_WORDS];
    choice_factor_words(&f.tests[0], words);
    choice_factor_note(&f.tests[0], note);
    assert_string_equal(words, "a 1 and 2");
    assert_string_equal(note,
                        "17 people were to answer at one level and 1 at several, so it is compared between "
                        "people; left out, people with answers at several levels: 1");
    choice_factors_free(&f);
    make(&s, "several2"); // nor do they make a contrast of two people
    add_stray(&s, 20, 10);
    add_stray(&s, 21, 10);
    for (int l = 0; l < 2; l++)
        s.cells[l].several = true;
    assert_true(choices_contrast(&s.choices));
    assert_int_equal(s.choices.contrast_count, 0);
    free(s.choices.contrasts);
}

// Many who stopped after the first level do not make a factor one between people.
static void dropouts_change_nothing(void **state)
{
    (void)state;
    struct study s, all;
    make(&all, "within2");
    make(&s, "within2");
    for (int p = 19; p < PEOPLE; p++) {
        plan(&s, p, 1);
        plan(&s, p, 2);
        answer(&s, p, 1, 1, 1);
    }
    struct choice_factors f = load(&s, 1), g = load(&all, 1);
    assert_int_equal(f.tests[0].method, FACTOR_MCNEMAR);
    assert_true(f.tests[0].people == 17 && f.tests[0].left_out == 12 && g.tests[0].left_out == 1);
    assert_true(f.tests[0].p_value == g.tests[0].p_value && f.tests[0].ci.low == g.tests[0].ci.low);
    assert_true(f.tests[0].design.one == 0 && f.tests[0].design.within);
    choice_factors_free(&f);
    choice_factors_free(&g);
}

// Half of the people decide: as many at several levels as at one make it one within people.
static void most_people_decide(void **state)
{
    (void)state;
    for (int strays = 16; strays <= 18; strays++) {
        struct study s;
        make(&s, "between2");
        s.choices.cell_count = 2;
        for (int l = 0; l < 2; l++)
            s.cells[l].people = s.cells[l].planned_count = 0;
        for (int i = 0; i < 12; i++) {
            plan(&s, i, 1 + i % 2);
            answer(&s, i, 1 + i % 2, i % 3 == 0, 1);
        }
        for (int i = 0; i < strays - 5; i++)
            add_stray(&s, 12 + i, 1);
        struct choice_factors f = load(&s, 1);
        assert_true(f.tests[0].design.one == 12 && f.tests[0].design.several == (size_t)strays - 5);
        assert_int_equal(f.tests[0].method, strays - 5 >= 12 ? FACTOR_MCNEMAR : FACTOR_FISHER);
        assert_int_equal(f.tests[0].left_out, strays - 5 >= 12 ? 12 : strays - 5);
        choice_factors_free(&f);
    }
}

static void method_follows_from_the_data(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum choice_factor_method method;
        size_t left_out;
    } cases[] = {{"within2", FACTOR_MCNEMAR, 1},
                 {"within3", FACTOR_COCHRAN, 0},
                 {"between2", FACTOR_FISHER, 0},
                 {"between3", FACTOR_FISHER, 0},
                 {"several2", FACTOR_EXCHANGE, 0}};
    for (size_t i = 0; i < 5; i++) {
        struct study s;
        make(&s, cases[i].name);
        struct choice_factors f = load(&s, cases[i].name[strlen(cases[i].name) - 1] == '3' ? 4 : 1);
        assert_int_equal(f.tests[0].method, cases[i].method);
        assert_int_equal(f.tests[0].left_out, cases[i].left_out);
        assert_true(f.tests[0].holm == f.tests[0].p_value); // one set
        for (size_t k = 1; k < f.count; k++)
            assert_true(f.tests[k].pair && f.tests[k].holm >= f.tests[k].p_value);
        choice_factors_free(&f);
    }
}

// Sets that are not of this kind give no row.
static void other_sets_are_left_alone(void **state)
{
    (void)state;
    struct study s;
    make(&s, "within2");
    s.counts[0][0] = (struct stat_person){1, 2}; // several answers within people: contrasts
    struct choice_factors f = load(&s, 0);
    choice_factors_free(&f);
    make(&s, "within2");
    s.cells[1].levels[0].value = "1"; // two cells of one name
    f = load(&s, 0);
    choice_factors_free(&f);
}

static void expect_none(const struct choice_factor_test *x, const char *words, const char *why)
{
    char got[CHOICE_FACTOR_WORDS];
    choice_factor_words(x, got);
    assert_string_equal(got, words);
    assert_string_equal(x->none, why);
    assert_true(isnan(x->p_value) && isnan(x->holm));
}

// Where there is no test, what it is about and why there is none.
static void nothing_is_invented(void **state)
{
    (void)state;
    struct study s;
    make(&s, "several2");
    for (int l = 0; l < 2; l++)
        for (size_t i = 0; i < s.cells[l].people; i++)
            s.counts[l][i].k = 10;
    struct choice_factors f = load(&s, 1);
    expect_none(&f.tests[0], "a 1 and 2", "all answers are the same");
    choice_factors_free(&f);
    make(&s, "within3"); // nobody at levels 1 and 3, four at 1 and 2, four at 2 and 3
    s.cells[0].people = 4;
    s.cells[0].n = 4;
    memmove(s.persons[2], s.persons[2] + 4, 4 * sizeof s.persons[2][0]);
    s.cells[2].people = 4;
    s.cells[2].n = 4;
    for (int l = 0; l < LEVELS; l++)
        s.cells[l].levels[1] = (struct choice_level){"b", "x", NAN}, s.cells[l].level_count = 2;
    f = load(&s, 4);
    expect_none(&f.tests[0], "a 1, 2 and 3, at b x", "nobody answered at every level");
    expect_none(find(&f, "1", "3"), "a 1 and 3, at b x", "nobody answered at both levels");
    assert_true(f.tests[0].left_out == 8 && find(&f, "1", "2")->people == 4);
    assert_true(find(&f, "1", "2")->none[0] == '\0' && !isnan(find(&f, "1", "2")->p_value));
    choice_factors_free(&f);
    make(&s, "within3");
    for (int l = 0; l < LEVELS; l++)
        for (size_t i = 0; i < s.cells[l].people; i++)
            s.counts[l][i].k = (int64_t)(i % 2);
    f = load(&s, 4);
    expect_none(&f.tests[0], "a 1, 2 and 3", "nobody's answers differ between levels");
    choice_factors_free(&f);
    make(&s, "between3"); // level 3 has nobody but the stray
    s.cells[2].people = s.cells[2].planned_count = 0;
    add_stray(&s, 20, 1);
    f = load(&s, 4);
    expect_none(&f.tests[0], "a 1, 2 and 3",
                "everybody who answered at 3 answered at other levels too and is left out");
    expect_none(find(&f, "2", "3"), "a 2 and 3",
                "everybody who answered at 3 answered at other levels too and is left out");
    assert_true(find(&f, "1", "2")->people == 11 && !isnan(find(&f, "1", "2")->p_value));
    choice_factors_free(&f);
}

static struct program_result choices_of(const char *path, bool json)
{
    struct program_result r =
        program_run((const char *const[]){fovstats, "choices", path, json ? "--json" : NULL, NULL}, NULL);
    assert_int_equal(r.code, 0);
    return r;
}

// A file in which people were to answer at one of two levels, three of them at both, and one in which all were
// to answer at both and most stopped after the first: the plan decides, though no answers tell one from the
// other.
static void the_plan_in_the_file_decides(void **state)
{
    (void)state;
    study_file_make("between.db", &(struct study_desc){0});
    study_file_sql("between.db",
                   "CREATE TEMP TABLE gone AS SELECT id FROM trial WHERE block = 'main' AND id / 10 > 3 AND"
                   " id % 10 = 1 + id / 10 % 2; DELETE FROM exposure WHERE trial_id IN gone;"
                   " DELETE FROM frame WHERE trial_id IN gone; DELETE FROM choice WHERE trial_id IN gone;"
                   " DELETE FROM trial WHERE id IN gone");
    struct program_result r = choices_of("between.db", true);
    assert_non_null(strstr(r.out, "\"method\":\"Fisher\""));
    assert_non_null(strstr(r.out, "\"within_people\":false,\"people_planned_at_one_level\":19,"
                                  "\"people_planned_at_several_levels\":3"));
    assert_true(said_after(r.out, "factor_tests", "people_left_out") == 3);
    program_free(&r);
    r = choices_of("between.db", false);
    assert_non_null(
        strstr(r.out, "\nepsilon 0.2 and 0.05: 19 people were to answer at one level and 3 at several, so it "
                      "is compared between people; left out, people with answers at several levels: 3.\n"));
    program_free(&r);

    study_file_make("within.db", &(struct study_desc){0});
    study_file_sql("within.db",
                   "CREATE TEMP TABLE gone AS SELECT id FROM trial WHERE block = 'main' AND id / 10 > 3 AND"
                   " id % 10 = 2; DELETE FROM choice WHERE trial_id IN gone;"
                   " UPDATE trial SET status = 'planned', segment_id = NULL, started_ns = NULL,"
                   " ended_ns = NULL, attempt = 0 WHERE id IN gone");
    r = choices_of("within.db", true);
    assert_non_null(strstr(r.out, "\"method\":\"McNemar\""));
    assert_true(said_after(r.out, "factor_tests", "people") == 3);
    assert_true(said_after(r.out, "factor_tests", "people_left_out") == 19);
    assert_non_null(strstr(r.out, "\"within_people\":true,\"people_planned_at_one_level\":0,"
                                  "\"people_planned_at_several_levels\":22"));
    program_free(&r);

    study_file_sql("within.db",
                   "DELETE FROM choice WHERE trial_id IN (SELECT id FROM trial WHERE id / 10 < 4 AND id % 10 "
                   "= 1)"); // now nobody answered at both
    r = choices_of("within.db", false);
    assert_non_null(strstr(r.out, "\nepsilon 0.2 and 0.05: no test; nobody answered at both levels.\n"));
    program_free(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_r),
        cmocka_unit_test(strays_change_nothing),
        cmocka_unit_test(dropouts_change_nothing),
        cmocka_unit_test(most_people_decide),
        cmocka_unit_test(method_follows_from_the_data),
        cmocka_unit_test(other_sets_are_left_alone),
        cmocka_unit_test(nothing_is_invented),
        cmocka_unit_test(the_plan_in_the_file_decides),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
