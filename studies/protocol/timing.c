// Times of a trial that cannot all hold, and times that can but show little.
//
// What ends a trial: of sequential trials, and of rate and task trials with a view_s, the clock; of the others
// the participant. A deadline counts from the first full image where the answer is given while looking, else
// from the question.
#include "studies/protocol/parts.h"

// The setting's own place where the block or trial has it, else the block or trial.
static const struct yaml_node *place_of(const struct yaml_node *node, const char *key)
{
    const struct yaml_node *settings = node->kind == YAML_MAP ? yaml_get(node, "settings") : NULL;
    const struct yaml_node *own = settings && settings->kind == YAML_MAP ? yaml_get(settings, key) : NULL;
    return own ? own : node;
}

static double seconds(int64_t ns)
{
    return (double)ns / 1e9;
}

static bool clock_ends(const struct protocol_block *block)
{
    return block->kind == PROTOCOL_SEQUENTIAL || !protocol_kind_is_pair(block->kind);
}

bool timing_check(struct reader *reader, const struct yaml_node *node, const struct protocol_block *block,
                  const struct protocol_settings *settings)
{
    int64_t fade = settings->fade_to_gray_ns + settings->fade_gray_ns + settings->fade_from_gray_ns;
    int64_t view = settings->view_ns, least = settings->min_exposure_ns, deadline = settings->deadline_ns;
    if (clock_ends(block) && view > 0 && view < least)
        return read_fail(reader, place_of(node, "min_exposure_s"),
                         "block '%s' shows an option for %g s (view_s), but asks that it was shown for %g s "
                         "(min_exposure_s); lower min_exposure_s or raise view_s",
                         block->name, seconds(view), seconds(least));
    if (!clock_ends(block) && deadline > 0 && 2 * least + (least > 0 ? fade : 0) > deadline)
        return read_fail(
            reader, place_of(node, "deadline_s"),
            "block '%s' takes no answer before both options were shown for %g s (min_exposure_s), with "
            "the fade %g s, but none after %g s (deadline_s); raise deadline_s or lower min_exposure_s",
            block->name, seconds(least), seconds(2 * least + fade), seconds(deadline));
    return true;
}
