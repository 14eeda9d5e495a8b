// What belongs to one kind of block: null and catch trials of pairs, parameters to adjust.
#include "studies/protocol/parts.h"

#include <math.h>
#include <stdio.h>

static bool catch_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    struct protocol_extra *extra = &block->extras[1];
    if (!read_section(reader, map, &language_catch, NULL) ||
        !key_integer(reader, map, &language_catch, "count", &extra->count))
        return false;
    struct yaml_node change = *map, rest[2];
    const struct yaml_node *option = yaml_get(map, "option"), *parameters = yaml_get(map, "parameters");
    rest[0] = *option;
    rest[0].next = parameters ? &rest[1] : NULL;
    if (parameters) {
        rest[1] = *parameters;
        rest[1].next = NULL;
    }
    change.first = &rest[0];
    change.last = &rest[parameters ? 1 : 0];
    change.count = parameters ? 2 : 1;
    cell_init(reader->protocol, block, &extra->cell);
    extra->cell.role = PROTOCOL_CATCH;
    return cell_change(reader, &change, block, &extra->cell) && cell_check(reader, map, block, &extra->cell);
}

bool extras_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    const struct yaml_node *catch_node = yaml_get(map, "catch"), *null_node = yaml_get(map, "null");
    struct protocol_extra *null_extra = &block->extras[0];
    bool pair = block->kind == PROTOCOL_TOGGLE || block->kind == PROTOCOL_SEQUENTIAL;
    if ((catch_node || null_node) && !pair)
        return read_fail_key(
            reader, null_node ? null_node : catch_node,
            "blocks of kind %s have no null and catch trials; use them in toggle and sequential blocks",
            protocol_kind_name(block->kind));
    if (!key_integer(reader, map, &language_block, "null", &null_extra->count))
        return false;
    if (null_extra->count > 0) {
        cell_init(reader->protocol, block, &null_extra->cell);
        null_extra->cell.role = PROTOCOL_NULL;
        null_extra->cell.shown[0] = null_extra->cell.shown[1];
        null_extra->cell.option[0] = null_extra->cell.option[1];
        if (!cell_check(reader, map, block, &null_extra->cell))
            return false;
    }
    return !catch_node || catch_read(reader, catch_node, block);
}

static bool start_read(struct reader *reader, const struct yaml_node *map, struct protocol_adjust *adjust)
{
    const struct yaml_node *node = yaml_get(map, "start");
    return read_is_list(reader, node, "start", 2, 2) &&
           read_number(reader, node->first, "start", adjust->min, adjust->max, &adjust->start_min) &&
           read_number(reader, node->last, "start", adjust->min, adjust->max, &adjust->start_max) &&
           (adjust->start_max >= adjust->start_min ||
            read_fail(reader, node, "start ends at %g, below its begin %g; swap them", adjust->start_max,
                      adjust->start_min));
}

bool parameter_is_free(struct reader *reader, const struct yaml_node *node, const struct protocol_block *block,
                       uint32_t parameter, const char *who)
{
    for (uint32_t i = 0; i < block->cell_count; i++) {
        const struct protocol_option *now = &block->cells[i].option[0],
                                     *before = &reader->protocol->options[block->cells[i].shown[0]];
        if (now->values[parameter] < before->values[parameter] ||
            now->values[parameter] > before->values[parameter])
            return read_fail(reader, node,
                             "%s sets '%s', and so does a factor or a trial of block '%s'; keep one", who,
                             reader->catalogue->modes[now->mode].parameters[parameter].name, block->name);
    }
    return true;
}

static bool adjust_read(struct reader *reader, const struct yaml_node *node, struct protocol_block *block)
{
    struct protocol_adjust *adjust = &block->adjusts[block->adjust_count];
    uint32_t tested = reader->protocol->options[block->options[0]].mode;
    if (!parameter_find(reader, node, true, node->key, tested, &adjust->parameter) ||
        !read_section(reader, node, &language_adjust, NULL))
        return false;
    const struct catalogue_parameter *parameter =
        &reader->catalogue->modes[tested].parameters[adjust->parameter];
    if (parameter->choices)
        return read_fail_key(reader, node, "'%s' is a switch, which has no steps; adjust a number",
                             parameter->name);
    if (!parameter_is_free(reader, node, block, adjust->parameter, "the participant"))
        return false;
    adjust->min = parameter->min;
    adjust->max = parameter->max;
    const struct yaml_node *min = yaml_get(node, "min"), *max = yaml_get(node, "max");
    if ((min && !read_number(reader, min, "min", parameter->min, parameter->max, &adjust->min)) ||
        (max && !read_number(reader, max, "max", parameter->min, parameter->max, &adjust->max)) ||
        (adjust->max <= adjust->min &&
         !read_fail(reader, max ? max : node, "max is %g, and min %g; it must be above min", adjust->max,
                    adjust->min)) ||
        !key_number(reader, node, &language_adjust, "step", &adjust->step) || !start_read(reader, node, adjust))
        return false;
    if (adjust->step > adjust->max - adjust->min)
        return read_fail(reader, yaml_get(node, "step"), "step is %g; from min to max it is only %g",
                         adjust->step, adjust->max - adjust->min);
    block->adjust_count++;
    return true;
}

bool adjusts_read(struct reader *reader, const struct yaml_node *map, struct protocol_block *block)
{
    const struct yaml_node *adjust = yaml_get(map, "adjust");
    if (block->kind != PROTOCOL_ADJUST)
        return adjust ? read_fail_key(reader, adjust, "'adjust' belongs to blocks of 'kind: adjust'") : true;
    if (!read_is_map(reader, adjust, "adjust"))
        return false;
    if (adjust->count < 1 || adjust->count > PROTOCOL_ADJUSTED)
        return read_fail_count(reader, adjust, "adjust", 1, PROTOCOL_ADJUSTED);
    for (const struct yaml_node *node = adjust->first; node; node = node->next)
        if (!adjust_read(reader, node, block))
            return false;
    return true;
}
