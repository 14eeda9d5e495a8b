// Options, settings and attributes as the store keeps them.
#include "studies/protocol/protocol.h"

#include "studies/protocol/text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void value_write(struct text *text, const struct catalogue_parameter *parameter, double value)
{
    text_json_string(text, parameter->name);
    text_add(text, ":");
    if (parameter->choices)
        text_json_string(text, parameter->choices[(size_t)value]);
    else
        text_number(text, value);
}

bool protocol_option_json(const struct protocol *protocol, const struct protocol_option *option, char *out,
                          size_t out_size)
{
    const struct catalogue_mode *mode = &protocol->catalogue->modes[option->mode];
    struct text text = {0};
    text_add(&text, "{");
    for (uint32_t i = 0; i < mode->parameter_count && i < CATALOGUE_PARAMETERS; i++) {
        text_add(&text, i ? "," : "");
        value_write(&text, &mode->parameters[i], option->values[i]);
    }
    text_add(&text, "}");
    return text_copy(&text, out, out_size);
}

static void seconds_write(struct text *text, const char *name, int64_t ns)
{
    if (ns == 0)
        return;
    text_add(text, ",\"%s\":", name);
    text_number(text, (double)ns / 1e9);
}

bool protocol_settings_json(const struct protocol *protocol, enum protocol_kind kind,
                            const struct protocol_settings *settings, const char *more, char *out,
                            size_t out_size)
{
    const struct catalogue *catalogue = protocol->catalogue;
    struct text text = {0};
    text_add(&text, "{\"procedure\":\"%s\",\"camera\":\"%s\",\"foveate\":\"%s\"", protocol_kind_name(kind),
             protocol_camera_name(settings->camera), protocol_foveate_name(settings->foveate));
    for (uint32_t i = 0; i < catalogue->setting_count; i++) {
        text_add(&text, ",");
        value_write(&text, &catalogue->settings[i], settings->render[i]);
    }
    const int64_t fades[] = {settings->fade_to_gray_ns, settings->fade_gray_ns, settings->fade_from_gray_ns};
    for (uint32_t i = 0; i < 3; i++) {
        text_add(&text, i ? "," : ",\"fade_s\":[");
        text_number(&text, (double)fades[i] / 1e9);
    }
    text_add(&text, "]");
    seconds_write(&text, "path_start_s", settings->path_start_ns);
    seconds_write(&text, "view_s", settings->view_ns);
    seconds_write(&text, "gap_s", kind == PROTOCOL_SEQUENTIAL ? settings->gap_ns : 0);
    seconds_write(&text, "min_exposure_s", settings->min_exposure_ns);
    seconds_write(&text, "deadline_s", settings->deadline_ns);
    text_add(&text, "%s}", more);
    return text_copy(&text, out, out_size);
}

const struct protocol_attribute *protocol_attribute_find(const struct protocol *protocol, const char *name)
{
    for (uint32_t i = 0; i < protocol->attribute_count; i++)
        if (strcmp(protocol->attributes[i].name, name) == 0)
            return &protocol->attributes[i];
    return NULL;
}

static bool number_json(const struct protocol_attribute *attribute, const char *value, struct text *text,
                        char *error, size_t error_size)
{
    bool integer = attribute->type == PROTOCOL_INTEGER;
    char *end = NULL;
    bool legal = *value && strspn(value, integer ? "+-0123456789" : "+-.0123456789eE") == strlen(value);
    double number = legal ? strtod(value, &end) : 0;
    if (!legal || *end || !isfinite(number)) {
        snprintf(error, error_size, "%s is a %snumber, not '%.60s'", attribute->name, integer ? "whole " : "",
                 value);
        return false;
    }
    if (number < attribute->min || number > attribute->max) {
        snprintf(error, error_size, "%s is %.60s; it must lie between %g and %g", attribute->name, value,
                 attribute->min, attribute->max);
        return false;
    }
    text_number(text, number);
    return true;
}

bool protocol_attribute_json(const struct protocol_attribute *attribute, const char *value, char *out,
                             size_t out_size, char *error, size_t error_size)
{
    struct text text = {0};
    if (attribute->type == PROTOCOL_INTEGER || attribute->type == PROTOCOL_NUMBER) {
        if (!number_json(attribute, value, &text, error, error_size))
            return false;
    } else {
        bool found = attribute->type == PROTOCOL_TEXT && *value;
        struct text list = {0};
        for (uint32_t i = 0; i < attribute->choice_count; i++) {
            found = found || strcmp(attribute->choices[i], value) == 0;
            text_add(&list, "%s%s", i ? ", " : "", attribute->choices[i]);
        }
        char *choices = text_take(&list);
        if (!found)
            snprintf(error, error_size, "%s is '%.60s'; give %s", attribute->name, value,
                     attribute->choice_count && choices ? choices : "a text");
        free(choices);
        if (!found)
            return false;
        text_json_string(&text, value);
    }
    if (text_copy(&text, out, out_size))
        return true;
    snprintf(error, error_size, "%s is too long; shorten it", attribute->name);
    return false;
}
