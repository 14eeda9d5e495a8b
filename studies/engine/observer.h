// A simulated participant: an event source for the machine, for rehearsals and tests.
//
// It looks, toggles with log-normal dwell times, chooses by a psychometric function of the options' image
// errors, rates by a latent normal with criteria. Every draw is Philox keyed by (seed, participant,
// trial, purpose): the same session gives the same events. Where answers have a deadline it hurries, and misses
// it in a share `late` of the attempts. Use, before each machine_frame:
//     while (observer_next(o, now_ns, &view, &errors, &at_ns, &event)) { machine_event(m, at_ns, &event);
//                                                                        machine_look(m, &view); }
// Does not: read a clock, measure errors, answer MACHINE_STORING (the caller's store does).
//
// The choice: with d = error of b minus error of a, P(a) = lapse / 2 + (1 - lapse) L(side_bias + ln 3 sign(d)
// |d / threshold|^slope), L the logistic function. threshold is the difference at which an unbiased observer
// without lapses takes the better one in 75 % of trials; equal errors give one half by law. Where the
// question's right answer is the tested option, it takes the worse one by the same law, with the errors
// exchanged.
#ifndef STUDIES_ENGINE_OBSERVER_H
#define STUDIES_ENGINE_OBSERVER_H

#include "studies/engine/machine.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { OBSERVER_PATH = 256 };

struct observer_parameters {
    double threshold;    // error difference seen in 75 %, in the unit of the errors handed in
    double slope;        // exponent of the difference
    double lapse;        // share of answers that are guesses, 0..1
    double side_bias;    // logits towards slot a
    double toggles_mean; // toggles before a choice
    double dwell_s;      // median time on one option outside fades
    double dwell_spread; // sd of ln(dwell)
    double rating_mean;  // latent rating of a flawless image
    double rating_sd;
    double rating_drop;         // points lost per threshold of error
    double view_s;              // median time before asking for the rating question
    double answer_s;            // median time to answer a screen
    double equal_band;          // where "equal" is an answer: logits around no difference that give it
    double count_error;         // sd of a count, in things counted
    double late;                // share of attempts in which a deadline is missed
    char errors[OBSERVER_PATH]; // the file of errors the caller reads; "" where not given
};

void observer_defaults(struct observer_parameters *out);
// "sim" or "sim:lapse=0.1,errors=FILE"; false with a sentence. A file name may not contain a comma.
bool observer_parse(const char *spec, struct observer_parameters *out, char *error, size_t error_size);
// All but `errors` as a JSON object, numbers with every digit. False: too small.
bool observer_json(const struct observer_parameters *parameters, char *out, size_t out_size);

// Image error of each slot's option against the reference; larger is more visible. A rating reads its
// subject's, of the scene [0].
struct observer_errors {
    double slot[2];
};

// Its state; plain data, read and changed by observer_next only.
struct observer {
    struct observer_parameters parameters;
    uint64_t key;
    bool armed; // `next` comes at due_ns
    int64_t due_ns;
    struct machine_event next;
    enum machine_screen screen; // what it is armed for
    uint32_t trial, attempt;
    uint32_t step, toggles_planned;
    enum plan_slot looking; // the option it has already dwelt on; NONE before the first
    double last_difference; // of an adjustment
    int32_t direction;
    uint32_t turns;     // of its direction
    bool late;          // misses this attempt's deadline
    int64_t hurry_ns;   // answers from here on, INT64_MAX: no deadline
    uint32_t questions; // that this attempt was asked
    uint32_t events;    // sent so far
};

// Who it is, by its code: two people who have the same number one after the other draw apart.
uint32_t observer_subject(const char *code);
void observer_start(struct observer *observer, const struct observer_parameters *parameters, uint64_t seed,
                    uint32_t subject);
// The next event due at or before now_ns, at *out_at_ns; false: none.
bool observer_next(struct observer *observer, int64_t now_ns, const struct machine_view *view,
                   const struct observer_errors *errors, int64_t *out_at_ns, struct machine_event *out_event);
// The law above, for tests and for reports.
double observer_probability_a(const struct observer_parameters *parameters,
                              const struct observer_errors *errors);

#endif
