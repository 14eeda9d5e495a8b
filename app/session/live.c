#include "app/session/live.h"

#include <math.h>
#include <stdio.h>

// Steps up and down again end this near the value they began with, as a share of it.
#define ROUNDING 1e-9

bool live_adjusts(const struct plan_trial *trial)
{
    return trial->kind == PROTOCOL_ADJUST;
}

void live_choice(const struct protocol *protocol, const struct plan_trial *trial, enum plan_slot slot,
                 double level, const double *adjusted, struct mode_choice *choice)
{
    const struct protocol_block *block = &protocol->blocks[trial->block];
    if (slot != trial->test_slot)
        return;
    if (trial->kind == PROTOCOL_STAIRCASE && !isnan(level))
        choice->values[block->staircase.parameter] = plan_level(level);
    for (uint32_t i = 0; live_adjusts(trial) && adjusted && i < block->adjust_count; i++)
        choice->values[block->adjusts[i].parameter] = adjusted[i];
}

static bool differs(double a, double b)
{
    return a < b || a > b;
}

bool live_same(const struct mode_choice *a, const struct mode_choice *b)
{
    for (uint32_t i = 0; i < a->mode->parameter_count; i++)
        if (differs(a->values[i], b->values[i]))
            return false;
    return a->mode == b->mode;
}

bool live_effective(const struct mode_choice *condition, const struct mode_choice *now, char *out,
                    size_t out_size)
{
    size_t used = 0;
    for (uint32_t i = 0; i < now->mode->parameter_count; i++) {
        const struct mode_parameter *p = &now->mode->parameters[i];
        const double wanted = condition->values[i], is = now->values[i];
        if (fabs(is - wanted) <= ROUNDING * fmax(fabs(is), fabs(wanted)))
            continue;
        int n =
            snprintf(out + used, out_size - used, "%s\"%s\":%.12g", used ? "," : "{", p->name, now->values[i]);
        if (n < 0 || (used += (size_t)n) >= out_size)
            return false;
    }
    return used > 0 && used + 2 <= out_size && snprintf(out + used, out_size - used, "}") == 1;
}
