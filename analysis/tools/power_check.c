// What is wrong with the options of `fovstats power`.
#include "analysis/stats/power_simulation.h"
#include "analysis/tools/arguments.h"
#include "analysis/tools/power_plan.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int check_range(const struct command *command, const char *name, double value, double low, double high,
                       bool whole)
{
    if (isnan(value) || (value >= low && value <= high && (!whole || value == floor(value))))
        return -1;
    return command_fail(command, EXIT_USAGE, "%s is %g but must be %sfrom %g to %g", name, value,
                        whole ? "a whole number " : "", low, high);
}

static int check_open(const struct command *command, const char *name, double value)
{
    if (isnan(value) || (value > 0 && value < 1))
        return -1;
    return command_fail(command, EXIT_USAGE, "%s is %g but must lie between 0 and 1", name, value);
}

static int check_people(const struct command *command, const char *text, struct power_plan *plan)
{
    char first[32] = "";
    const char *dots = strstr(text, "..");
    snprintf(first, sizeof first, "%.*s", (int)(dots ? (size_t)(dots - text) : strlen(text)), text);
    int64_t least = !isnan(plan->f) || (!isnan(plan->d) && !plan->unpaired) ? 2 : plan->unpaired ? 4 : 1;
    bool ok = arguments_integer(first, &plan->from);
    plan->to = plan->from;
    if (dots)
        ok = ok && arguments_integer(dots + 2, &plan->to);
    if (ok && plan->from >= least && plan->from <= plan->to && plan->to <= STAT_SIMULATED_PEOPLE &&
        plan->to - plan->from < POWER_SIZES)
        return -1;
    return command_fail(
        command, EXIT_USAGE,
        "--participants is \"%s\" but must be a number from %d to %d, or a range of up to %d of them "
        "such as 10..60",
        text, (int)least, STAT_SIMULATED_PEOPLE, POWER_SIZES);
}

// "3x2"; the factors are A, B and so on.
static int check_levels(const struct command *command, const char *text, struct power_design *design)
{
    static const char *const letters[POWER_FACTORS] = {"A", "B", "C", "D", "E", "F"};
    const char *at = text;
    design->cells = 1;
    while (design->factors < POWER_FACTORS) {
        char one[16] = "";
        size_t length = strcspn(at, "x");
        snprintf(one, sizeof one, "%.*s", (int)(length < sizeof one ? length : 0), at);
        int64_t levels = 0;
        if (!arguments_integer(one, &levels) || levels < 2 || levels > POWER_CELLS)
            break;
        design->names[design->factors] = letters[design->factors];
        design->levels[design->factors++] = levels;
        design->cells *= levels;
        at += length;
        if (*at == '\0' && design->cells <= POWER_CELLS)
            return -1;
        if (*at++ == '\0' || design->cells > POWER_CELLS)
            break;
    }
    return command_fail(
        command, EXIT_USAGE,
        "--levels is \"%s\" but must be the levels of up to %d factors, each 2 or more, such as 3x2, of "
        "at most %d cells",
        text, POWER_FACTORS, POWER_CELLS);
}

// One question at a time: of choices, of a difference of ratings, or of an analysis of variance.
static const char *contradiction(const struct power_plan *plan, const char *levels, bool rehearsal)
{
    bool difference = !isnan(plan->d) || !isnan(plan->difference), effect = levels || !isnan(plan->f),
         ratings = difference || effect;
    if (difference && effect)
        return "takes an effect (--f, --levels) or a difference of ratings (--d, --difference), not both";
    if (ratings && (!isnan(plan->share) || !isnan(plan->margin) || plan->choices != 1))
        return "--share, --margin and --choices are of choices and go with no difference or levels of ratings";
    if (difference && rehearsal)
        return "takes no study file for a difference of ratings: its power does not depend on what was "
               "recorded";
    if (rehearsal && plan->choices != 1)
        return "takes --choices or a study file that has them, not both";
    if (!isnan(plan->d) && !isnan(plan->difference))
        return "takes --d or --difference with --sd, not both";
    if (!isnan(plan->difference) && isnan(plan->sd))
        return "needs --sd S beside --difference: of the people's differences, or with --unpaired of the "
               "ratings";
    if (isnan(plan->difference) && ratings && !isnan(plan->sd))
        return "--sd goes with --share or --difference only";
    if (levels && isnan(plan->f))
        return "needs --f F beside --levels, the effect to be found; see --help";
    if (!levels && !isnan(plan->f) && !rehearsal)
        return "needs --levels beside --f, the design, such as 3x2, or a rehearsal's study file that has it; "
               "see "
               "--help";
    if (plan->unpaired && !difference)
        return "--unpaired goes with --d or --difference only";
    if (!ratings && isnan(plan->share) && isnan(plan->margin))
        return "needs --share P, the preference to be found, or --margin, --d, --difference or --f; see --help";
    return NULL;
}

