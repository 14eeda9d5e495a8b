#include "tests/studies/engine/random_protocol.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { CELLS = 12, GROUPS = 6 }; // at most, of a block and of people: plans stay small

struct maker {
    uint64_t state;
    char *out;
    size_t size, used;
    uint32_t scenes;  // of the protocol
    uint32_t groups;  // of people, so far
    uint32_t factors; // so far, for their names
    bool shared;      // the groups that several blocks may have
};

// Knuth's MMIX generator, not the one under test. n > 0.
static uint32_t below(struct maker *maker, uint32_t n)
{
    maker->state = maker->state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(maker->state >> 33) % n;
}

static bool one_in(struct maker *maker, uint32_t n)
{
    return below(maker, n) == 0;
}

static void add(struct maker *maker, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(struct maker *maker, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    int length = vsnprintf(maker->out + maker->used, maker->size - maker->used, format, args);
    va_end(args);
    size_t left = maker->size - maker->used;
    maker->used += length >= 0 && (size_t)length < left ? (size_t)length : left - 1;
}

static const char *const scene_names[] = {"atrium", "town", "yard", "mill", "cave"};
static const char *const option_names[] = {"f", "g", "h"};

// Members that change what is shown; of pairs also both options.
static void add_change(struct maker *maker, bool pair, bool scenes)
{
    add(maker, "settings: {camera: %s}", one_in(maker, 2) ? "still" : "path");
    if (scenes && one_in(maker, 3))
        add(maker, ", scene: %s", scene_names[below(maker, maker->scenes)]);
    if (one_in(maker, 4))
        add(maker, ", option: %s", option_names[below(maker, 3)]);
    else if (pair && one_in(maker, 4))
        add(maker, ", options: [%s, r]", option_names[below(maker, 3)]);
    if (one_in(maker, 3))
        add(maker, ", parameters: {tested: {splat: points}}");
}

// What a block has used already: two factors must not vary the same.
struct used {
    bool parameter[3], options, scenes, setting, group;
};

static void add_levels(struct maker *maker, uint32_t levels, const char *const *words)
{
    for (uint32_t i = 0; i < levels; i++) {
        add(maker, "%s", i ? ", " : "");
        if (words)
            add(maker, "%s", words[i]);
        else
            add(maker, "0.%02u", 7 + 6 * i);
    }
}

// Whether people are divided by this factor; "" or the member that says so.
static const char *between(struct maker *maker, uint32_t levels)
{
    if (levels < 2 || maker->groups * levels > GROUPS || !one_in(maker, 6))
        return "";
    maker->groups *= levels;
    return ", between: yes";
}

// One factor of at most `most` levels; returns how many it has, 0: none was added.
static uint32_t add_factor(struct maker *maker, bool pair, uint32_t most, struct used *used)
{
    static const char *const parameters[3] = {"epsilon", "hole_decay", "fovea_deg"};
    static const char *const off_on[] = {"off", "on"};
    uint32_t levels = 1 + below(maker, most < 4 ? most : 4), which = below(maker, 7);
    uint32_t name = maker->factors++, parameter = below(maker, 3);
    switch (which) {
    case 0:
    case 1:
        if (used->parameter[parameter])
            return 0;
        used->parameter[parameter] = true;
        if (which == 0)
            add(maker, "      %s: [", parameters[parameter]);
        else
            add(maker, "      x%u: {parameter: %s%s, levels: [", name, parameters[parameter],
                between(maker, levels));
        add_levels(maker, levels, NULL);
        add(maker, which == 0 ? "]\n" : "]}\n");
        return levels;
    case 2:
        levels = levels > 3 ? 3 : levels;
        if (used->options)
            return 0;
        used->options = true;
        add(maker, "      x%u: {options: [", name);
        add_levels(maker, levels, option_names);
        add(maker, "]%s}\n", between(maker, levels));
        return levels;
    case 3:
        levels = levels > maker->scenes ? maker->scenes : levels;
        if (used->scenes)
            return 0;
        used->scenes = true;
        add(maker, "      x%u: {scenes: [", name);
        add_levels(maker, levels, scene_names);
        add(maker, "]%s}\n", between(maker, levels));
        return levels;
    case 4:
        levels = levels > 2 ? 2 : levels;
        if (used->setting)
            return 0;
        used->setting = true;
        add(maker, "      x%u: {setting: moving_objects, levels: [", name);
        add_levels(maker, levels, off_on);
        add(maker, "]%s}\n", between(maker, levels));
        return levels;
    case 5: // people's groups that several blocks may share
        if (used->group || most < 2 || (!maker->shared && maker->groups * 2 > GROUPS))
            return 0;
        maker->groups *= maker->shared ? 1 : 2;
        used->group = maker->shared = true;
        add(maker, "      group: {between: yes, levels: {a: {}, b: {settings: {camera: still}}}}\n");
        return 2;
    default: {
        bool scenes = !used->scenes;
        used->scenes = used->options = true;
        add(maker, "      x%u: {%slevels: {", name, *between(maker, levels) ? "between: yes, " : "");
        for (uint32_t i = 0; i < levels; i++) {
            add(maker, "%sl%u: {", i ? ", " : "", i);
            add_change(maker, pair, scenes);
            add(maker, "}");
        }
        add(maker, "}}\n");
        return levels;
    }
    }
}

// roles: null and catch trials may be listed.
static void add_design(struct maker *maker, bool pair, bool roles)
{
    uint32_t cells = 1, factors = below(maker, 4);
    if (one_in(maker, 4)) {
        static const char *const role[] = {"main", "main", "main", "main", "main", "practice", "catch", "null"};
        cells = 1 + below(maker, 10);
        add(maker, "    trials:\n");
        for (uint32_t i = 0; i < cells; i++) {
            add(maker, "      - {name: t%u, role: %s, ", i, role[below(maker, roles ? 8 : 6)]);
            add_change(maker, pair, true);
            add(maker, "}\n");
        }
    } else if (factors > 0) {
        struct used used = {0};
        size_t before = maker->used;
        bool any = false;
        add(maker, "    factors:\n");
        for (uint32_t i = 0; i < factors; i++) {
            uint32_t levels = add_factor(maker, pair, CELLS / cells, &used);
            cells *= levels ? levels : 1;
            any = any || levels;
        }
        if (!any)
            maker->used = before;
    }
}

static void add_order(struct maker *maker)
{
    static const char *const orders[] = {"random", "fixed", "block_random", "latin"};
    add(maker, "    repetitions: %u\n    order: %s\n", 1 + (one_in(maker, 2) ? below(maker, 3) : 0),
        orders[below(maker, 4)]);
    if (one_in(maker, 6))
        add(maker, "    break_every: %u\n", 1 + below(maker, 6));
}

static void add_scenes(struct maker *maker)
{
    if (one_in(maker, 3)) {
        uint32_t first = below(maker, maker->scenes), count = 1 + below(maker, maker->scenes);
        add(maker, "    scenes: [");
        for (uint32_t i = 0; i < count; i++)
            add(maker, "%s%s", i ? ", " : "", scene_names[(first + i) % maker->scenes]);
        add(maker, "]\n");
    }
    if (one_in(maker, 2))
        add(maker, "    scene_use: %s\n", one_in(maker, 2) ? "random" : "alternate");
}

// kind: as the language has it; "drawn" is a rating of one of two options.
static void add_block(struct maker *maker, uint32_t index)
{
    static const struct {
        const char *kind, *options, *settings;
        bool pair, extras;
    } kinds[] = {{"toggle", "f, r", "question: q", true, true},
                 {"toggle", "f, r", "question: q", true, true},
                 {"toggle", "f, r", "question: q", true, true},
                 {"sequential", "f, r", "question: q, view_s: 1", true, true},
                 {"rate", "f", "question: z", false, false},
                 {"task", "f", "question: z, spheres: [1, 4], count: n", false, false},
                 {"adjust", "f, r", "view_s: 0", true, false},
                 {"staircase", "f, r", "question: c", true, false},
                 {"rate", "f, r", "question: z", false, false}};
    enum { ADJUST = 6, STAIRCASE = 7, DRAWN = 8 };
    uint32_t which = below(maker, 9);
    add(maker, "  - name: b%u\n    kind: %s\n    options: [%s]\n    settings: {%s}\n", index, kinds[which].kind,
        kinds[which].options, kinds[which].settings);
    add_scenes(maker);
    if (which == DRAWN) {
        if (one_in(maker, 2))
            add(maker,
                "  - {name: c%u, kind: rate, options: [f, r], complement_of: b%u, settings: {question: z}}\n",
                index, index);
        return;
    }
    add_design(maker, kinds[which].pair, kinds[which].extras);
    if (which == STAIRCASE) {
        add(maker,
            "    staircase: {parameter: periphery_deg, method: 1up2down, larger: easier, level: {min: 1, max: "
            "90}, start: 30, steps: [4, 2], trials: %u}\n",
            1 + below(maker, 6));
        return;
    }
    add_order(maker);
    if (which == ADJUST)
        add(maker, "    adjust: {periphery_deg: {start: [20, 40], step: 0.5}}\n");
    if (kinds[which].extras && one_in(maker, 3))
        add(maker, "    null: %u\n", 1 + below(maker, 4));
    if (kinds[which].extras && one_in(maker, 3))
        add(maker, "    catch: {count: %u, option: blurred}\n", 1 + below(maker, 4));
}

void random_protocol(uint32_t seed, char *out, size_t size)
{
    struct maker maker = {.state = seed * UINT64_C(2654435761) + 1, .out = out, .size = size, .groups = 1};
    below(&maker, 2);
    maker.scenes = 1 + below(&maker, 5);
    add(&maker, "fovstudy: 1\nname: p%u\ntitle: t\nseed: %u\nscenes: [", seed, seed);
    for (uint32_t i = 0; i < maker.scenes; i++)
        add(&maker, i < 3 ? "%s%s" : "%s{name: %s, stand_in: town}", i ? ", " : "", scene_names[i]);
    add(&maker, "]\noptions:\n  f: {mode: time_warped}\n  g: {mode: time_warped, splat: points}\n"
                "  h: {mode: time_warped, dynamic_objects: regular}\n  r: {mode: regular}\n"
                "  blurred: {mode: time_warped, epsilon: 1}\nreference: r\n"
                "questions: {q: {text: Which?}, c: {text: Which?, correct: reference}, z: {text: How?, scale: "
                "[1, 9]}, n: {text: How many?, count: [0, 9]}}\n"
                "instructions: i\nconsent: {version: 1, text: c}\nblocks:\n");
    uint32_t blocks = 1 + (one_in(&maker, 2) ? below(&maker, 3) : 0);
    for (uint32_t i = 0; i < blocks; i++)
        add_block(&maker, i);
}
