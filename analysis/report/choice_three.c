// Stengel, M., Grogorick, S., Eisemann, M. & Magnor, M. (2016), Adaptive image-space sampling for
// gaze-contingent real-time rendering, Computer Graphics Forum 35, 129-139, section 6.2: a negative rating is a
// trial in which the reference was found better; their figure pools all trials, which is not done here.
#include "analysis/report/choice_three.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool choice_three_applies(const struct choices *choices, const struct choice_cell *cell)
{
    bool any = false;
    for (size_t i = 0; i < choices->cell_count; i++)
        any = any || (choices->cells[i].equal > 0 && strcmp(choices->cells[i].block, cell->block) == 0);
    return any && !cell->right;
}

static void fill(struct choice_three *out, const struct choice_cell *cell, double conf, double *net,
                 double *negative)
{
    int64_t most = 0;
    for (size_t i = 0; i < cell->people; i++) {
        int64_t test = cell->counts[i].k, reference = cell->counts[i].n - test, equal = cell->equals[i],
                all = test + reference + equal;
        if (all == 0)
            continue;
        out->test += test;
        out->reference += reference;
        out->equal += equal;
        most = all > most ? all : most;
        net[out->people] = (double)(test - reference) / (double)all;
        negative[out->people++] = (double)reference / (double)all;
    }
    const struct stat_ttest_options options = {.conf = conf};
    struct stat_ttest t = stat_ttest_one_sample(net, out->people, &options),
                      n = stat_ttest_one_sample(negative, out->people, &options);
    out->net = out->people ? stat_moments(net, out->people).mean : (double)NAN;
    out->net_ci = (struct stat_interval){t.ci_low, t.ci_high};
    out->negative = out->people ? stat_moments(negative, out->people).mean : (double)NAN;
    out->negative_ci = most == 1 ? stat_clopper_pearson(out->reference, out->test + out->equal + out->reference,
                                                        conf, STAT_TWO_SIDED)
                                 : (struct stat_interval){n.ci_low, n.ci_high};
}

bool choice_three_of(const struct choices *choices, const struct choice_cell *cell, struct choice_three *out)
{
    *out = (struct choice_three){0};
    double *room = malloc((2 * cell->people + 1) * sizeof *room);
    if (!room)
        return false;
    fill(out, cell, choices->conf, room, room + cell->people);
    free(room);
    struct stat_signflip flip = stat_signflip(cell->counts, cell->people, STAT_TWO_SIDED);
    out->p_value = flip.p_value;
    out->least_p = flip.least_p;
    return true;
}
