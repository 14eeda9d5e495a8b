#include "renderer/mode.h"

#include "renderer/modes/room.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct mode *const modes[] = {
    &mode_regular,
    &mode_time_warped,
    &mode_vrs,
    NULL,
};

const struct mode *mode_find(const char *name)
{
    for (size_t i = 0; modes[i]; i++) {
        if (strcmp(modes[i]->name, name) == 0)
            return modes[i];
    }
    return NULL;
}

int mode_parameter_index(const struct mode *mode, const char *name)
{
    for (uint32_t i = 0; i < mode->parameter_count; i++) {
        if (strcmp(mode->parameters[i].name, name) == 0)
            return (int)i;
    }
    return -1;
}

static void list_modes(char *out, size_t size)
{
    out[0] = '\0';
    for (size_t i = 0; modes[i]; i++)
        snprintf(out + strlen(out), size - strlen(out), "%s%s", i ? ", " : "", modes[i]->name);
}

static void list_parameters(const struct mode *mode, char *out, size_t size)
{
    snprintf(out, size, "%s", mode->parameter_count ? "" : "none");
    for (uint32_t i = 0; i < mode->parameter_count; i++)
        snprintf(out + strlen(out), size - strlen(out), "%s%s", i ? ", " : "", mode->parameters[i].name);
}

static bool choose_word(const struct mode_parameter *p, const char *text, double *out)
{
    for (int i = 0; p->choices[i]; i++) {
        if (strcmp(p->choices[i], text) == 0) {
            *out = i;
            return true;
        }
    }
    return false;
}

bool mode_set(struct mode_choice *choice, const char *name, const char *text, char *error, size_t error_size)
{
    int index = mode_parameter_index(choice->mode, name);
    if (index < 0) {
        char known[512];
        list_parameters(choice->mode, known, sizeof known);
        snprintf(error, error_size, "mode '%s' has no parameter '%s'; it has: %s", choice->mode->name, name,
                 known);
        return false;
    }
    const struct mode_parameter *p = &choice->mode->parameters[index];
    if (p->choices) {
        if (choose_word(p, text, &choice->values[index]))
            return true;
        snprintf(error, error_size,
                 "%s of mode '%s' is not '%s'; it is one of the words 'fovstudy modes' lists", name,
                 choice->mode->name, text);
        return false;
    }
    char *end = NULL;
    double value = strtod(text, &end);
    if (end == text || *end || !isfinite(value)) {
        snprintf(error, error_size, "%s of mode '%s' is not a number: '%s'", name, choice->mode->name, text);
        return false;
    }
    if (value < p->min || value > p->max) {
        snprintf(error, error_size, "%s of mode '%s' is %s; it goes from %g to %g%s%s", name,
                 choice->mode->name, text, p->min, p->max, p->unit[0] ? " " : "", p->unit);
        return false;
    }
    choice->values[index] = value;
    return true;
}

bool mode_check(const struct mode_choice *choice, char *error, size_t error_size)
{
    return !choice->mode->agree || choice->mode->agree(choice->values, error, error_size);
}

bool mode_parse(const char *spec, struct mode_choice *out, char *error, size_t error_size)
{
    char text[512];
    if (strlen(spec) >= sizeof text) {
        snprintf(error, error_size, "the mode's description is longer than %zu characters", sizeof text - 1);
        return false;
    }
    memcpy(text, spec, strlen(spec) + 1);
    char *rest = strchr(text, ':');
    if (rest)
        *rest++ = '\0';
    *out = (struct mode_choice){.mode = mode_find(text)};
    if (!out->mode) {
        char known[256];
        list_modes(known, sizeof known);
        snprintf(error, error_size, "there is no mode '%s'; there are: %s", text, known);
        return false;
    }
    for (uint32_t i = 0; i < out->mode->parameter_count; i++)
        out->values[i] = out->mode->parameters[i].fallback;
    while (rest && *rest) {
        char *pair = rest, *next = strchr(rest, ',');
        if (next)
            *next++ = '\0';
        rest = next;
        char *value = strchr(pair, '=');
        if (!value) {
            snprintf(error, error_size, "'%s' in '%s' is not name=value", pair, spec);
            return false;
        }
        *value++ = '\0';
        if (!mode_set(out, pair, value, error, error_size))
            return false;
    }
    return mode_check(out, error, error_size);
}

bool mode_parameters_json(const struct mode_choice *choice, char *out, size_t out_size)
{
    size_t used = 0;
    int n = snprintf(out, out_size, "{");
    for (uint32_t i = 0; n >= 0 && (used += (size_t)n) < out_size && i < choice->mode->parameter_count; i++) {
        const struct mode_parameter *p = &choice->mode->parameters[i];
        const char *comma = i ? "," : "";
        if (p->choices)
            n = snprintf(out + used, out_size - used, "%s\"%s\":\"%s\"", comma, p->name,
                         p->choices[(int)choice->values[i]]);
        else
            n = snprintf(out + used, out_size - used, "%s\"%s\":%.12g", comma, p->name, choice->values[i]);
    }
    if (n < 0 || used + 2 > out_size)
        return false;
    memcpy(out + used, "}", 2);
    return true;
}
