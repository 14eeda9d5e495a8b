// `fovstudy scenes`: the built-in scenes; files are named by their path instead.
#include "app/command/json.h"
#include "app/command/options.h"
#include "app/fovstudy/commands.h"
#include "stimuli/builtin/builtin.h"

#include <stdio.h>

static void print_text(const struct builtin_scene *scene)
{
    printf("%s\n    %s\n", scene->name, scene->description);
    for (const struct builtin_parameter *p = scene->parameters; p && p->name; p++)
        printf("    %-16s %.0f to %.0f%s%s, default %.0f; %s\n", p->name, p->min, p->max, *p->unit ? " " : "",
               p->unit, p->value, p->description);
}

static void print_json(const struct builtin_scene *scene)
{
    printf("{\"name\":");
    json_string(stdout, scene->name);
    printf(",\"description\":");
    json_string(stdout, scene->description);
    printf(",\"parameters\":[");
    for (const struct builtin_parameter *p = scene->parameters; p && p->name; p++) {
        printf("%s{\"name\":", p == scene->parameters ? "" : ",");
        json_string(stdout, p->name);
        printf(",\"unit\":");
        json_string(stdout, p->unit);
        printf(",\"description\":");
        json_string(stdout, p->description);
        printf(",\"min\":%.0f,\"max\":%.0f,\"default\":%.0f}", p->min, p->max, p->value);
    }
    printf("]}");
}

int command_scenes(int argc, char **argv)
{
    static const struct option_spec specs[] = {{"json", NULL, "print JSON"}, {NULL, NULL, NULL}};
    struct options options;
    bool json = false;
    options_start(&options, argc, argv, "fovstudy scenes", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(stdout, "fovstudy scenes [--json]",
                         "Lists the built-in scenes. Any glTF or GLB file is a scene too: give its path.",
                         specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OPTIONS_WORD)
            return options_wrong("fovstudy scenes", "'%s' is not expected here", options.value);
        json = true;
    }
    if (json)
        printf("[");
    for (int i = 0; builtin_scenes[i].name; i++) {
        if (json) {
            printf("%s", i ? ",\n " : "");
            print_json(&builtin_scenes[i]);
        } else {
            print_text(&builtin_scenes[i]);
        }
    }
    if (json)
        printf("]\n");
    return EXIT_DONE;
}
