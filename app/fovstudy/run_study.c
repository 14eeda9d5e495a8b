#include "app/fovstudy/run_study.h"

#include "app/fovstudy/ask.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// Appends to a JSON object under construction; false where it is full.
static bool append(char *json, size_t size, const char *name, const char *value)
{
    size_t used = strlen(json);
    int wrote = snprintf(json + used, size - used, "%s\"%s\":%s", used > 1 ? "," : "", name, value);
    return wrote > 0 && (size_t)wrote < size - used - 1;
}

static bool add_attribute(struct run_study *study, const char *text, bool *seen, char *error, size_t error_size)
{
    char name[PROTOCOL_NAME], value[1024];
    size_t length = strcspn(text, "=");
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    const struct protocol_attribute *attribute = protocol_attribute_find(study->protocol, name);
    if (!attribute) {
        snprintf(error, error_size, "the protocol asks for no attribute '%s'; see its participant section",
                 name);
        return false;
    }
    size_t index = (size_t)(attribute - study->protocol->attributes);
    if (seen[index]) {
        snprintf(error, error_size, "attribute '%s' is given twice", name);
        return false;
    }
    seen[index] = true;
    if (!protocol_attribute_json(attribute, text + length + 1, value, sizeof value, error, error_size))
        return false;
    if (append(study->attributes, sizeof study->attributes, name, value))
        return true;
    snprintf(error, error_size, "the attributes are too long");
    return false;
}

// What the command line does not say is asked where somebody can answer.
static bool find_out(struct run_study *study, const struct protocol_attribute *attribute, char *error,
                     size_t error_size)
{
    char json[1024] = "";
    bool asked = isatty(STDIN_FILENO) && isatty(STDERR_FILENO);
    if (asked && !ask_attribute(stdin, stderr, attribute, json, sizeof json))
        asked = false; // the input ended
    if (attribute->required && !*json) {
        snprintf(error, error_size, "the protocol wants to know '%s' (%s); give --attribute %s=VALUE",
                 attribute->name, attribute->prompt, attribute->name);
        study->wrong_usage = !asked; // of a command line that nobody can add to
        return false;
    }
    if (!*json || append(study->attributes, sizeof study->attributes - 1, attribute->name, json))
        return true;
    snprintf(error, error_size, "the attributes are too long");
    return false;
}

static bool read_attributes(struct run_study *study, const struct run_options *options, char *error,
                            size_t error_size)
{
    bool seen[PROTOCOL_ATTRIBUTES] = {false};
    strcpy(study->attributes, "{");
    for (size_t i = 0; i < options->attribute_count; i++)
        if (!add_attribute(study, options->attributes[i], seen, error, error_size)) {
            study->wrong_usage = true;
            return false;
        }
    for (uint32_t i = 0; i < study->protocol->attribute_count && !options->observer; i++)
        if (!seen[i] && !find_out(study, &study->protocol->attributes[i], error, error_size))
            return false;
    strcat(study->attributes, "}");
    return true;
}

static bool start_study(struct run_study *study, const struct run_options *options, char *error,
                        size_t error_size)
{
    *study = (struct run_study){0};
    if (study_names_init(&study->names, options->scenes, options->scene_count))
        return true;
    snprintf(error, error_size, "out of memory");
    return false;
}

static bool read_observer(struct run_study *study, const struct run_options *options, char *error,
                          size_t error_size)
{
    observer_defaults(&study->observer);
    return !options->observer || observer_parse(options->observer, &study->observer, error, error_size);
}

bool run_study_init(struct run_study *study, const struct run_options *options, char *error, size_t error_size)
{
    if (!start_study(study, options, error, error_size))
        return false;
    study->protocol =
        study_load(options->protocol, &study->names, options->scenes, options->scene_count, error, error_size);
    return study->protocol && read_attributes(study, options, error, error_size) &&
           read_observer(study, options, error, error_size);
}

bool run_study_init_stored(struct run_study *study, const struct run_options *options,
                           const struct store_session_start *start, char *error, size_t error_size)
{
    char name[PROTOCOL_NAME + 64];
    if (!start_study(study, options, error, error_size))
        return false;
    snprintf(name, sizeof name, "protocol '%s' in the study file", start->protocol_name);
    study->protocol = study_parse(name, start->protocol_text, &study->names, options->scenes,
                                  options->scene_count, error, error_size);
    return study->protocol && read_observer(study, options, error, error_size);
}

void run_study_finish(struct run_study *study)
{
    protocol_destroy(study->protocol);
    study_names_finish(&study->names);
}

void run_reference(const struct protocol *protocol, struct mode_choice *out)
{
    const struct protocol_option *option = &protocol->options[protocol->reference];
    *out = (struct mode_choice){.mode = mode_find(protocol->catalogue->modes[option->mode].name)};
    for (uint32_t i = 0; out->mode && i < out->mode->parameter_count; i++)
        out->values[i] = option->values[i];
}
