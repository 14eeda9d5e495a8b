// How each thing is drawn. Every stream is Philox keyed by SHA-256(tag, protocol hash, seed) and named
// (purpose, subject, part), so no draw moves another.
//
//   groups  participants are taken in runs as long as there are groups; a run shares one permutation of them.
//           Within its group a participant has a rank, which takes the number's place below.
//   scenes  ALTERNATE: one draw per study and block gives each trial of the block (cell x repetition) a first
//           scene, each scene as often as any other within one, in the whole and, where that can be, in every
//           factor level; the participant of rank n has the scene n places further in the list. Each cell's
//           scene so alternates over participants. RANDOM: participants are taken in runs as long as the list
//           of scenes (times the options for a drawn rating); a run shares one random permutation of all
//           combinations, and each participant takes one. A cell that names its scene has that one, and is left
//           out of this.
//   sides   one draw per four ranks 4j..4j+3 (subject j) gives each trial its side and first-shown option,
//           balanced as balance.h says over block, factor levels, scenes and cells. The four take the
//           reflections (side, first) ^ (0,0), (0,1), (1,1), (1,0): in this order each scene of a cell, which
//           alternates, meets both sides and both first-shown options.
//   order   RANDOM one permutation per participant and block, BLOCK_RANDOM one per repetition; LATIN a Williams
//           design whose treatments are named at random for each group of rows and repetition. Null and catch
//           trials are inserted at random, never first; one that is listed and would be first changes places,
//           except in FIXED and LATIN.
//   rating  which of two options is rated first: with the scene, above. A complement takes the same scene and
//           the other.
#include "studies/engine/draw.h"

#include "studies/engine/balance.h"

#include <string.h>

enum purpose {
    PURPOSE_SCENES = 1,
    PURPOSE_SIDES,
    PURPOSE_ORDER,
    PURPOSE_RUN,
    PURPOSE_SEED,
    PURPOSE_GROUP,
    PURPOSE_LATIN,
    PURPOSE_EXTRA,
    PURPOSE_TARGET,
    PURPOSE_TRIAL
};

static const uint32_t reflections[4] = {0, 2, 3, 1};

uint64_t draw_key(const struct protocol *protocol, uint64_t seed)
{
    static const char tag[16] = "fovstudy plan 3"; // a change of any rule above changes the tag
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

// One of `length` combinations, each once in every run of `length`.
static uint32_t draw_run(uint64_t key, enum purpose purpose, uint32_t part, uint32_t place, uint32_t length)
{
    uint32_t combination[PROTOCOL_GROUPS];
    struct random_stream stream = random_stream(key, purpose, place / length, part);
    for (uint32_t i = 0; i < length; i++)
        combination[i] = i;
    random_shuffle(&stream, combination, length);
    return combination[place % length];
}

_Static_assert((int)PROTOCOL_GROUPS >= 2 * (int)PROTOCOL_SCENES, "a run of scenes and options fits");

struct draw_person draw_person(const struct protocol *protocol, uint64_t seed, uint32_t number)
{
    uint32_t groups = protocol_groups(protocol);
    struct draw_person person = {.key = draw_key(protocol, seed), .number = number, .rank = number / groups};
    person.group = groups > 1 ? draw_run(person.key, PURPOSE_GROUP, 0, number, groups) : 0;
    return person;
}

uint64_t draw_trial_seed(const struct draw_person *person, uint32_t ordinal)
{
    struct random_stream stream = random_stream(person->key, PURPOSE_SEED, person->number, ordinal);
    return random_u64(&stream) >> 1;
}

uint32_t draw_target_seed(const struct draw_person *person, uint32_t block, uint32_t cell)
{
    struct random_stream stream =
        random_stream(person->key, PURPOSE_TARGET, person->number, block << 16 | cell);
    return random_u32(&stream) >> 1;
}

struct random_stream draw_trial_stream(const struct draw_person *person, uint32_t ordinal)
{
    return random_stream(person->key, PURPOSE_TRIAL, person->number, ordinal);
}

// The cells of this participant's group, in their order.
static uint32_t list_cells(const struct protocol *protocol, const struct draw_person *person,
                           const struct protocol_block *block, uint32_t *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < block->cell_count; i++) {
        bool mine = true;
        for (uint32_t f = 0; f < block->factor_count; f++)
            mine = mine && (!block->factors[f].between ||
                            protocol_group_level(protocol, person->group, block->factors[f].name) ==
                                block->cells[i].level[f]);
        if (mine)
            out[count++] = i;
    }
    return count;
}

