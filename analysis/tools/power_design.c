// Every effect of a design of factors within people. Effects of the same degrees of freedom have the same
// power; they are all there so that nobody has to look for theirs.
#include "analysis/tools/power_plan.h"

#include <stdio.h>
#include <string.h>

void power_design_words(const struct power_design *design, char out[256])
{
    out[0] = '\0';
    for (size_t i = 0; i < design->factors; i++) {
        size_t used = strlen(out);
        snprintf(out + used, 256 - used, "%s%.30s %d", used ? " x " : "", design->names[i],
                 (int)design->levels[i]);
    }
    size_t used = strlen(out);
    snprintf(out + used, 256 - used, " (%d cells)", (int)design->cells);
}

static void print_design(const struct power_design *design)
{
    char words[256];
    power_design_words(design, words);
    if (design->question)
        printf("%s, %s: levels from the file: %s\n", design->question, design->block, words);
    else
        printf("Levels as typed: %s\n", words);
    if (design->left_out[0])
        printf("Not analysed: %s.\n", design->left_out);
    if (design->most > 1)
        printf("People rate up to %zu times in a cell: F is in the error of their mean.\n", design->most);
    putchar('\n');
}

int power_show_design(const struct command *command, const struct power_plan *plan,
                      const struct power_design *design, bool several, struct json *json)
{
    struct power_plan of = *plan;
    int code = -1;
    of.design = *design;
    if (!plan->json)
        print_design(design);
    for (unsigned bits = 1; bits < 1u << design->factors && code < 0; bits++) {
        char name[512] = "";
        int64_t df = 1;
        if (several)
            snprintf(name, sizeof name, "%.100s, %.60s: ", design->question, design->block);
        bool first = true;
        for (size_t i = 0; i < design->factors; i++)
            if (bits >> i & 1) {
                size_t used = strlen(name);
                snprintf(name + used, sizeof name - used, "%s%.40s (%d)", first ? "" : " x ", design->names[i],
                         (int)design->levels[i]);
                df *= design->levels[i] - 1;
                first = false;
            }
        code = power_show(command, &of, &(struct power_case){.name = name, .df = df}, json);
    }
    return code;
}
