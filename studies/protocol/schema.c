#include "studies/protocol/schema.h"

#include "studies/protocol/language.h"
#include "studies/protocol/protocol.h"
#include "studies/protocol/text.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define NAME_SCHEMA "\"type\":[\"string\",\"integer\"],\"pattern\":\"^[A-Za-z0-9_-]{1,63}$\""
_Static_assert(PROTOCOL_NAME == 64, "the pattern above has one less");

// "the block" is defined as "block".
static const char *definition(const char *title)
{
    return strncmp(title, "the ", 4) == 0 ? title + 4 : title;
}

static void number_write(struct text *out, double value)
{
    if (value >= 9.2e18) // the largest seed is no double
        text_add(out, "%lld", (long long)INT64_MAX);
    else
        text_number(out, value);
}

static void range_write(struct text *out, const char *type, double min, double max)
{
    text_add(out, "\"type\":\"%s\",\"minimum\":", type);
    number_write(out, min);
    text_add(out, ",\"maximum\":");
    number_write(out, max);
}

static void words_write(struct text *out, const char *const *words)
{
    text_add(out, "\"enum\":[");
    for (uint32_t i = 0; words[i]; i++) {
        text_add(out, i ? "," : "");
        text_json_string(out, words[i]);
    }
    text_add(out, "]");
}

static void entries_write(struct text *out, const char *least, const char *most, const struct language_key *key)
{
    if (key->max > 0)
        text_add(out, ",\"%s\":%d,\"%s\":%d", least, (int)key->min, most, (int)key->max);
}

// What one entry of a list or table is.
static void item_write(struct text *out, const struct language_key *key)
{
    text_add(out, "{");
    if (key->of)
        text_add(out, "\"$ref\":\"#/$defs/%s\"", definition(key->of));
    else if (key->items == LANGUAGE_INTEGER || key->items == LANGUAGE_NUMBER)
        range_write(out, key->items == LANGUAGE_INTEGER ? "integer" : "number", key->item_min, key->item_max);
    else if (key->items == LANGUAGE_TEXT)
        text_add(out, "\"type\":[\"string\",\"number\"]");
    else
        text_add(out, NAME_SCHEMA);
    text_add(out, "}");
}

static void list_write(struct text *out, const struct language_key *key)
{
    text_add(out, "\"type\":\"array\",\"items\":");
    item_write(out, key);
    entries_write(out, "minItems", "maxItems", key);
}

static void table_write(struct text *out, const struct language_key *key)
{
    text_add(out, "\"type\":\"object\",\"propertyNames\":{\"pattern\":\"^[A-Za-z0-9_-]{1,63}$\"},"
                  "\"additionalProperties\":");
    item_write(out, key);
    entries_write(out, "minProperties", "maxProperties", key);
}

// A list of plain values, as a factor's levels are.
static void values_write(struct text *out)
{
    text_add(out,
             "{\"type\":\"array\",\"items\":{\"type\":[\"string\",\"number\",\"boolean\"]},"
             "\"minItems\":1,\"maxItems\":%d}",
             PROTOCOL_LEVELS);
}

static void type_write(struct text *out, const struct language_key *key)
{
    switch (key->type) {
    case LANGUAGE_NAME:
        text_add(out, NAME_SCHEMA);
        break;
    case LANGUAGE_TEXT:
        text_add(out, "\"type\":[\"string\",\"number\"]");
        break;
    case LANGUAGE_NUMBER:
    case LANGUAGE_SECONDS:
        range_write(out, "number", key->min, key->max);
        break;
    case LANGUAGE_INTEGER:
        range_write(out, "integer", key->min, key->max);
        break;
    case LANGUAGE_WORD:
        words_write(out, key->words);
        break;
    case LANGUAGE_MAP:
        text_add(out, "\"$ref\":\"#/$defs/%s\"", definition(key->of));
        break;
    case LANGUAGE_TABLE:
        table_write(out, key);
        break;
    case LANGUAGE_NAMES:
        text_add(out, "\"anyOf\":[{" NAME_SCHEMA "},{");
        list_write(out, key);
        text_add(out, "}]");
        break;
    case LANGUAGE_LIST:
        text_add(out, key->words ? "\"anyOf\":[{" : "");
        list_write(out, key);
        if (key->words) {
            text_add(out, "},{");
            words_write(out, key->words);
            text_add(out, "}]");
        }
        break;
    case LANGUAGE_VARIANT:
        text_add(out, "\"anyOf\":[");
        values_write(out);
        text_add(out, ",{");
        table_write(out, key);
        text_add(out, "}]");
        break;
    }
}

