// What was fixed before the first participant: the planned analysis and the rules that take data out of it.
#include "studies/protocol/parts.h"

#include <math.h>
#include <string.h>

// Only a share of choices has a margin; at 0 or one half there would be nothing to test.
static bool margin_read(struct reader *reader, const struct yaml_node *map, struct protocol_analysis *analysis)
{
    const struct yaml_node *node = yaml_get(map, "margin");
    if (!node)
        return true;
    if (strcmp(analysis->method, "binomial") != 0 || strcmp(analysis->of, "choice") != 0)
        return read_fail_key(reader, node, "'margin' is for a binomial test of choices, not for %s of %s",
                             analysis->method, analysis->of);
    if (!key_number(reader, map, &language_analysis, "margin", &analysis->margin))
        return false;
    if (!(analysis->margin > 0 && analysis->margin < 0.5))
        return read_fail(reader, node, "'margin' is %g but must lie between 0 and 0.5, and be neither",
                         analysis->margin);
    return true;
}

bool analysis_read(struct reader *reader, const struct yaml_node *root)
{
    static const char *const keys[] = {"method", "of", "per"};
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = yaml_get(root, "analysis");
    if (!list)
        return true;
    if (!read_is_list(reader, list, "analysis", 0, PROTOCOL_ANALYSES))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        struct protocol_analysis *analysis = &protocol->analyses[protocol->analysis_count++];
        char *const into[3] = {analysis->method, analysis->of, analysis->per};
        if (!read_section(reader, node, &language_analysis, NULL))
            return false;
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t index = 0;
            if (!key_word(reader, node, &language_analysis, keys[i], &index))
                return false;
            if (yaml_get(node, keys[i]))
                strcpy(into[i], language_find(&language_analysis, keys[i])->words[index]);
        }
        if (!margin_read(reader, node, analysis))
            return false;
    }
    return true;
}

const char *protocol_rule_name(enum protocol_rule rule)
{
    return language_find(&language_exclusion, "rule")->words[rule];
}

// Each rule's limits where the file gives none. Ours: the issue names one second of exposure; the others follow
// what the field reports (2 to 10 % loss is ordinary, 44 % a lost session; reactions under 0.2 s are no
// judgements). Of a person's catch trials the limit is `share` unless the file has `above`.
static void rule_defaults(struct protocol_exclusion *rule)
{
    static const double above[PROTOCOL_RULE_KINDS] = {
        [PROTOCOL_UNSEEN_OPTION] = NAN, [PROTOCOL_GAZE_LOSS] = 0.2, [PROTOCOL_GAZE_GAP] = 500,
        [PROTOCOL_LATE_FRAMES] = 0.01,  [PROTOCOL_REACTION] = NAN,  [PROTOCOL_FAILED_CATCH] = NAN,
        [PROTOCOL_FALLBACK] = 0};
    rule->above = above[rule->rule];
    rule->below = rule->rule == PROTOCOL_UNSEEN_OPTION ? 1 : rule->rule == PROTOCOL_REACTION ? 0.2 : NAN;
    rule->share = 0.5;
}

static bool exclusion_read(struct reader *reader, const struct yaml_node *node, struct protocol_exclusion *rule)
{
    const struct language_section *section = &language_exclusion;
    uint32_t kind = 0, of = 0, set = 0;
    if (!read_section(reader, node, section, NULL) || !key_word(reader, node, section, "rule", &kind) ||
        !key_word(reader, node, section, "of", &of) || !key_word(reader, node, section, "set", &set))
        return false;
    rule->rule = (enum protocol_rule)kind;
    rule->of = (enum protocol_rule_of)of;
    rule->stricter = set == 1;
    rule_defaults(rule);
    const struct yaml_node *above = yaml_get(node, "above"), *below = yaml_get(node, "below");
    if (above && rule->rule == PROTOCOL_UNSEEN_OPTION)
        return read_fail_key(reader, above, "'%s' holds below a time; write 'below'",
                             protocol_rule_name(rule->rule));
    if (below && rule->rule != PROTOCOL_UNSEEN_OPTION && rule->rule != PROTOCOL_REACTION)
        return read_fail_key(reader, below, "'%s' holds above a limit; write 'above'",
                             protocol_rule_name(rule->rule));
    if (yaml_get(node, "share") && rule->of != PROTOCOL_OF_PERSON)
        return read_fail_key(reader, yaml_get(node, "share"), "'share' is for rules 'of: person'");
    return key_number(reader, node, section, "above", &rule->above) &&
           key_number(reader, node, section, "below", &rule->below) &&
           key_number(reader, node, section, "share", &rule->share);
}

bool exclude_read(struct reader *reader, const struct yaml_node *root)
{
    struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = yaml_get(root, "exclude");
    if (!list)
        return true;
    if (!read_is_list(reader, list, "exclude", 0, PROTOCOL_RULES))
        return false;
    for (const struct yaml_node *node = list->first; node; node = node->next) {
        if (!exclusion_read(reader, node, &protocol->exclusions[protocol->exclusion_count]))
            return false;
        protocol->exclusion_count++;
    }
    return true;
}
