// `fovstudy modes`: the table of rendering modes, as the renderer has it.
#include "app/command/json.h"
#include "app/command/options.h"
#include "app/fovstudy/commands.h"
#include "renderer/mode.h"

#include <stdio.h>

static void print_value(const struct mode_parameter *parameter, double value)
{
    if (parameter->choices)
        printf("%s", parameter->choices[(int)value]);
    else
        printf("%g", value);
}

static void print_text(const struct mode *mode)
{
    printf("%s\n    %s\n    source: %s\n", mode->name, mode->description, mode->source);
    for (uint32_t i = 0; i < mode->parameter_count; i++) {
        const struct mode_parameter *parameter = &mode->parameters[i];
        printf("    %-16s ", parameter->name);
        if (parameter->choices)
            for (int c = 0; parameter->choices[c]; c++)
                printf("%s%s", c ? " or " : "", parameter->choices[c]);
        else
            printf("%g to %g%s%s", parameter->min, parameter->max, *parameter->unit ? " " : "",
                   parameter->unit);
        printf(", default ");
        print_value(parameter, parameter->fallback);
        printf("; %s\n", parameter->description);
    }
}

static void print_json_parameter(const struct mode_parameter *parameter)
{
    printf("{\"name\":");
    json_string(stdout, parameter->name);
    printf(",\"unit\":");
    json_string(stdout, parameter->unit);
    printf(",\"description\":");
    json_string(stdout, parameter->description);
    if (parameter->choices) {
        printf(",\"choices\":[");
        for (int c = 0; parameter->choices[c]; c++) {
            printf("%s", c ? "," : "");
            json_string(stdout, parameter->choices[c]);
        }
        printf("],\"default\":");
        json_string(stdout, parameter->choices[(int)parameter->fallback]);
    } else {
        printf(",\"min\":%.17g,\"max\":%.17g,\"default\":%.17g", parameter->min, parameter->max,
               parameter->fallback);
    }
    printf("}");
}

static void print_json(const struct mode *mode)
{
    printf("{\"name\":");
    json_string(stdout, mode->name);
    printf(",\"description\":");
    json_string(stdout, mode->description);
    printf(",\"source\":");
    json_string(stdout, mode->source);
    printf(",\"parameters\":[");
    for (uint32_t i = 0; i < mode->parameter_count; i++) {
        printf("%s", i ? "," : "");
        print_json_parameter(&mode->parameters[i]);
    }
    printf("]}");
}

int command_modes(int argc, char **argv)
{
    static const struct option_spec specs[] = {{"json", NULL, "print JSON"}, {NULL, NULL, NULL}};
    struct options options;
    bool json = false;
    options_start(&options, argc, argv, "fovstudy modes", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(stdout, "fovstudy modes [--json]", "Lists every rendering mode with its parameters.",
                         specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OPTIONS_WORD)
            return options_wrong("fovstudy modes", "'%s' is not expected here", options.value);
        json = true;
    }
    if (json)
        printf("[");
    for (int i = 0; modes[i]; i++) {
        if (json) {
            printf("%s", i ? ",\n " : "");
            print_json(modes[i]);
        } else {
            print_text(modes[i]);
        }
    }
    if (json)
        printf("]\n");
    return EXIT_DONE;
}
