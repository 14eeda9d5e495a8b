#include "analysis/tools/arguments.h"
#include "analysis/tools/power_plan.h"

#include <math.h>
#include <stdio.h>

static const char help[] =
    "usage: fovstats power --share P [--margin M] [--participants N | FROM..TO] [--choices C] [--sd SD]\n"
    "                      [--alpha A] [--power W] [--studies S] [--seed N] [--json]\n"
    "       fovstats power REHEARSAL.db [--simulated] --share P [--participants N | FROM..TO] [the same "
    "options]\n"
    "       fovstats power --d D | --difference X --sd SD [--unpaired] [--participants N | FROM..TO] [...]\n"
    "       fovstats power --f F --levels 3x2 | REHEARSAL.db [--simulated] [--participants N | FROM..TO] "
    "[...]\n"
    "\n"
    "How often a study of so many people finds what is there, and how many people find it often enough.\n"
    "\n"
    "Choices: a preference of P for the option under test, with the test that fovstats choices would make: "
    "the\n"
    "exact binomial test where everybody chooses once in a cell, the sign-flip test of people where somebody\n"
    "chooses several times. One choice each is calculated exactly, several are simulated; the interval is the\n"
    "simulation's own error (95 %).\n"
    "  REHEARSAL.db  take each cell's choices per person from this study file, as the protocol's own plans "
    "made\n"
    "                them: rehearse with fovstudy run PROTOCOL --participants N --observer sim; who chose "
    "nothing in\n"
    "                a cell, for all answers were \"equal\", has no choice there in the plan either; of a cell "
    "that K\n"
    "                of its M participants get and answer so that it counts, N participants have N K / M "
    "people "
    "there\n"
    "  --simulated   its simulated sessions, as of a rehearsal\n"
    "  --share P     the mean preference over people, above 0 and below 1 (with --margin: 0.5)\n"
    "  --margin M    how often equality within 0.5 - M to 0.5 + M is shown instead, by two one-sided tests at "
    "A\n"
    "  --choices C   choices of each person in a cell (1)\n"
    "  --sd SD       how people differ: standard deviation of their preference in logits (0.5 where choices "
    "are\n"
    "                several; one choice each does not depend on it)\n"
    "  --studies S   simulated ones per size (2000)\n"
    "  --seed N      of the simulation (1)\n"
    "\n"
    "Ratings, by t-tests, exactly:\n"
    "  --d D         the mean difference in standard deviations of the people's differences\n"
    "  --difference X --sd SD   the same in points of the scale\n"
    "  --unpaired    two groups of people instead, in equal parts of the participants; the standard deviation "
    "is\n"
    "                then that of the ratings in a group\n"
    "Ratings, by analysis of variance within people, every effect of the design, exactly under sphericity:\n"
    "  REHEARSAL.db  factors within people and their levels as in the rated blocks of this study file, said "
    "before\n"
    "                the effects\n"
    "  --levels LxL  levels of each factor instead, also beside a file; everybody rates in every cell\n"
    "  --f F         Cohen's f: standard deviation of the effect's true values over the cells in standard\n"
    "                deviations of its error (what is left of a cell without person and effect)\n"
    "\n"
    "  --participants N   how many in the whole study, none of them excluded, or a range of up to 200 sizes\n"
    "                (10..60); needed only where choices are several\n"
    "  --alpha A     level of the test, two-sided but for --margin (0.05)\n"
    "  --power W     also say how many people, of up to 10000 where not for --share alone, reach it (0.8)\n"
    "  --json        one object with the sizes in an array; what is not reached is null\n";

static int run(const struct command *command, int argc, char **argv)
{
    const double none = (double)NAN;
    struct power_plan plan = {.share = none,
                              .sd = none,
                              .margin = none,
                              .d = none,
                              .difference = none,
                              .f = none,
                              .alpha = 0.05,
                              .power = 0.8,
                              .studies = 2000,
                              .seed = 1,
                              .choices = 1};
    const char *people = NULL, *levels = NULL;
    const struct option options[] = {{"--share", OPTION_NUMBER, &plan.share},
                                     {"--sd", OPTION_NUMBER, &plan.sd},
                                     {"--margin", OPTION_NUMBER, &plan.margin},
                                     {"--d", OPTION_NUMBER, &plan.d},
                                     {"--difference", OPTION_NUMBER, &plan.difference},
                                     {"--unpaired", OPTION_FLAG, &plan.unpaired},
                                     {"--levels", OPTION_TEXT, &levels},
                                     {"--f", OPTION_NUMBER, &plan.f},
                                     {"--alpha", OPTION_NUMBER, &plan.alpha},
                                     {"--power", OPTION_NUMBER, &plan.power},
                                     {"--studies", OPTION_NUMBER, &plan.studies},
                                     {"--seed", OPTION_NUMBER, &plan.seed},
                                     {"--choices", OPTION_NUMBER, &plan.choices},
                                     {"--participants", OPTION_TEXT, &people},
                                     {"--simulated", OPTION_FLAG, &plan.simulated},
                                     {"--json", OPTION_FLAG, &plan.json}};
    int count = 0,
        code = arguments_parse(command, argc, argv, options, sizeof options / sizeof options[0], &count);
    if (code >= 0 || (code = power_plan_check(command, people, levels, count > 0, &plan)) >= 0)
        return code;
    struct json json = {stdout, false};
    int64_t choices = (int64_t)plan.choices;
    const struct power_case only = {.name = "", .choices = &choices, .count = 1};
    const struct power_source source = {
        .simulates = !power_plan_test(&plan, &only)->at, .designs = &plan.design, .design_count = 1};
    if (count) {
        code = power_rehearsal(command, &plan, argv, count, &json);
    } else {
        power_begin(&plan, &source, &json);
        code = isnan(plan.f) ? power_show(command, &plan, &only, &json)
                             : power_show_design(command, &plan, &plan.design, false, &json);
    }
    if (code >= 0)
        return code;
    power_end(&plan, &json);
    return command_finish(command);
}

const struct command command_power = {"power", "how many people a study needs", help, run};
