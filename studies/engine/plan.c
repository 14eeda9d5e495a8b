// How each thing is drawn. Every stream is Philox keyed by SHA-256(tag, protocol hash, seed) and named
// (purpose, subject, block), so no draw moves another.
//
//   scenes  ALTERNATE: one draw per study and block gives each trial of the block (cell x repetition) a first
//   scene, each
//           scene as often as any other within one, in the whole and in every factor level; participant n has
//           the scene n places further in the list. Each cell's scene so alternates over participants. RANDOM:
//           participants are taken in runs as long as the list of scenes (times the options for a rating); a
//           run shares one random permutation of all combinations, and each participant takes one.
//   sides   one draw per four participants 4j..4j+3 (subject j) gives each trial its side and first-shown
//   option, balanced as
//           balance.h says over block, factor levels, scenes and cells. The four take the reflections (side,
//           first) ^ (0,0), (0,1), (1,1), (1,0): in this order each scene of a cell, which alternates, meets
//           both sides and both first-shown options.
//   order   one permutation per participant and block.
//   rating  which option is rated first: with the scene, above. A complement takes the same scene and the other
//   option. seeds   one 63-bit word per participant and trial.
#include "studies/engine/plan.h"

#include "studies/engine/balance.h"
#include "studies/protocol/text.h"

#include <stdlib.h>
#include <string.h>

enum purpose { PURPOSE_SCENES = 1, PURPOSE_SIDES, PURPOSE_ORDER, PURPOSE_RUN, PURPOSE_SEED };

// What is drawn for one block.
struct draw {
    uint32_t count;
    uint32_t scene[PROTOCOL_TRIALS]; // indices into protocol.scenes
    uint32_t
        pair[PROTOCOL_TRIALS]; // bit 0: the tested option is in slot b; bit 1: the reference is shown first
    uint32_t order[PROTOCOL_TRIALS]; // which trial of the block comes at each place
    uint32_t option;                 // of a rating: 0 or 1 into block.options
    uint32_t excess;
};

struct maker {
    struct plan *plan;
    uint64_t key;
    struct draw *draws; // one per block
};

const char *plan_slot_name(enum plan_slot slot)
{
    return slot == PLAN_SLOT_A ? "a" : slot == PLAN_SLOT_B ? "b" : NULL;
}

static uint64_t plan_key(const struct protocol *protocol, uint64_t seed)
{
    static const char tag[16] = "fovstudy plan 1"; // a change of any rule above changes the tag
    uint8_t bytes[sizeof tag + SHA256_BYTES + 8], digest[SHA256_BYTES];
    memcpy(bytes, tag, sizeof tag);
    memcpy(bytes + sizeof tag, protocol->sha256, SHA256_BYTES);
    for (unsigned i = 0; i < 8; i++)
        bytes[sizeof tag + SHA256_BYTES + i] = (uint8_t)(seed >> (8 * i));
    sha256(bytes, sizeof bytes, digest);
    uint64_t key = 0;
    for (unsigned i = 0; i < 8; i++)
        key |= (uint64_t)digest[i] << (8 * i);
    return key;
}

// Level of a factor in a cell; the last factor changes fastest.
static uint32_t cell_level(const struct protocol_block *block, uint32_t cell, uint32_t factor)
{
    for (uint32_t i = block->factor_count - 1; i > factor; i--)
        cell /= block->factors[i].level_count;
    return cell % block->factors[factor].level_count;
}

