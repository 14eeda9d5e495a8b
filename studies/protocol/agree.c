// What the parts of a protocol say of one another: what can be run, but is hardly what was meant.
#include "studies/protocol/parts.h"

#include <string.h>

static double seconds(int64_t ns)
{
    return (double)ns / 1e9;
}

// --- what nobody sees ---

static bool shows(const struct protocol_block *block, uint32_t option)
{
    bool pair = protocol_kind_is_pair(block->kind) || block->option_count == 2;
    for (uint32_t i = 0; i < block->cell_count; i++)
        if (block->cells[i].shown[0] == option || (pair && block->cells[i].shown[1] == option))
            return true;
    return block->extras[1].count > 0 && block->extras[1].cell.shown[0] == option;
}

static bool asks(const struct protocol_block *block, uint32_t question)
{
    for (uint32_t i = 0; i < block->cell_count; i++) {
        const struct protocol_settings *s = &block->cells[i].settings;
        for (uint32_t k = 0; k < s->asked_count && block->kind != PROTOCOL_ADJUST; k++)
            if (s->asked[k] == question)
                return true;
        for (uint32_t k = 0; k < s->rating_count; k++)
            if (s->ratings[k] == question)
                return true;
        if (s->count_question == (int32_t)question)
            return true;
    }
    return false;
}

static bool visits(const struct protocol_block *block, uint32_t scene)
{
    bool drawn = block->extras[0].count + block->extras[1].count > 0;
    for (uint32_t i = 0; i < block->cell_count; i++) {
        if (block->cells[i].scene == (int32_t)scene)
            return true;
        drawn = drawn || block->cells[i].scene < 0;
    }
    for (uint32_t i = 0; i < block->scene_count && drawn; i++)
        if (block->scenes[i] == scene)
            return true;
    return false;
}

static bool any_block(const struct protocol *protocol, bool (*test)(const struct protocol_block *, uint32_t),
                      uint32_t index)
{
    for (uint32_t b = 0; b < protocol->block_count; b++)
        if (test(&protocol->blocks[b], index))
            return true;
    return false;
}

static void unused_remark(struct reader *reader, const struct yaml_node *root)
{
    const struct protocol *protocol = reader->protocol;
    const struct yaml_node *node = yaml_get(root, "options")->first;
    for (uint32_t i = 0; i < protocol->option_count; i++, node = node->next)
        if (i != protocol->reference && !any_block(protocol, shows, i))
            read_remark(reader, node, "no block shows option '%s'; use it or remove it",
                        protocol->options[i].name);
    node = yaml_get(root, "questions");
    node = node ? node->first : NULL;
    for (uint32_t i = 0; i < protocol->question_count; i++, node = node->next)
        if (!any_block(protocol, asks, i))
            read_remark(reader, node, "no block asks question '%s'; use it or remove it",
                        protocol->questions[i].name);
    node = yaml_get(root, "scenes")->first;
    for (uint32_t i = 0; i < protocol->scene_count; i++, node = node->next)
        if (!any_block(protocol, visits, i))
            read_remark(reader, node, "no block shows scene '%s'; use it or remove it", protocol->scenes[i]);
}

// --- blocks ---

// Two cells that differ in one factor's level only, and show the same.
static bool same_cell(const struct protocol_cell *a, const struct protocol_cell *b)
{
    return a->scene == b->scene && a->role == b->role && memcmp(a->shown, b->shown, sizeof a->shown) == 0 &&
           memcmp(a->option[0].values, b->option[0].values, sizeof a->option[0].values) == 0 &&
           memcmp(a->option[1].values, b->option[1].values, sizeof a->option[1].values) == 0 &&
           memcmp(&a->settings, &b->settings, sizeof a->settings) == 0;
}

static void idle_factor_remark(struct reader *reader, const struct yaml_node *map,
                               const struct protocol_block *block)
{
    uint32_t stride = block->cell_count;
    const struct yaml_node *factors = yaml_get(map, "factors");
    const struct yaml_node *node = factors ? factors->first : NULL;
    for (uint32_t f = 0; f < block->factor_count && node; f++, node = node->next) {
        const struct protocol_factor *factor = &block->factors[f];
        stride /= factor->level_count;
        for (uint32_t i = 0; i < block->cell_count; i++) {
            const struct protocol_cell *cell = &block->cells[i];
            if (cell->level[f] == 0 || !same_cell(cell, cell - stride))
                continue;
            read_remark(
                reader, node,
                "levels %s and %s of '%s' show the same in block '%s'; does a factor after it replace the "
                "option that it changes?",
                factor->level[cell->level[f] - 1], factor->level[cell->level[f]], factor->name, block->name);
            break;
        }
    }
}