// Groups of the block, its factor levels and, where cells repeat, its cells; of the trials listed in `trials`
// only. `levels`: the weight of a factor's levels.
static void design_block(const struct protocol_block *block, const struct draw *draw, const uint32_t *trials,
                         uint32_t count, uint32_t levels, struct balance_design *design)
{
    uint32_t key[DRAW_TRIALS] = {0};
    *design = (struct balance_design){.trials = count};
    uint32_t cells = draw->count / block->repetitions;
    balance_group(design, key, 1, BALANCE_MUST);
    for (uint32_t f = 0; f < block->factor_count; f++) {
        if (block->factors[f].between)
            continue;
        for (uint32_t i = 0; i < count; i++)
            key[i] = design->digit[i][design->digits] =
                block->cells[draw->cell[trials[i] / block->repetitions]].level[f];
        design->levels[design->digits++] = block->factors[f].level_count;
        balance_group(design, key, block->factors[f].level_count, levels);
    }
    if (design->digits == 0) { // listed trials
        for (uint32_t i = 0; i < count; i++)
            design->digit[i][0] = (uint16_t)(trials[i] / block->repetitions);
        design->levels[design->digits++] = cells;
    }
    for (uint32_t i = 0; i < count; i++) {
        design->digit[i][design->digits] = (uint16_t)(trials[i] % block->repetitions);
        key[i] = trials[i] / block->repetitions;
    }
    design->levels[design->digits++] = block->repetitions;
    if (block->repetitions > 1)
        balance_group(design, key, cells, BALANCE_SHOULD);
}

static void draw_rating(const struct protocol *protocol, const struct draw_person *person, uint32_t index,
                        struct draw *draws)
{
    const struct protocol_block *block = &protocol->blocks[index];
    struct draw *draw = &draws[index];
    if (block->complement_of >= 0) {
        const struct draw *earlier = &draws[block->complement_of];
        draw->scene[0] = earlier->scene[0];
        draw->option = 1 - earlier->option;
        return;
    }
    uint32_t taken =
        draw_run(person->key, PURPOSE_RUN, index, person->rank, block->scene_count * block->option_count);
    draw->option = taken / block->scene_count;
    uint32_t scene = taken % block->scene_count;
    if (block->scene_use ==
        PROTOCOL_ALTERNATE) { // scenes in turn; the options still come as drawn within a run
        struct random_stream stream = random_stream(person->key, PURPOSE_SCENES, 0, index);
        scene = (random_below(&stream, block->scene_count) + person->rank) % block->scene_count;
    }
    draw->scene[0] = block->scenes[scene];
}

// out_class: of each trial, the place in the list of the scene that rank 0 has; of cells that name their scene,
// that one's place in the protocol.
static void draw_scenes(const struct protocol_block *block, const struct draw_person *person, uint32_t index,
                        struct draw *draw, uint32_t *out_class)
{
    uint32_t open[DRAW_TRIALS], classes[DRAW_TRIALS] = {0}, count = 0;
    for (uint32_t i = 0; i < draw->count; i++)
        if (block->cells[draw->cell[i / block->repetitions]].scene < 0)
            open[count++] = i;
    draw->turn = person->rank % block->scene_count;
    if (block->scene_use == PROTOCOL_RANDOM) {
        draw->turn = draw_run(person->key, PURPOSE_RUN, index, person->rank, block->scene_count);
    } else if (count > 0) {
        struct balance_design design;
        struct random_stream stream = random_stream(person->key, PURPOSE_SCENES, 0, index);
        design_block(block, draw, open, count, BALANCE_SHOULD, &design);
        draw->excess += balance_classes(&design, &stream, block->scene_count, classes);
    }
    for (uint32_t i = 0, k = 0; i < draw->count; i++) {
        int32_t named = block->cells[draw->cell[i / block->repetitions]].scene;
        out_class[i] = named >= 0 ? (uint32_t)named : classes[k++];
        draw->scene[i] =
            named >= 0 ? out_class[i] : block->scenes[(out_class[i] + draw->turn) % block->scene_count];
    }
}

static void draw_sides(const struct protocol_block *block, const struct draw_person *person, uint32_t index,
                       const uint32_t *scene_class, struct draw *draw)
{
    struct balance_design design;
    uint32_t all[DRAW_TRIALS];
    for (uint32_t i = 0; i < draw->count; i++)
        all[i] = i;
    design_block(block, draw, all, draw->count, BALANCE_MUST, &design);
    // Sides and scenes must not go together either. The groups are those of rank 0, the same for all four.
    if (block->scene_count > 1 && block->scene_use == PROTOCOL_ALTERNATE)
        balance_group(&design, scene_class, PROTOCOL_SCENES, BALANCE_MAY);
    struct random_stream sides = random_stream(person->key, PURPOSE_SIDES, person->rank / 4, index);
    draw->excess += balance_pairs(&design, &sides, draw->pair);
    for (uint32_t i = 0; i < draw->count; i++)
        draw->pair[i] ^= reflections[person->rank % 4];
}

uint32_t draw_williams_rows(uint32_t count)
{
    return count % 2 ? 2 * count : count;
}

// Williams 1949, "Experimental designs balanced for the estimation of residual effects of treatments": the
// first row is 0, 1, n-1, 2, n-2, ...; the others add 1, 2, ... modulo n; for odd n each also comes in reverse.
void draw_williams(uint32_t count, uint32_t row, uint32_t *out)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t first = i == 0 ? 0 : i % 2 ? (i + 1) / 2 : count - i / 2;
        uint32_t place = row < count ? i : count - 1 - i;
        out[place] = (first + row) % count;
    }
}