// Groups of the block, its factor levels and, where cells repeat, its cells. `levels`: the weight of a factor's
// levels.
static void design_block(const struct protocol_block *block, uint32_t levels, struct balance_design *design)
{
    uint32_t key[PROTOCOL_TRIALS] = {0};
    *design = (struct balance_design){.trials = protocol_block_trials(block)};
    uint32_t cells = design->trials / block->repetitions;
    balance_group(design, key, 1, BALANCE_MUST);
    for (uint32_t f = 0; f < block->factor_count; f++) {
        for (uint32_t i = 0; i < design->trials; i++)
            key[i] = design->digit[i][f] = (uint16_t)cell_level(block, i / block->repetitions, f);
        design->levels[f] = block->factors[f].level_count;
        balance_group(design, key, design->levels[f], levels);
    }
    design->digits = block->factor_count;
    if (design->digits == 0) { // listed trials
        for (uint32_t i = 0; i < design->trials; i++)
            design->digit[i][0] = (uint16_t)(i / block->repetitions);
        design->levels[design->digits++] = cells;
    }
    for (uint32_t i = 0; i < design->trials; i++) {
        design->digit[i][design->digits] = (uint16_t)(i % block->repetitions);
        key[i] = i / block->repetitions;
    }
    design->levels[design->digits++] = block->repetitions;
    if (block->repetitions > 1)
        balance_group(design, key, cells, BALANCE_SHOULD);
}

// One of `length` combinations, each once in every run of `length` participants.
static uint32_t draw_run(const struct maker *maker, uint32_t block, uint32_t length)
{
    uint32_t combination[PROTOCOL_SCENES * 2];
    struct random_stream stream = random_stream(maker->key, PURPOSE_RUN, maker->plan->number / length, block);
    for (uint32_t i = 0; i < length; i++)
        combination[i] = i;
    random_shuffle(&stream, combination, length);
    return combination[maker->plan->number % length];
}

static void draw_rating(const struct maker *maker, uint32_t index, struct draw *draw)
{
    const struct protocol_block *block = &maker->plan->protocol->blocks[index];
    draw->count = 1;
    if (block->complement_of >= 0) {
        const struct draw *earlier = &maker->draws[block->complement_of];
        draw->scene[0] = earlier->scene[0];
        draw->option = 1 - earlier->option;
        return;
    }
    uint32_t taken = draw_run(maker, index, block->scene_count * block->option_count);
    draw->option = taken / block->scene_count;
    uint32_t scene = taken % block->scene_count;
    if (block->scene_use ==
        PROTOCOL_ALTERNATE) { // scenes in turn; the options still come as drawn within a run
        struct random_stream stream = random_stream(maker->key, PURPOSE_SCENES, 0, index);
        scene = (random_below(&stream, block->scene_count) + maker->plan->number) % block->scene_count;
    }
    draw->scene[0] = block->scenes[scene];
}

static void draw_scenes(const struct maker *maker, uint32_t index, const struct balance_design *design,
                        struct draw *draw, uint32_t *out_first)
{
    const struct protocol_block *block = &maker->plan->protocol->blocks[index];
    uint32_t turn = maker->plan->number % block->scene_count;
    memset(out_first, 0, design->trials * sizeof *out_first);
    if (block->scene_use == PROTOCOL_RANDOM) {
        turn = draw_run(maker, index, block->scene_count);
    } else {
        struct random_stream stream = random_stream(maker->key, PURPOSE_SCENES, 0, index);
        draw->excess += balance_classes(design, &stream, block->scene_count, out_first);
    }
    for (uint32_t i = 0; i < design->trials; i++) {
        int32_t listed = block->trials ? block->trials[i / block->repetitions].scene : -1;
        draw->scene[i] =
            listed >= 0 ? (uint32_t)listed : block->scenes[(out_first[i] + turn) % block->scene_count];
    }
}

static void draw_toggle(const struct maker *maker, uint32_t index, struct draw *draw)
{
    static const uint32_t reflections[4] = {0, 2, 3, 1};
    const struct protocol_block *block = &maker->plan->protocol->blocks[index];
    uint32_t number = maker->plan->number;
    struct balance_design design;
    uint32_t first_scene[PROTOCOL_TRIALS];
    design_block(block, BALANCE_SHOULD, &design);
    draw->count = design.trials;
    draw_scenes(maker, index, &design, draw, first_scene);
    design_block(block, BALANCE_MUST, &design);

    // Sides and scenes must not go together either. The groups are those of the first scenes, the same for all
    // four.
    if (block->scene_count > 1 && block->scene_use == PROTOCOL_ALTERNATE)
        balance_group(&design, first_scene, block->scene_count, BALANCE_MAY);
    struct random_stream sides = random_stream(maker->key, PURPOSE_SIDES, number / 4, index);
    draw->excess += balance_pairs(&design, &sides, draw->pair);
    for (uint32_t i = 0; i < draw->count; i++)
        draw->pair[i] ^= reflections[number % 4];

    struct random_stream order = random_stream(maker->key, PURPOSE_ORDER, number, index);
    for (uint32_t i = 0; i < draw->count; i++)
        draw->order[i] = i;
    if (block->order == PROTOCOL_ORDER_RANDOM)
        random_shuffle(&order, draw->order, draw->count);
}