static void times_remark(struct reader *reader, const struct yaml_node *map, const struct protocol_block *block)
{
    for (uint32_t i = 0; i < block->cell_count; i++) {
        const struct protocol_settings *s = &block->cells[i].settings;
        int64_t fade = s->fade_to_gray_ns + s->fade_gray_ns + s->fade_from_gray_ns;
        bool clock = block->kind == PROTOCOL_SEQUENTIAL || !protocol_kind_is_pair(block->kind);
        if (clock && s->view_ns > 0 && fade > s->view_ns) {
            read_remark(reader, map, "block '%s' fades for %g s, longer than it shows an option (view_s, %g s)",
                        block->name, seconds(fade), seconds(s->view_ns));
            return;
        }
        if (!clock && s->deadline_ns > 0 && s->view_ns > s->deadline_ns) {
            read_remark(
                reader, map,
                "block '%s' ends a trial after %g s (deadline_s), before its view_s of %g s; raise the one or "
                "lower the other",
                block->name, seconds(s->deadline_ns), seconds(s->view_ns));
            return;
        }
    }
}

// Each one that stands between two trials of the squares takes a succession out of the balance.
static void between_remark(struct reader *reader, const struct yaml_node *map,
                           const struct protocol_block *block)
{
    uint32_t extras = block->extras[0].count + block->extras[1].count;
    if (block->order == PROTOCOL_ORDER_LATIN && extras > 0)
        read_remark(
            reader, yaml_get(map, "order"),
            "carry-over in block '%s' is not balanced exactly: null and catch trials come between its cells",
            block->name);
}

static void block_remark(struct reader *reader, const struct yaml_node *map, const struct protocol_block *block)
{
    uint32_t trials = protocol_block_trials(block), counted = 0;
    if (block->break_every >= trials && block->break_every > 0)
        read_remark(reader, yaml_get(map, "break_every"),
                    "block '%s' has %u trial%s, so its break after %u never comes; lower it or remove it",
                    block->name, trials, trials == 1 ? "" : "s", block->break_every);
    if (block->break_every == 0 && yaml_get(map, "break_s"))
        read_remark(reader, yaml_get(map, "break_s"), "block '%s' has no breaks; set 'break_every' too",
                    block->name);
    for (uint32_t i = 0; i < block->cell_count; i++)
        counted += block->cells[i].role == PROTOCOL_MAIN;
    if (block->role == PROTOCOL_MAIN && counted == 0)
        read_remark(reader, map,
                    "block '%s' has no trial that an analysis counts: all are practice, catch or null",
                    block->name);
    between_remark(reader, map, block);
    idle_factor_remark(reader, map, block);
    times_remark(reader, map, block);
}

// --- people ---

static void people_remark(struct reader *reader, const struct yaml_node *root)
{
    const struct protocol *protocol = reader->protocol;
    const struct yaml_node *node = yaml_get(root, "participants"), *map = yaml_get(root, "blocks")->first;
    uint32_t people = protocol->participants, groups = protocol_groups(protocol);
    if (people == 0)
        return;
    if (people < groups)
        read_remark(
            reader, node,
            "%u participants are fewer than the %u groups that the factors between participants make; some "
            "level gets nobody",
            people, groups);
    else if (people % groups != 0)
        read_remark(reader, node,
                    "%u participants do not fill %u groups of people evenly; plan a multiple of %u", people,
                    groups, groups);
    for (uint32_t b = 0; b < protocol->block_count; b++, map = map->next) {
        const struct protocol_block *block = &protocol->blocks[b];
        uint32_t cells = protocol_block_cells(block), rows = groups * (cells % 2 ? 2 * cells : cells);
        if (block->order == PROTOCOL_ORDER_LATIN && cells > 1 && people % rows != 0)
            read_remark(
                reader, yaml_get(map, "order"),
                "carry-over in block '%s' is balanced for each %u participants; %u are no multiple of it",
                block->name, rows, people);
    }
}

// --- planned analysis ---

static bool gives_choices(const struct protocol_block *block, uint32_t unused)
{
    (void)unused;
    return block->role == PROTOCOL_MAIN &&
           (block->kind == PROTOCOL_TOGGLE || block->kind == PROTOCOL_SEQUENTIAL ||
            block->kind == PROTOCOL_STAIRCASE);
}

static bool gives_ratings(const struct protocol_block *block, uint32_t unused)
{
    (void)unused;
    bool ratings = block->kind == PROTOCOL_RATE || block->kind == PROTOCOL_TASK;
    for (uint32_t i = 0; i < block->cell_count; i++)
        ratings = ratings || block->cells[i].settings.rating_count > 0;
    return block->role == PROTOCOL_MAIN && ratings;
}

static bool gives_toggles(const struct protocol_block *block, uint32_t unused)
{
    (void)unused;
    return block->role == PROTOCOL_MAIN &&
           (block->kind == PROTOCOL_TOGGLE || block->kind == PROTOCOL_STAIRCASE ||
            block->kind == PROTOCOL_ADJUST);
}

