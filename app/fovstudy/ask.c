#include "app/fovstudy/ask.h"

#include <string.h>

static void prompt(FILE *out, const struct protocol_attribute *attribute)
{
    fprintf(out, "%s", attribute->prompt);
    if (attribute->type == PROTOCOL_CHOICE)
        for (uint32_t i = 0; i < attribute->choice_count; i++)
            fprintf(out, "%s%s%s", i ? ", " : " (", attribute->choices[i],
                    i + 1 == attribute->choice_count ? ")" : "");
    else if (attribute->unit[0])
        fprintf(out, " [%s]", attribute->unit);
    fprintf(out, "%s: ", attribute->required ? "" : " (may stay empty)");
    fflush(out);
}

bool ask_attribute(FILE *in, FILE *out, const struct protocol_attribute *attribute, char *json,
                   size_t json_size)
{
    char line[512], error[512];
    for (;;) {
        prompt(out, attribute);
        if (!fgets(line, sizeof line, in))
            return false;
        line[strcspn(line, "\r\n")] = '\0';
        json[0] = '\0';
        if (!line[0] && !attribute->required)
            return true;
        if (protocol_attribute_json(attribute, line, json, json_size, error, sizeof error))
            return true;
        fprintf(out, "%s\n", error);
    }
}