// Index of a condition, added where it is new; -1: its JSON does not fit.
static int32_t condition_index(struct plan *plan, const struct protocol_option *option)
{
    struct plan_condition made = {.mode = plan->protocol->catalogue->modes[option->mode].name,
                                  .mode_index = option->mode};
    memcpy(made.values, option->values, sizeof made.values);
    if (!protocol_option_json(plan->protocol, option, made.parameters, sizeof made.parameters))
        return -1;
    for (uint32_t i = 0; i < plan->condition_count; i++)
        if (plan->conditions[i].mode_index == made.mode_index &&
            strcmp(plan->conditions[i].parameters, made.parameters) == 0)
            return (int32_t)i;
    plan->conditions[plan->condition_count] = made;
    return (int32_t)plan->condition_count++;
}

// The two options of one cell with the cell's parameters.
static void cell_options(const struct protocol *protocol, const struct protocol_block *block, uint32_t cell,
                         struct protocol_option out[2])
{
    for (uint32_t i = 0; i < block->option_count; i++)
        out[i] = protocol->options[block->options[i]];
    if (block->trials) {
        out[0] = block->trials[cell].a;
        out[1] = block->trials[cell].b;
    }
    for (uint32_t f = 0; f < block->factor_count; f++) {
        const struct protocol_factor *factor = &block->factors[f];
        out[factor->option == block->options[0] ? 0 : 1].values[factor->parameter] =
            factor->levels[cell_level(block, cell, f)];
    }
}

static bool factors_json(const struct protocol *protocol, const struct protocol_block *block, uint32_t index,
                         const struct draw *draw, struct plan_trial *trial)
{
    struct text text = {0};
    text_add(&text, "{");
    if (block->kind == PROTOCOL_RATE) {
        bool first = false;
        for (uint32_t i = 0; i < protocol->block_count; i++)
            first = first || protocol->blocks[i].complement_of == (int32_t)index;
        text_add(&text, "\"option\":");
        text_json_string(&text, protocol->options[block->options[draw->option]].name);
        if (first || block->complement_of >= 0)
            text_add(&text, ",\"order\":\"%s\"", first ? "first" : "second");
    } else if (block->trials) {
        text_add(&text, "\"trial\":");
        if (block->trials[trial->cell].name[0])
            text_json_string(&text, block->trials[trial->cell].name);
        else
            text_add(&text, "%u", trial->cell + 1);
    }
    for (uint32_t f = 0; f < block->factor_count; f++) {
        const struct protocol_factor *factor = &block->factors[f];
        const struct catalogue_parameter *parameter =
            &protocol->catalogue->modes[protocol->options[factor->option].mode].parameters[factor->parameter];
        double level = factor->levels[cell_level(block, trial->cell, f)];
        text_add(&text, f ? "," : "");
        text_json_string(&text, factor->name);
        text_add(&text, ":");
        if (parameter->choices)
            text_json_string(&text, parameter->choices[(size_t)level]);
        else
            text_number(&text, level);
    }
    text_add(&text, "}");
    return text_copy(&text, trial->factors, sizeof trial->factors);
}