static bool is_check(const struct protocol_block *block, const struct draw *draw, uint32_t trial)
{
    enum protocol_role role = block->cells[draw->cell[trial / block->repetitions]].role;
    return role == PROTOCOL_NULL || role == PROTOCOL_CATCH;
}

// Of the first `count` trials in the order, one drawn among those that are no listed null or catch trials
// changes places with the first, where that is one.
static void begin_with_main(const struct protocol_block *block, struct random_stream *stream, struct draw *draw,
                            uint32_t count)
{
    uint32_t place[DRAW_TRIALS], found = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!is_check(block, draw, draw->order[i]))
            place[found++] = i;
    if (found == 0 || place[0] == 0)
        return;
    uint32_t other = place[random_below(stream, found)], first = draw->order[0];
    draw->order[0] = draw->order[other];
    draw->order[other] = first;
}

static void draw_order(const struct protocol_block *block, const struct draw_person *person, uint32_t index,
                       struct draw *draw)
{
    uint32_t cells = draw->count / block->repetitions, rows = draw_williams_rows(cells);
    struct random_stream stream = random_stream(person->key, PURPOSE_ORDER, person->number, index);
    for (uint32_t repetition = 0; repetition < block->repetitions; repetition++) {
        uint32_t order[DRAW_TRIALS], name[DRAW_TRIALS];
        for (uint32_t i = 0; i < cells; i++)
            order[i] = name[i] = i;
        if (block->order == PROTOCOL_ORDER_BLOCK_RANDOM) {
            random_shuffle(&stream, order, cells);
        } else if (block->order == PROTOCOL_ORDER_LATIN) {
            struct random_stream names =
                random_stream(person->key, PURPOSE_LATIN, person->rank / rows, index | repetition << 8);
            random_shuffle(&names, name, cells);
            draw_williams(cells, person->rank % rows, order);
        }
        for (uint32_t i = 0; i < cells; i++)
            draw->order[repetition * cells + i] = name[order[i]] * block->repetitions + repetition;
    }
    if (block->order == PROTOCOL_ORDER_RANDOM)
        random_shuffle(&stream, draw->order, draw->count);
    if (block->order == PROTOCOL_ORDER_RANDOM || block->order == PROTOCOL_ORDER_BLOCK_RANDOM)
        begin_with_main(block, &stream, draw, block->order == PROTOCOL_ORDER_RANDOM ? draw->count : cells);
}

// Null and catch trials: of each kind sides and first-shown options within one, scenes as the block's go,
// places at random.
static void draw_extras(const struct protocol_block *block, const struct draw_person *person, uint32_t index,
                        struct draw *draw)
{
    // From either half on, as many as there may be, sides and first-shown options stay within one.
    static const uint32_t pairs[4] = {0, 3, 1, 2};
    struct random_stream shared = random_stream(person->key, PURPOSE_EXTRA, person->rank / 4, index | 1u << 8);
    struct random_stream own = random_stream(person->key, PURPOSE_EXTRA, person->number, index);
    uint32_t scene = random_below(&shared, block->scene_count), steps = block->scene_use == PROTOCOL_ALTERNATE;
    draw->total = draw->count;
    for (uint32_t e = 0; e < 2; e++) {
        const struct protocol_extra *extra = &block->extras[e];
        uint32_t half = 2 * random_below(&shared, 2);
        for (uint32_t k = 0; k < extra->count; k++) {
            uint32_t trial = draw->total++, place = draw->count > 0 ? 1 + random_below(&own, trial) : 0;
            memmove(&draw->order[place + 1], &draw->order[place], (trial - place) * sizeof draw->order[0]);
            draw->order[place] = trial;
            draw->pair[trial] = pairs[(k + half) % 4] ^ reflections[person->rank % 4];
            uint32_t class = steps * (scene + trial - draw->count);
            draw->scene[trial] = extra->cell.scene >= 0
                                     ? (uint32_t)extra->cell.scene
                                     : block->scenes[(class + draw->turn) % block->scene_count];
        }
    }
}

void draw_block(const struct protocol *protocol, const struct draw_person *person, uint32_t index,
                struct draw *draws)
{
    const struct protocol_block *block = &protocol->blocks[index];
    struct draw *draw = &draws[index];
    uint32_t scene_class[DRAW_TRIALS];
    draw->count = draw->total = list_cells(protocol, person, block, draw->cell) * block->repetitions;
    if (block->kind == PROTOCOL_RATE && block->option_count == 2) {
        draw_rating(protocol, person, index, draws);
        return;
    }
    draw_scenes(block, person, index, draw, scene_class);
    if (protocol_kind_is_pair(block->kind))
        draw_sides(block, person, index, scene_class, draw);
    draw_order(block, person, index, draw);
    draw_extras(block, person, index, draw);
}
