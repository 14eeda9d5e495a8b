#include "studies/protocol/schema.h"

#include "studies/protocol/language.h"
#include "studies/protocol/text.h"

#include <stdint.h>
#include <string.h>

static void range_write(struct text *out, double min, double max)
{
    text_number(out, min);
    text_add(out, " to ");
    if (max >= 9.2e18)
        text_add(out, "2^63-1");
    else
        text_number(out, max);
}

// "1 to 4 names", "2 numbers"
static void entries_write(struct text *out, const struct language_key *key, const char *what)
{
    if (key->max <= 0)
        text_add(out, "%s", what);
    else if ((int)key->min == (int)key->max)
        text_add(out, "%d %s", (int)key->max, what);
    else
        text_add(out, "%d to %d %s", (int)key->min, (int)key->max, what);
}

static void link_write(struct text *out, const char *title)
{
    const char *name = strncmp(title, "the ", 4) == 0 ? title + 4 : title;
    text_add(out, "[%s](#%s)", name, name);
}

static void words_write(struct text *out, const char *const *words)
{
    for (uint32_t i = 0; words[i]; i++)
        text_add(out, "%s`%s`", i ? ", " : "", words[i]);
}

static void list_write(struct text *out, const struct language_key *key)
{
    text_add(out, "list of ");
    if (key->of) {
        entries_write(out, key, "");
        text_add(out, key->max > 0 ? "of " : "");
        link_write(out, key->of);
    } else if (key->items == LANGUAGE_INTEGER || key->items == LANGUAGE_NUMBER) {
        entries_write(out, key, key->items == LANGUAGE_INTEGER ? "whole numbers, " : "numbers, ");
        range_write(out, key->item_min, key->item_max);
    } else {
        entries_write(out, key, key->items == LANGUAGE_TEXT ? "texts" : "names");
    }
    if (key->words) {
        text_add(out, ", or ");
        words_write(out, key->words);
    }
}

static void table_write(struct text *out, const struct language_key *key)
{
    text_add(out, "mapping of ");
    entries_write(out, key, "names to ");
    if (key->of)
        link_write(out, key->of);
    else
        text_add(out, "names");
}

static void type_write(struct text *out, const struct language_key *key)
{
    switch (key->type) {
    case LANGUAGE_NAME:
        text_add(out, "name");
        break;
    case LANGUAGE_TEXT:
        text_add(out, "text");
        break;
    case LANGUAGE_NUMBER:
        text_add(out, "number, ");
        range_write(out, key->min, key->max);
        break;
    case LANGUAGE_INTEGER:
        text_add(out, "whole number, ");
        range_write(out, key->min, key->max);
        break;
    case LANGUAGE_SECONDS:
        text_add(out, "seconds, ");
        range_write(out, key->min, key->max);
        break;
    case LANGUAGE_WORD:
        words_write(out, key->words);
        break;
    case LANGUAGE_NAMES:
        text_add(out, "a name, or a list of ");
        entries_write(out, key, "names");
        break;
    case LANGUAGE_LIST:
        list_write(out, key);
        break;
    case LANGUAGE_MAP:
        link_write(out, key->of);
        break;
    case LANGUAGE_TABLE:
        table_write(out, key);
        break;
    case LANGUAGE_VARIANT:
        text_add(out, "list of ");
        entries_write(out, key, "values, or ");
        table_write(out, key);
        break;
    }
    if (key->unit)
        text_add(out, " %s", key->unit);
}

static void section_write(struct text *out, const struct language_section *section)
{
    const char *title = strncmp(section->title, "the ", 4) == 0 ? section->title + 4 : section->title;
    text_add(out, "\n## %s\n\n%s", title, section->about);
    if (section->shorthand == LANGUAGE_SHORT_NAME)
        text_add(out, " Its name alone is the short form.");
    if (section == &language_option || section == &language_parameters)
        text_add(out, " The parameters of each mode stand [below](#modes).");
    if (section == &language_settings)
        text_add(out, " The settings of rendering stand [below](#rendering).");
    text_add(out, "\n");
    if (!section->keys->name)
        return;
    text_add(out, "\n| key | takes | default | what it says | example |\n|---|---|---|---|---|\n");
    for (const struct language_key *key = section->keys; key->name; key++) {
        text_add(out, "| `%s` | ", key->name);
        type_write(out, key);
        text_add(out, " | %s | %s | `%s` |\n",
                 key->required   ? "**required**"
                 : key->fallback ? key->fallback
                                 : "",
                 key->about, key->example);
    }
}

static void parameters_write(struct text *out, const struct catalogue_parameter *parameters, uint32_t count)
{
    text_add(out, "\n| parameter | takes | default | what it is |\n|---|---|---|---|\n");
    for (uint32_t i = 0; i < count; i++) {
        const struct catalogue_parameter *parameter = &parameters[i];
        text_add(out, "| `%s` | ", parameter->name);
        if (parameter->choices)
            words_write(out, parameter->choices);
        else
            range_write(out, parameter->min, parameter->max);
        text_add(out, "%s%s | ", *parameter->unit ? " " : "", parameter->unit);
        if (parameter->choices)
            text_add(out, "%s", parameter->choices[(size_t)parameter->fallback]);
        else
            text_number(out, parameter->fallback);
        text_add(out, " | %s |\n", parameter->about ? parameter->about : "");
    }
}

char *protocol_reference(const struct catalogue *catalogue)
{
    struct text out = {0};
    text_add(
        &out,
        "# The protocol language\n\n"
        "Made by `fovstudy schema --reference`; change `studies/protocol/language.c` instead of this page.\n\n"
        "A protocol is one YAML file. Names are letters, digits, `_` and `-`, at most 63 of them. What a "
        "block, a "
        "factor's level or a trial does not set comes from what is around it. `fovstudy check FILE` says what "
        "is "
        "wrong, where, and what a participant would get. Editors complete and check keys by the schema that "
        "`fovstudy schema` prints; the YAML language server finds it by the file's first line:\n\n"
        "    # yaml-language-server: $schema=PATH/TO/share/fovstudy/protocol.schema.json\n");
    for (uint32_t i = 0; language_sections[i]; i++)
        section_write(&out, language_sections[i]);
    text_add(&out, "\n## modes\n\nWhat an option's `mode` may be, with the parameters that it takes.\n");
    for (uint32_t m = 0; m < catalogue->mode_count; m++) {
        const struct catalogue_mode *mode = &catalogue->modes[m];
        text_add(&out, "\n### %s\n\n%s\n", mode->name, mode->about ? mode->about : "");
        if (mode->parameter_count > 0)
            parameters_write(&out, mode->parameters, mode->parameter_count);
    }
    text_add(&out, "\n## rendering\n\nFurther [settings](#settings), the same for both options of a trial.\n");
    parameters_write(&out, catalogue->settings, catalogue->setting_count);
    return text_take(&out);
}
