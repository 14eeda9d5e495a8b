#include "staircase_file.h"

#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct writing {
    FILE *sql;
    int trial; // the last one's id, and its place
};

static void add_trial(struct writing *w, int person, const char *block, const char *kind, const char *factors,
                      int condition, const char *status)
{
    w->trial++;
    fprintf(
        w->sql,
        "INSERT INTO trial VALUES(%d, %d, %d, %d, '%s', '%s', 'town', '{}', '%s', %d, 1, 'a', 'b', NULL, 1, "
        "NULL, '%s', 1, 0, 1);\n",
        w->trial, person, person, w->trial, block, kind, factors, condition, status);
}

static void add_step(struct writing *w, int person, int level, bool right, const char *estimate,
                     const char *status)
{
    add_trial(w, person, "stairs", "staircase", "{\"scene\":\"town\"}", 100 + level, status);
    fprintf(w->sql,
            "INSERT INTO choice VALUES(NULL, %d, %d, '%s', %d, 500000000, 5, 1);\n"
            "INSERT INTO staircase_step VALUES(NULL, %d, %d, %d, %d, %s);\n",
            w->trial, person, right ? "b" : "a", right, w->trial, level, right, !right, estimate);
}

static void add_adjusted(struct writing *w, int person, double value, const char *status)
{
    add_trial(w, person, "tune", "adjust", "{}", 2, status);
    fprintf(w->sql, "INSERT INTO response VALUES(NULL, %d, %d, 'epsilon', %.17g, NULL, 5, 'keyboard');\n",
            w->trial, person, value);
}

static void add_steps(struct writing *w)
{
    static const int right[] = {10, 11, 14, 17, 19, 18, 19};
    for (int level = 1; level <= 7; level++)
        for (int i = 0; i < 20; i++) // the wrong ones first, so that the staircase seems to go up after them
            add_step(w, 1, level, i >= 20 - right[level - 1], level == 7 && i == 19 ? "3.5" : "NULL", "done");
    for (int i = 0; i < 12; i++) {
        add_step(w, 2, i % 6 + 1, true, i == 11 ? "6" : "NULL", "done");
        add_step(w, 3, 4, i % 2, i == 11 ? "4" : "NULL", "done");
    }
    for (int i = 0; i < 6; i++) {
        add_step(w, 4, i + 1, i > 2, "NULL", i == 1 ? "invalid" : "done");
        if (i == 3)
            fprintf(w->sql,
                    "INSERT INTO exclusion VALUES(NULL, %d, NULL, NULL, 'reaction', 'planned', 'late', 'test', "
                    "'2026');\n",
                    w->trial);
        add_step(w, 5, i + 1, i > 2, "9", "done");
    }
    fputs("INSERT INTO exclusion VALUES(NULL, NULL, 5, NULL, 'manual', 'late', 'ill', 'test', '2026');\n",
          w->sql);
}

static void add_choice(struct writing *w, int person, const char *block, int level, bool test, bool preference)
{
    char factors[32];
    snprintf(factors, sizeof factors, "{\"dose\":%d}", level);
    add_trial(w, person, block, "toggle", factors, 100 + level, "done");
    fprintf(w->sql, "INSERT INTO choice VALUES(NULL, %d, %d, '%s', %s, 500000000, 5, 1);\n", w->trial, person,
            test ? "a" : "b",
            preference ? "NULL"
            : test     ? "0"
                       : "1");
}

static void add_levels(struct writing *w)
{
    static const int chosen[] = {4, 5, 8, 12, 15, 16, 15}, right[] = {10, 11, 14, 17, 19, 18, 19};
    for (int level = 1; level <= 7; level++)
        for (int i = 0; i < 20; i++) {
            int place = (i + 3 * level) % 20; // not the same people every time
            add_choice(w, i < 4 ? i + 1 : i + 2, "liked", level, place < chosen[level - 1], true);
            add_choice(w, 1, "again", level, i >= right[level - 1], false);
        }
}

void staircase_file_make(const char *path)
{
    char *text = NULL;
    size_t size = 0;
    study_file_make(path, &(struct study_desc){.bare = true});
    struct writing writing = {open_memstream(&text, &size), 1000}, *w = &writing;
    assert_non_null(w->sql);
    fputs("BEGIN;\n", w->sql);
    for (int level = 1; level <= 7; level++)
        fprintf(w->sql,
                "INSERT INTO condition VALUES(%d, 'time_warped', '{\"epsilon\":0.25,\"fovea_deg\":%d}');\n",
                100 + level, level);
    add_steps(w);
    add_levels(w);
    for (int i = 0; i < 2; i++) {
        add_trial(w, 1, "graded", "staircase", "{}", 101 + i, "done");
        fprintf(w->sql, "INSERT INTO staircase_step VALUES(NULL, %d, %d, %d, 0, 1.5);\n", w->trial, i + 1,
                3 * i);
    }
    add_trial(w, 1, "practice", "practice", "{}", 101, "done");
    fprintf(w->sql, "INSERT INTO staircase_step VALUES(NULL, %d, 1, 1, 0, 1.5);\n", w->trial);
    static const struct {
        int person;
        double value;
    } adjusted[] = {{1, 0.1}, {1, 0.3}, {2, 0.4}, {3, 0.6}, {3, 0.8}, {3, 1}};
    for (size_t i = 0; i < sizeof adjusted / sizeof adjusted[0]; i++)
        add_adjusted(w, adjusted[i].person, adjusted[i].value, "done");
    add_adjusted(w, 4, 2, "invalid");
    fputs("COMMIT;\n", w->sql);
    fclose(w->sql);
    study_file_sql(path, text);
    free(text);
}
