// What a session does while its study file or events file cannot be written, and about a clock that goes back.
//
// Trouble: said once when it begins, when its reason changes and when it is over; asked again every
// TROUBLE_RETRY_NS. Times are of a monotonic clock and come in as arguments. Does not: touch the store or the
// machine.
#ifndef APP_SESSION_TROUBLE_H
#define APP_SESSION_TROUBLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TROUBLE_RETRY_NS 250000000 // a quarter of a second: the screen stays alive, the disk is not hammered

enum { TROUBLE_SENTENCE = 512 };

struct trouble {
    bool on;
    int64_t since_ns, retry_ns; // when it began; when to try again
    char sentence[TROUBLE_SENTENCE];
    void (*say)(void *user, const char *sentence); // NULL: nobody listens
    void *user;
};

// Also while it is on: a new sentence is said, the same one is not.
void trouble_tell(struct trouble *trouble, int64_t now_ns, const char *sentence);
bool trouble_due(const struct trouble *trouble, int64_t now_ns); // time to try again
void trouble_over(struct trouble *trouble, int64_t now_ns);      // nothing to do where there was none

// A clock as the session counts it: where the real one jumps back, this one stands still and goes on from
// there.
struct steady_clock {
    bool started;
    int64_t last_ns, shift_ns;
};
// `raw_ns` of the real clock; *out_back_ns is by how much it just went back, else 0.
int64_t steady_clock_take(struct steady_clock *clock, int64_t raw_ns, int64_t *out_back_ns);

#endif
