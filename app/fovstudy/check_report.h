// What `fovstudy check` prints of a protocol that can be run.
#ifndef APP_FOVSTUDY_CHECK_REPORT_H
#define APP_FOVSTUDY_CHECK_REPORT_H

#include "app/fovstudy/check_power.h"
#include "studies/engine/duration.h"
#include "studies/protocol/text.h"

#include <stdint.h>

struct check_report {
    const struct protocol *protocol;
    const struct plan *plan; // of the participant asked for
    uint64_t seed;
    uint32_t people;          // over whom counts and planned tests go
    bool people_assumed;      // neither the file nor the command line says how many
    const char *remarks;      // one a line; "" for none
    struct duration duration; // of the plan
    struct observer_parameters pace;
    struct plan_carry carry[PROTOCOL_BLOCKS];
    struct check_analyses analyses;
};

// Each returns a heap string to free, NULL: out of memory.
char *check_report_text(const struct check_report *report);
char *check_report_json(const struct check_report *report);

#endif