static bool is_of_kind(const struct protocol_block *block, uint32_t kind)
{
    return block->role == PROTOCOL_MAIN && block->kind == (enum protocol_kind)kind;
}

static bool is_complement(const struct protocol_block *block, uint32_t unused)
{
    (void)unused;
    return block->complement_of >= 0;
}

static bool has_factors(const struct protocol_block *block, uint32_t unused)
{
    (void)unused;
    return block->factor_count > 0 || block->listed;
}

static bool there_is(const struct protocol *protocol, const char *of)
{
    if (strcmp(of, "choice") == 0)
        return any_block(protocol, gives_choices, 0);
    if (strcmp(of, "rating") == 0)
        return any_block(protocol, gives_ratings, 0);
    if (strcmp(of, "toggles") == 0)
        return any_block(protocol, gives_toggles, 0);
    if (strcmp(of, "adjusted") == 0)
        return any_block(protocol, is_of_kind, PROTOCOL_ADJUST);
    if (strcmp(of, "threshold") == 0)
        return any_block(protocol, is_of_kind, PROTOCOL_STAIRCASE);
    return true;
}

static const char *plural(const char *of)
{
    return strcmp(of, "choice") == 0      ? "choices"
           : strcmp(of, "rating") == 0    ? "ratings"
           : strcmp(of, "reaction") == 0  ? "reactions"
           : strcmp(of, "adjusted") == 0  ? "adjusted values"
           : strcmp(of, "threshold") == 0 ? "thresholds"
                                          : of;
}

// What the language permits and no analysis can mean.
static void analysis_sense_remark(struct reader *reader, const struct yaml_node *node, uint32_t index)
{
    const struct protocol_analysis *all = reader->protocol->analyses, *a = &all[index];
    for (uint32_t i = 0; i < index; i++)
        if (strcmp(all[i].method, a->method) == 0 && strcmp(all[i].of, a->of) == 0 &&
            strcmp(all[i].per, a->per) == 0) {
            read_remark(reader, node, "this analysis is planned twice, as number %u and %u; remove one", i + 1,
                        index + 1);
            break;
        }
    if (strcmp(a->method, "anova") == 0 && *a->per && strcmp(a->per, "factor") != 0)
        read_remark(reader, yaml_get(node, "per"),
                    "an analysis of variance compares levels of factors, not each %s; write 'per: factor'",
                    a->per);
}

static void analysis_remark(struct reader *reader, const struct yaml_node *root)
{
    const struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = yaml_get(root, "analysis"), *node = list ? list->first : NULL;
    bool labelled = any_block(protocol, has_factors, 0);
    for (uint32_t i = 0; i < protocol->scene_count; i++)
        labelled = labelled || *protocol->scene_labels[i];
    for (uint32_t i = 0; i < protocol->analysis_count && node; i++, node = node->next) {
        const struct protocol_analysis *a = &protocol->analyses[i];
        if (!there_is(protocol, a->of))
            read_remark(reader, yaml_get(node, "of"), "no block gives %s to analyse", plural(a->of));
        else if (strcmp(a->method, "binomial") == 0 && strcmp(a->of, "choice") != 0)
            read_remark(reader, yaml_get(node, "method"), "the binomial test counts choices, not %s",
                        plural(a->of));
        analysis_sense_remark(reader, node, i);
        if (strcmp(a->per, "order") == 0 && !any_block(protocol, is_complement, 0))
            read_remark(reader, yaml_get(node, "per"),
                        "no rate block has its complement, so there are no orders to split by");
        if (strcmp(a->per, "factor") == 0 && !labelled)
            read_remark(reader, yaml_get(node, "per"), "no block has factors to split by");
    }
}

static void exclude_remark(struct reader *reader, const struct yaml_node *root)
{
    const struct protocol *protocol = reader->protocol;
    const struct yaml_node *list = yaml_get(root, "exclude"), *node = list ? list->first : NULL;
    bool catches = false;
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        const struct protocol_block *block = &protocol->blocks[b];
        catches = catches || block->extras[1].count > 0;
        for (uint32_t i = 0; i < block->cell_count; i++)
            catches = catches || block->cells[i].role == PROTOCOL_CATCH;
    }
    for (uint32_t i = 0; i < protocol->exclusion_count && node; i++, node = node->next)
        if (protocol->exclusions[i].rule == PROTOCOL_FAILED_CATCH && !catches)
            read_remark(reader, yaml_get(node, "rule"), "no block has catch trials that could be failed");
}

void agreement_remark(struct reader *reader, const struct yaml_node *root)
{
    const struct protocol *protocol = reader->protocol;
    const struct yaml_node *map = yaml_get(root, "blocks")->first;
    people_remark(reader, root);
    unused_remark(reader, root);
    analysis_remark(reader, root);
    exclude_remark(reader, root);
    for (uint32_t b = 0; b < protocol->block_count; b++, map = map->next)
        block_remark(reader, map, &protocol->blocks[b]);
}
