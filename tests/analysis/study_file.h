// Small study files with known answers, written through plain SQL from schema.sql.
#ifndef TESTS_ANALYSIS_STUDY_FILE_H
#define TESTS_ANALYSIS_STUDY_FILE_H

#include <stdbool.h>

// 22 people, sessions and two cells: epsilon 0.2, where 6 of 22 chose the test option, and epsilon 0.05, where
// 4 of 19 did (three trials are invalid). Sides alternate. Person i toggled i % 7 times and took i / 2 seconds.
// Ratings: persons 1 to 11 time_warped first, changes as in Franke 2021 (sum 5, sum of squares 9); 12 to 20
// regular first (sum -8, sum of squares 12); 21 and 22 rated once. Person 1 has 100 frames of each option,
// regular taking 1 to 100 ms of GPU time in mixed order, time_warped half of that; every tenth frame is late.
struct study_desc {
    bool simulated;
    bool empty;    // the schema alone
    bool pooled;   // person 1 answers the first cell twice
    bool several;  // everybody answers the first cell eight times more, person i for the test option 5 i % 9
                   // times
    bool hostile;  // texts that would break HTML, gnuplot or a shell
    bool excluded; // a planned rule takes person 22 out, a stricter one person 1
    bool equal;    // person 22 answers "equal" in the first cell
    bool bare;     // sessions without a trial
};

void study_file_make(const char *path,
                     const struct study_desc *desc); // replaces; fails the test on an SQL error
void study_file_sql(const char *path, const char *sql);
// One value of one query, as text; good until the next call. Fails the test where there is none.
const char *study_file_ask(const char *path, const char *sql);
void study_file_even(const char *path); // from now on 11 of 22 and 9 of 19 chose the test option

#endif
