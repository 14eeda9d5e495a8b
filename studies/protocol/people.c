#include "studies/protocol/parts.h"

#include <string.h>

static bool key_name(struct reader *reader, const struct yaml_node *node, const char *what,
                     char out[PROTOCOL_NAME])
{
    struct yaml_node name = {
        .kind = YAML_SCALAR, .text = node->key, .line = node->key_line, .column = node->key_column};
    return read_name(reader, &name, what, out);
}

static bool scale_read(struct reader *reader, const struct yaml_node *node, struct protocol_question *question)
{
    int64_t ends[2];
    if (!read_is_list(reader, node, "scale", 2, 2))
        return false;
    if (!read_integer(reader, node->first, "the scale's lower end", -100, 100, &ends[0]) ||
        !read_integer(reader, node->last, "the scale's upper end", -100, 100, &ends[1]))
        return false;
    if (ends[0] >= ends[1])
        return read_fail(reader, node, "the scale ends at %d, not above its begin %d; swap them", (int)ends[1],
                         (int)ends[0]);
    question->scale_min = (int32_t)ends[0];
    question->scale_max = (int32_t)ends[1];
    return true;
}

static bool question_read(struct reader *reader, const struct yaml_node *node,
                          struct protocol_question *question)
{
    static const char *const known[] = {"text", "scale", "labels", NULL};
    if (!key_name(reader, node, "question", question->name) || !read_keys(reader, node, "a question", known))
        return false;
    const struct yaml_node *text = read_required(reader, node, "the question", "text");
    if (!text || !read_text(reader, text, "text", &question->text))
        return false;
    const struct yaml_node *scale = yaml_get(node, "scale"), *labels = yaml_get(node, "labels");
    if (scale && !scale_read(reader, scale, question))
        return false;
    question->label_min = question->label_max = arena_text(reader->arena, "", 0);
    if (!labels)
        return true;
    if (!scale)
        return read_fail_key(reader, labels,
                             "labels name the ends of a scale; add 'scale: [1, 10]' or remove them");
    return read_is_list(reader, labels, "labels", 2, 2) &&
           read_text(reader, labels->first, "the lower label", &question->label_min) &&
           read_text(reader, labels->last, "the upper label", &question->label_max);
}

bool questions_read(struct reader *reader, const struct yaml_node *root)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *map = read_required(reader, root, "the protocol", "questions");
    if (!map || !read_is_map(reader, map, "questions"))
        return false;
    if (map->count == 0 || map->count > PROTOCOL_QUESTIONS)
        return read_fail(reader, map, "questions has %u entries; it takes 1 to %d", map->count,
                         PROTOCOL_QUESTIONS);
    for (const struct yaml_node *node = map->first; node; node = node->next) {
        if (!question_read(reader, node, &protocol->questions[protocol->question_count]))
            return false;
        protocol->question_count++;
    }
    return true;
}

bool consent_read(struct reader *reader, const struct yaml_node *root)
{
    static const char *const known[] = {"version", "text", NULL};
    const struct yaml_node *map = read_required(reader, root, "the protocol", "consent");
    if (!map || !read_keys(reader, map, "consent", known))
        return false;
    const struct yaml_node *version = read_required(reader, map, "consent", "version");
    if (!version || !read_text(reader, version, "version", &reader->protocol->consent_version))
        return false;
    const struct yaml_node *text = read_required(reader, map, "consent", "text");
    return text && read_text(reader, text, "text", &reader->protocol->consent_text);
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
    if (max && !read_number(reader, max, "max", attribute->min, 1e15, &attribute->max))
        return false;
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
    static const char *const known[] = {"name", "type", "required", "unit", "prompt",
                                        "min",  "max",  "choices",  NULL};
    static const char *const types[] = {"integer", "number", "text", "choice", NULL};
    static const char *const answers[] = {"no", "yes", NULL};
    if (!read_keys(reader, map, "a participant attribute", known))
        return false;
    const struct yaml_node *name = read_required(reader, map, "the attribute", "name");
    if (!name || !read_name(reader, name, "attribute", attribute->name))
        return false;
    for (struct protocol_attribute *other = reader->protocol->attributes; other < attribute; other++)
        if (strcmp(other->name, attribute->name) == 0)
            return read_fail(reader, name, "attribute '%s' stands here twice; keep one", attribute->name);
    const struct yaml_node *type = read_required(reader, map, "the attribute", "type");
    uint32_t type_index, required = 0;
    if (!type || !read_word(reader, type, "type", types, &type_index))
        return false;
    attribute->type = (enum protocol_attribute_type)type_index;
    const struct yaml_node *need = yaml_get(map, "required"), *unit = yaml_get(map, "unit"),
                           *prompt = yaml_get(map, "prompt");
    if (need && !read_word(reader, need, "required", answers, &required))
        return false;
    attribute->required = required == 1;
    if (unit && !read_name(reader, unit, "unit", attribute->unit))
        return false;
    if (prompt ? !read_text(reader, prompt, "prompt", &attribute->prompt)
               : !(attribute->prompt = arena_text(reader->arena, attribute->name, strlen(attribute->name))))
        return false;
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

bool analysis_read(struct reader *reader, const struct yaml_node *root)
{
    static const char *const known[] = {"method", "of", "per", NULL};
    static const char *const words[3][8] = {{"binomial", "paired_t", "unpaired_t", "mean", NULL},
                                            {"choice", "rating", "toggles", "reaction", NULL},
                                            {"cell", "factor", "order", "scene", "study", NULL}};
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = yaml_get(root, "analysis");
    if (!list)
        return true;
    if (!read_is_list(reader, list, "analysis", 0, PROTOCOL_ANALYSES))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        struct protocol_analysis *analysis = &protocol->analyses[protocol->analysis_count++];
        char *const into[3] = {analysis->method, analysis->of, analysis->per};
        if (!read_keys(reader, node, "an analysis", known))
            return false;
        for (uint32_t i = 0; i < 3; i++) {
            const struct yaml_node *value =
                i < 2 ? read_required(reader, node, "the analysis", known[i]) : yaml_get(node, known[i]);
            uint32_t index;
            if (!value && i < 2)
                return false;
            if (value && !read_word(reader, value, known[i], words[i], &index))
                return false;
            if (value)
                strcpy(into[i], words[i][index]);
        }
    }
    return true;
}
