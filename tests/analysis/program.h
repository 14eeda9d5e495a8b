// Running a program as a user would, and keeping what it said.
#ifndef TESTS_ANALYSIS_PROGRAM_H
#define TESTS_ANALYSIS_PROGRAM_H

struct program_result {
    int code;        // exit code; -1: a signal
    char *out, *err; // freed by program_free()
};

// argv is NULL-terminated; argv[0] the program's path. `path`: the PATH it sees, NULL for ours.
struct program_result program_run(const char *const *argv, const char *path);
void program_free(struct program_result *result);

// For cmocka_run_group_tests(): a new folder that the test works in, and its removal.
int program_enter_folder(void **state);
int program_leave_folder(void **state);

#endif
