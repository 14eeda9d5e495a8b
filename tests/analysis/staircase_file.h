// A study file with staircases and adjusted values, with known answers.
#ifndef TESTS_ANALYSIS_STAIRCASE_FILE_H
#define TESTS_ANALYSIS_STAIRCASE_FILE_H

// Block 'stairs' (fovea_deg 1 to 7, larger is easier), final estimates of P01, P02 and P03: 3.5, 6 and 4.
//   P01  140 steps: 10, 11, 14, 17, 19, 18, 19 right of 20, the set "lapses at the top" of psychometric.csv
//   P02  12 steps, all right        P03  12 steps at one level
//   P04  6 steps, of which one is invalid and one is excluded
//   P05  6 steps of a session that is excluded
// Block 'graded': P01 answers 2 steps on a scale. Block 'practice': one step that counts for nothing.
// Block 'liked': at each level 1 to 7 of dose 4, 5, 8, 12, 15, 16 and 15 of 20 people chose the test option,
// the set "preference" of psychometric.csv; each person once. Block 'again': P01 answers as in 'stairs', at
// levels of dose. Block 'tune', ε: P01 set 0.1 and 0.3, P02 0.4, P03 0.6, 0.8 and 1; and P04 2, in an invalid
// trial.
void staircase_file_make(const char *path);

#endif