// The default as a value, where it is one: a number or one of the words.
static void default_write(struct text *out, const struct language_key *key)
{
    char *end = NULL;
    if (!key->fallback)
        return;
    strtod(key->fallback, &end);
    if (*end == '\0' && key->type != LANGUAGE_WORD && key->type != LANGUAGE_MAP)
        text_add(out, ",\"default\":%s", key->fallback);
    for (uint32_t i = 0; key->words && key->words[i]; i++)
        if (strcmp(key->words[i], key->fallback) == 0)
            text_add(out, ",\"default\":\"%s\"", key->fallback);
}

static void description_write(struct text *out, const struct language_key *key)
{
    struct text told = {0};
    text_add(&told, "%s", key->about);
    if (key->unit || key->type == LANGUAGE_SECONDS)
        text_add(&told, " In %s.", key->unit ? key->unit : "seconds");
    if (key->fallback)
        text_add(&told, " Default: %s.", key->fallback);
    text_add(&told, "\nExample: %s", key->example);
    char *whole = text_take(&told);
    text_add(out, ",\"description\":");
    text_json_string(out, whole ? whole : "");
    out->failed = out->failed || !whole;
    free(whole);
}

static void parameter_write(struct text *out, const struct catalogue_parameter *parameter)
{
    text_add(out, "{");
    if (parameter->choices)
        words_write(out, parameter->choices);
    else
        range_write(out, "number", parameter->min, parameter->max);
    text_add(out, ",\"default\":");
    if (parameter->choices)
        text_json_string(out, parameter->choices[(size_t)parameter->fallback]);
    else
        text_number(out, parameter->fallback);
    if (parameter->about) {
        struct text told = {0};
        text_add(&told, "%s%s%s", parameter->about, *parameter->unit ? ", in " : "", parameter->unit);
        char *whole = text_take(&told);
        text_add(out, ",\"description\":");
        text_json_string(out, whole ? whole : "");
        free(whole);
    }
    text_add(out, "}");
}

static void mode_words(struct text *out, const struct catalogue *catalogue)
{
    text_add(out, "\"enum\":[");
    for (uint32_t i = 0; i < catalogue->mode_count; i++)
        text_add(out, "%s\"%s\"", i ? "," : "", catalogue->modes[i].name);
    text_add(out, "]");
}

static bool is_mode_key(const struct language_section *section, const struct language_key *key)
{
    return section == &language_option && strcmp(key->name, "mode") == 0;
}

static void properties_write(struct text *out, const struct language_section *section,
                             const struct catalogue *catalogue)
{
    text_add(out, "\"properties\":{");
    for (const struct language_key *key = section->keys; key->name; key++) {
        text_add(out, "%s\n\"%s\":{", key == section->keys ? "" : ",", key->name);
        if (is_mode_key(section, key))
            mode_words(out, catalogue);
        else
            type_write(out, key);
        description_write(out, key);
        default_write(out, key);
        text_add(out, "}");
    }
    for (uint32_t i = 0; section == &language_settings && i < catalogue->setting_count; i++) {
        text_add(out, ",\n\"%s\":", catalogue->settings[i].name);
        parameter_write(out, &catalogue->settings[i]);
    }
    text_add(out, "}");
    bool first = true;
    for (const struct language_key *key = section->keys; key->name; key++) {
        if (!key->required)
            continue;
        text_add(out, first ? ",\n\"required\":[\"%s\"" : ",\"%s\"", key->name);
        first = false;
    }
    text_add(out, first ? "" : "]");
}