static bool make_trial(struct maker *maker, uint32_t index, uint32_t place, struct plan_trial *trial)
{
    struct plan *plan = maker->plan;
    const struct protocol *protocol = plan->protocol;
    const struct protocol_block *block = &protocol->blocks[index];
    const struct draw *draw = &maker->draws[index];
    uint32_t which = draw->order[place];
    *trial = (struct plan_trial){.ordinal = ++plan->trial_count, .block = index, .kind = block->kind};
    trial->cell = which / block->repetitions;
    trial->repetition = which % block->repetitions;
    trial->scene = protocol->scenes[draw->scene[which]];
    trial->resolved = block->trials ? &block->trials[trial->cell].settings : &block->settings;
    trial->question = &protocol->questions[trial->resolved->question];
    trial->fixation = protocol_fixation_name(trial->resolved->fixation);
    struct random_stream seeds = random_stream(maker->key, PURPOSE_SEED, plan->number, trial->ordinal);
    trial->seed = random_u64(&seeds) >> 1;

    struct protocol_option options[2];
    cell_options(protocol, block, trial->cell, options);
    if (block->kind == PROTOCOL_RATE) {
        trial->option[0] = condition_index(plan, &options[draw->option]);
        trial->option[1] = -1;
        trial->test_slot = draw->option == 0 ? PLAN_SLOT_A : PLAN_SLOT_NONE;
        trial->first_shown = PLAN_SLOT_A;
    } else {
        uint32_t side = draw->pair[which] & 1, reference_first = draw->pair[which] >> 1;
        trial->test_slot = (enum plan_slot)side;
        trial->first_shown = (enum plan_slot)(side ^ reference_first);
        trial->option[side] = condition_index(plan, &options[0]);
        trial->option[1 - side] = condition_index(plan, &options[1]);
    }
    return trial->option[0] >= 0 && (block->kind == PROTOCOL_RATE || trial->option[1] >= 0) &&
           factors_json(protocol, block, index, draw, trial) &&
           protocol_settings_json(protocol, trial->resolved, trial->settings, sizeof trial->settings);
}

// Conditions in the protocol's order, so that every participant of a study has the same list.
static bool list_conditions(struct plan *plan)
{
    const struct protocol *protocol = plan->protocol;
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        const struct protocol_block *block = &protocol->blocks[b];
        for (uint32_t cell = 0; cell < protocol_block_trials(block) / block->repetitions; cell++) {
            struct protocol_option options[2];
            cell_options(protocol, block, cell, options);
            for (uint32_t i = 0; i < block->option_count; i++)
                if (condition_index(plan, &options[i]) < 0)
                    return false;
        }
    }
    return true;
}

static bool fill(struct maker *maker)
{
    struct plan *plan = maker->plan;
    const struct protocol *protocol = plan->protocol;
    uint32_t total = 0;
    for (uint32_t b = 0; b < protocol->block_count; b++) {
        struct draw *draw = &maker->draws[b];
        if (protocol->blocks[b].kind == PROTOCOL_RATE)
            draw_rating(maker, b, draw);
        else
            draw_toggle(maker, b, draw);
        total += draw->count;
        plan->imbalance = draw->excess > plan->imbalance ? draw->excess : plan->imbalance;
    }
    plan->trials = calloc(total, sizeof *plan->trials);
    plan->conditions = calloc(2 * (size_t)total + PROTOCOL_BLOCKS, sizeof *plan->conditions);
    if (!plan->trials || !plan->conditions || !list_conditions(plan))
        return false;
    for (uint32_t b = 0; b < protocol->block_count; b++)
        for (uint32_t place = 0; place < maker->draws[b].count; place++)
            if (!make_trial(maker, b, place, &plan->trials[plan->trial_count]))
                return false;
    return true;
}

struct plan *plan_create(const struct protocol *protocol, uint64_t seed, uint32_t number)
{
    struct plan *plan = calloc(1, sizeof *plan);
    struct maker maker = {plan, plan_key(protocol, seed), calloc(protocol->block_count, sizeof *maker.draws)};
    bool ok = plan && maker.draws;
    if (ok) {
        *plan = (struct plan){.protocol = protocol, .seed = seed, .number = number};
        ok = fill(&maker);
    }
    free(maker.draws);
    if (ok)
        return plan;
    plan_destroy(plan);
    return NULL;
}

void plan_destroy(struct plan *plan)
{
    if (!plan)
        return;
    free(plan->conditions);
    free(plan->trials);
    free(plan);
}
