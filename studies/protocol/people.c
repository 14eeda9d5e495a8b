#include "studies/protocol/parts.h"

#include <string.h>

static bool scale_read(struct reader *reader, const struct yaml_node *map, struct protocol_question *question)
{
    const struct yaml_node *scale = yaml_get(map, "scale"), *count = yaml_get(map, "count");
    int64_t ends[2] = {0, 0};
    if (scale && count)
        return read_fail_key(reader, count, "a question has a scale or a count; remove one");
    if (!key_range(reader, map, &language_question, scale ? "scale" : "count", ends))
        return false;
    if (scale && ends[0] == ends[1])
        return read_fail(reader, scale, "the scale ends where it begins, at %d; widen it", (int)ends[0]);
    question->type = scale ? PROTOCOL_ASK_RATING : count ? PROTOCOL_ASK_COUNT : PROTOCOL_ASK_CHOICE;
    question->scale_min = (int32_t)ends[0];
    question->scale_max = (int32_t)ends[1];
    return true;
}

static bool question_read(struct reader *reader, const struct yaml_node *node,
                          struct protocol_question *question)
{
    const struct language_section *section = &language_question;
    uint32_t equal = 0, correct = 0;
    if (!read_key_name(reader, node, "question", question->name) ||
        !read_section(reader, node, section, NULL) || !key_text(reader, node, "text", "", &question->text) ||
        !scale_read(reader, node, question) || !key_word(reader, node, section, "equal", &equal) ||
        !key_word(reader, node, section, "correct", &correct))
        return false;
    question->equal = equal == 1;
    question->correct = (enum protocol_correct)correct;
    question->label_min = question->label_max = arena_text(reader->arena, "", 0);
    if ((equal || correct) && question->type != PROTOCOL_ASK_CHOICE)
        return read_fail(reader, node, "'equal' and 'correct' are for choices; question '%s' has a number",
                         question->name);
    const struct yaml_node *labels = yaml_get(node, "labels");
    if (!labels)
        return true;
    if (question->type != PROTOCOL_ASK_RATING)
        return read_fail_key(reader, labels,
                             "labels name the ends of a scale; add 'scale: [1, 10]' or remove them");
    return read_is_list(reader, labels, "labels", 2, 2) &&
           read_text(reader, labels->first, "the lower label", &question->label_min) &&
           read_text(reader, labels->last, "the upper label", &question->label_max);
}

bool questions_read(struct reader *reader, const struct yaml_node *root)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *map = yaml_get(root, "questions");
    if (!map)
        return true;
    if (!read_is_map(reader, map, "questions"))
        return false;
    if (map->count == 0 || map->count > PROTOCOL_QUESTIONS)
        return read_fail_count(reader, map, "questions", 1, PROTOCOL_QUESTIONS);
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        if (!question_read(reader, node, &protocol->questions[protocol->question_count]))
            return false;
        protocol->question_count++;
    }
    return true;
}

bool consent_read(struct reader *reader, const struct yaml_node *root)
{
    const struct yaml_node *map = yaml_get(root, "consent");
    return read_section(reader, map, &language_consent, NULL) &&
           key_text(reader, map, "version", "", &reader->protocol->consent_version) &&
           key_text(reader, map, "text", "", &reader->protocol->consent_text);
}

static bool choices_read(struct reader *reader, const struct yaml_node *node,
                         struct protocol_attribute *attribute)
{
    if (!read_is_list(reader, node, "choices", 2, PROTOCOL_CHOICES))
        return false;
    for (const struct yaml_node *each = node->first; each; each = each->next) {
        if (!read_name(reader, each, "choice", attribute->choices[attribute->choice_count]))
            return false;
        attribute->choice_count++;
    }
    return true;
}

// What belongs to one type only.
static bool limits_read(struct reader *reader, const struct yaml_node *map,
                        struct protocol_attribute *attribute)
{
    bool number = attribute->type == PROTOCOL_INTEGER || attribute->type == PROTOCOL_NUMBER;
    const struct yaml_node *min = yaml_get(map, "min"), *max = yaml_get(map, "max"),
                           *choices = yaml_get(map, "choices");
    attribute->min = -1e15;
    attribute->max = 1e15;
    if ((min || max) && !number)
        return read_fail_key(reader, min ? min : max, "min and max are for numbers; remove them");
    if (min && !read_number(reader, min, "min", -1e15, 1e15, &attribute->min))
        return false;
    if (max && !read_number(reader, max, "max", -1e15, 1e15, &attribute->max))
        return false;
    if (max && attribute->max < attribute->min)
        return read_fail(reader, max, "max is %g, below min %g; swap them", attribute->max, attribute->min);
    if (attribute->type != PROTOCOL_CHOICE)
        return choices ? read_fail_key(reader, choices, "choices are for 'type: choice'; change the type")
                       : true;
    if (!choices)
        return read_fail(reader, map, "the attribute has no 'choices'; add them");
    return choices_read(reader, choices, attribute);
}

static bool attribute_read(struct reader *reader, const struct yaml_node *map,
                           struct protocol_attribute *attribute)
{
    const struct language_section *section = &language_attribute;
    uint32_t type = 0, required = 0;
    if (!read_section(reader, map, section, NULL) || !key_name(reader, map, section, "name", attribute->name))
        return false;
    for (struct protocol_attribute *other = reader->protocol->attributes; other < attribute; other++)
        if (strcmp(other->name, attribute->name) == 0)
            return read_fail(reader, yaml_get(map, "name"), "attribute '%s' stands here twice; keep one",
                             attribute->name);
    if (!key_word(reader, map, section, "type", &type) ||
        !key_word(reader, map, section, "required", &required) ||
        !key_name(reader, map, section, "unit", attribute->unit) ||
        !key_text(reader, map, "prompt", attribute->name, &attribute->prompt))
        return false;
    attribute->type = (enum protocol_attribute_type)type;
    attribute->required = required == 1;
    return limits_read(reader, map, attribute);
}

bool participant_read(struct reader *reader, const struct yaml_node *root)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = yaml_get(root, "participant");
    if (!list)
        return true;
    if (!read_is_list(reader, list, "participant", 0, PROTOCOL_ATTRIBUTES))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        if (!attribute_read(reader, node, &protocol->attributes[protocol->attribute_count]))
            return false;
        protocol->attribute_count++;
    }
    return true;
}
