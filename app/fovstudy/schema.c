// `fovstudy schema`: the protocol language for editors (JSON Schema) or for people (Markdown).
#include "studies/protocol/schema.h"

#include "app/command/options.h"
#include "app/fovstudy/catalogue.h"
#include "app/fovstudy/commands.h"

#include <stdio.h>
#include <stdlib.h>

int command_schema(int argc, char **argv)
{
    static const struct option_spec specs[] = {
        {"reference", NULL, "print the reference page in Markdown instead"}, {NULL, NULL, NULL}};
    struct options options;
    struct study_names names;
    bool reference = false;
    options_start(&options, argc, argv, "fovstudy schema", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(
                stdout, "fovstudy schema [--reference]",
                "Prints the JSON Schema of protocol files, from which editors complete and check them.", specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OPTIONS_WORD)
            return options_wrong("fovstudy schema", "'%s' is not expected here", options.value);
        reference = true;
    }
    char *text = NULL;
    if (study_names_init(&names, NULL, 0)) {
        text = reference ? protocol_reference(&names.catalogue) : protocol_schema(&names.catalogue);
        study_names_finish(&names);
    }
    if (text)
        fputs(text, stdout);
    else
        fprintf(stderr, "fovstudy: out of memory\n");
    bool done = text != NULL;
    free(text);
    return done ? EXIT_DONE : EXIT_FAILED;
}