// An option takes the parameters of its own mode, and no others.
static void modes_write(struct text *out, const struct catalogue *catalogue)
{
    text_add(out, ",\n\"allOf\":[");
    for (uint32_t m = 0; m < catalogue->mode_count; m++) {
        const struct catalogue_mode *mode = &catalogue->modes[m];
        text_add(out,
                 "%s\n{\"if\":{\"properties\":{\"mode\":{\"const\":\"%s\"}},\"required\":[\"mode\"]},"
                 "\"then\":{\"properties\":{",
                 m ? "," : "", mode->name);
        for (const struct language_key *key = language_option.keys; key->name; key++)
            text_add(out, "%s\"%s\":{}", key == language_option.keys ? "" : ",", key->name);
        for (uint32_t i = 0; i < mode->parameter_count; i++) {
            text_add(out, ",\n\"%s\":", mode->parameters[i].name);
            parameter_write(out, &mode->parameters[i]);
        }
        text_add(out, "},\"additionalProperties\":false}}");
    }
    text_add(out, "]");
}

// Parameters of any mode: where modes share a name, what any of them takes.
static void parameters_write(struct text *out, const struct catalogue *catalogue)
{
    bool first = true;
    text_add(out, "\"properties\":{");
    for (uint32_t m = 0; m < catalogue->mode_count; m++) {
        for (uint32_t i = 0; i < catalogue->modes[m].parameter_count; i++) {
            const char *name = catalogue->modes[m].parameters[i].name;
            bool known = false;
            struct text alike = {0};
            uint32_t count = 0;
            for (uint32_t k = 0; k < catalogue->mode_count; k++)
                for (uint32_t j = 0; j < catalogue->modes[k].parameter_count; j++) {
                    if (strcmp(catalogue->modes[k].parameters[j].name, name) != 0)
                        continue;
                    known = known || k < m;
                    text_add(&alike, count++ ? "," : "");
                    parameter_write(&alike, &catalogue->modes[k].parameters[j]);
                }
            char *each = text_take(&alike);
            if (!known && each)
                text_add(out, count > 1 ? "%s\n\"%s\":{\"anyOf\":[%s]}" : "%s\n\"%s\":%s", first ? "" : ",",
                         name, each);
            first = first && known;
            out->failed = out->failed || !each;
            free(each);
        }
    }
    text_add(out, "}");
}

static void section_write(struct text *out, const struct language_section *section,
                          const struct catalogue *catalogue)
{
    text_add(out, "\"description\":");
    text_json_string(out, section->about);
    text_add(out, ",\n");
    if (section->shorthand == LANGUAGE_SHORT_NAME)
        text_add(out, "\"anyOf\":[{" NAME_SCHEMA "},{");
    if (section->shorthand == LANGUAGE_SHORT_VALUES) {
        text_add(out, "\"anyOf\":[");
        values_write(out);
        text_add(out, ",{");
    }
    text_add(out, "\"type\":\"object\",");
    if (section == &language_parameters)
        parameters_write(out, catalogue);
    else
        properties_write(out, section, catalogue);
    if (section == &language_option)
        modes_write(out, catalogue);
    else
        text_add(out, ",\"additionalProperties\":false");
    text_add(out, section->shorthand ? "}]" : "");
}

char *protocol_schema(const struct catalogue *catalogue)
{
    struct text out = {0};
    text_add(&out, "{\"$schema\":\"https://json-schema.org/draft/2020-12/schema\",\n"
                   "\"title\":\"fovstudy protocol\",\n");
    section_write(&out, &language_protocol, catalogue);
    text_add(&out, ",\n\"$defs\":{");
    for (uint32_t i = 1; language_sections[i]; i++) {
        text_add(&out, "%s\n\"%s\":{", i > 1 ? "," : "", definition(language_sections[i]->title));
        section_write(&out, language_sections[i], catalogue);
        text_add(&out, "}");
    }
    text_add(&out, "}}\n");
    return text_take(&out);
}
