// What a sitting says, as one number: SHA-256 over its rows, whatever file they stand in.
//
// Hashed are the values that analyses read: the protocol's name and hash, the code the participant was recorded
// under (not a laboratory's name before it), number, kind and attributes, the session and its segments, planned
// trials with their conditions, choices, ratings, responses, staircase steps, checks of the tracker, and
// exclusions. Each value goes in with its type and length, rows in an order of their own, so that ids, pages,
// the write-ahead log and other sessions of the file play no part. Does not: read the logs (frame, gaze,
// exposure, adjust_step, event), which grow to 10^7 rows: whoever changes only those does not change it.
#ifndef STUDIES_STORE_DIGEST_H
#define STUDIES_STORE_DIGEST_H

#include "studies/store/read.h"

enum { STORE_DIGEST_HEX = 65 };

// 64 lower-case hexadecimal digits. False with store_reader_error().
bool store_session_digest(struct store_reader *reader, int64_t session_id, char out[STORE_DIGEST_HEX]);
// One of several, in whatever order they are given: SHA-256 of the sorted ones, one a line. Sorts them.
bool store_digests_join(char (*digests)[STORE_DIGEST_HEX], size_t count, char out[STORE_DIGEST_HEX]);

#endif
