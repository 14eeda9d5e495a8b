// Whether a stored session can go on as it was: with the same options, the same protocol, the same plan.
//
// Each returns false with a sentence that shows the difference. Does not: write.
#ifndef APP_FOVSTUDY_RESUME_CHECK_H
#define APP_FOVSTUDY_RESUME_CHECK_H

#include "app/fovstudy/run_study.h"

// Fills in what was not given as the session was started with, and refuses what differs. `observer` holds the
// stored observer's text while the options are used.
enum { RESUME_OBSERVER = 2048 };
bool resume_options(struct run_options *options, const struct store_session_start *start,
                    char observer[RESUME_OBSERVER], char *error, size_t error_size);
// The attributes that were given, against the stored ones.
bool resume_attributes(const struct protocol *protocol, const struct run_options *options,
                       const struct store_session_start *start, char *error, size_t error_size);
// The display as it opened.
bool resume_view(const struct run_view *view, const struct store_session_start *start, char *error,
                 size_t error_size);
// The protocol's file, where there is one to look at; out_difference: the lines that differ, to print below the
// sentence; the caller frees it. NULL: there are none.
bool resume_protocol_file(const struct run_options *options, const struct store_session_start *start,
                          char **out_difference, char *error, size_t error_size);
// The plan against the stored trials; fills the ids and where the session goes on.
bool resume_plan(struct run_rows *rows, const struct store_session_start *start, char *error,
                 size_t error_size);

#endif