// The difference in standard deviations; a SD of 0 would make every study find it.
static int check_difference(const struct command *command, struct power_plan *plan)
{
    if (!isnan(plan->difference)) {
        if (!(plan->sd > 0))
            return command_fail(command, EXIT_USAGE, "--sd is %g but must be above 0 beside --difference",
                                plan->sd);
        plan->d = plan->difference / plan->sd;
    }
    // Beyond, libRmath's noncentral t approximates (power.c).
    if (!isnan(plan->d) && !(plan->d != 0 && fabs(plan->d) <= 10))
        return command_fail(command, EXIT_USAGE,
                            "the difference is %g standard deviations but must not be 0, nor beyond 10",
                            plan->d);
    return -1;
}

static int check_choices(const struct command *command, bool people, struct power_plan *plan)
{
    int code = check_range(command, "--sd", plan->sd, 0, 10, false);
    if (code >= 0)
        return code;
    if (!isnan(plan->margin) && !(plan->margin > 0 && plan->margin <= 0.5))
        return command_fail(command, EXIT_USAGE, "--margin is %g but must be above 0, and 0.5 at most",
                            plan->margin);
    if (!isnan(plan->margin) && !(plan->alpha < 0.5))
        return command_fail(command, EXIT_USAGE, "--alpha is %g but --margin needs less than 0.5", plan->alpha);
    if (!people && plan->choices != 1)
        return command_fail(
            command, EXIT_USAGE,
            "needs --participants N or FROM..TO: several choices each are simulated, size by size");
    plan->share = isnan(plan->share) ? 0.5 : plan->share;
    plan->sd = isnan(plan->sd) ? 0.5 : plan->sd;
    return -1;
}

int power_plan_check(const struct command *command, const char *people, const char *levels, bool rehearsal,
                     struct power_plan *plan)
{
    const char *wrong = contradiction(plan, levels, rehearsal);
    int code = -1;
    if (wrong)
        return command_fail(command, EXIT_USAGE, "%s", wrong);
    if ((code = check_open(command, "--share", plan->share)) >= 0 ||
        (code = check_open(command, "--alpha", plan->alpha)) >= 0 ||
        (code = check_open(command, "--power", plan->power)) >= 0 ||
        (code = check_range(command, "--choices", plan->choices, 1, STAT_SIMULATED_CHOICES, true)) >= 0 ||
        (code = check_range(command, "--studies", plan->studies, 100, STAT_SIMULATED_STUDIES, true)) >= 0 ||
        (code = check_range(command, "--seed", plan->seed, 0, 9007199254740992.0, true)) >= 0 ||
        (levels && (code = check_levels(command, levels, &plan->design)) >= 0) ||
        (code = check_difference(command, plan)) >= 0)
        return code;
    if (!isnan(plan->f) && !(plan->f > 0 && power_design_fits(plan, &plan->design)))
        return command_fail(command, EXIT_USAGE,
                            "--f is %g but must be above 0, and F^2 times the cells 100 at most", plan->f);
    if (!power_plan_ratings(plan) && (code = check_choices(command, people, plan)) >= 0)
        return code;
    return people ? check_people(command, people, plan) : -1;
}
