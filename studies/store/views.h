// What a participant had seen of a trial when it was answered. Reads only; same manners as read.h.
#ifndef STUDIES_STORE_VIEWS_H
#define STUDIES_STORE_VIEWS_H

#include "studies/store/read.h"

struct store_view_row { // one per trial, in the order of store_read_trials()
    int64_t trial_id;
    char test_slot, first_shown; // 'a', 'b', 0: none
    char last_shown;             // of the last attempt, 'a', 'b'; 0: no exposure is stored
    double a_s, b_s;             // seconds free of fade in the last attempt; NaN where no exposure is stored
};

typedef bool (*store_view_fn)(void *user, const struct store_view_row *row);

bool store_read_views(struct store_reader *reader, store_view_fn each, void *user);

#endif
