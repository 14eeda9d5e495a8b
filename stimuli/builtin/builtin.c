#include "stimuli/builtin/builtin.h"

#include "stimuli/builtin/atrium.h"
#include "stimuli/builtin/town.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARAMETERS = 8 }; // at most, per scene

static const struct builtin_parameter no_parameters[] = {{.name = NULL}};

static const struct builtin_parameter town_parameters[] = {
    {"triangles", "triangles", TOWN_TRIANGLES_MIN, TOWN_TRIANGLES_MAX, 3000000,
     "drawn without culling, within 10 %"},
    {"seed", "", 0, 4294967295.0, 1, "another town of the same kind"},
    {"moving", "%", 0, 100, 0,
     "of all that stands still, treated as moving, to measure what that costs; casts no shadow"},
    {.name = NULL},
};

const struct builtin_scene builtin_scenes[] = {
    {"atrium", "a sunlit two-storey court with columns, arches, vaults and cloth", no_parameters, atrium_make,
     atrium_path},
    {"town", "a block-built town with trees, lanterns and moving objects", town_parameters, town_make,
     town_path},
    {.name = NULL},
};

static const struct builtin_scene *find(const char *spec)
{
    size_t length = strcspn(spec, ":");
    for (const struct builtin_scene *s = builtin_scenes; s->name != NULL; s++)
        if (strlen(s->name) == length && memcmp(s->name, spec, length) == 0)
            return s;
    return NULL;
}

bool builtin_scene_known(const char *name)
{
    return find(name) != NULL;
}

static void name_scenes(const char *spec, char *error, size_t error_size)
{
    char names[256] = "";
    for (const struct builtin_scene *s = builtin_scenes; s->name != NULL; s++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used > 0 ? ", " : "", s->name);
    }
    snprintf(error, error_size, "scene '%.*s' is not known; use one of %s, or a .gltf or .glb file",
             (int)strcspn(spec, ":"), spec, names);
}

static void name_parameters(const struct builtin_scene *scene, int length, const char *item, char *error,
                            size_t error_size)
{
    char names[256] = "";
    for (const struct builtin_parameter *p = scene->parameters; p->name != NULL; p++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used > 0 ? ", " : "", p->name);
    }
    if (names[0] == '\0')
        snprintf(error, error_size, "scene '%s' takes no parameters, remove '%.*s'", scene->name, length, item);
    else
        snprintf(error, error_size, "scene '%s' does not know '%.*s'; write name=value, with one of %s",
                 scene->name, length, item, names);
}

// One "name=value" of `length` characters.
static bool read_item(const struct builtin_scene *scene, const char *item, int length, double *values,
                      char *error, size_t error_size)
{
    const char *equals = memchr(item, '=', (size_t)length);
    const struct builtin_parameter *p = scene->parameters;
    if (equals != NULL)
        while (p->name != NULL && (strlen(p->name) != (size_t)(equals - item) ||
                                   memcmp(p->name, item, (size_t)(equals - item)) != 0))
            p++;
    if (equals == NULL || p->name == NULL) {
        name_parameters(scene, length, item, error, error_size);
        return false;
    }
    char text[32] = "";
    int digits = length - (int)(equals + 1 - item);
    snprintf(text, sizeof text, "%.*s", digits, equals + 1);
    // Whole decimal numbers only: strtod alone would also take "0x10", "nan" and " 5".
    bool whole = digits > 0 && digits < (int)sizeof text && strspn(text, "0123456789") == (size_t)digits;
    double value = whole ? strtod(text, NULL) : NAN;
    if (!(value >= p->min && value <= p->max)) {
        snprintf(error, error_size, "scene '%s': %s=%.*s is not a whole number from %.0f to %.0f", scene->name,
                 p->name, digits, equals + 1, p->min, p->max);
        return false;
    }
    values[p - scene->parameters] = value;
    return true;
}

// The scene that a specification names, with its parameters; NULL after a sentence.
static const struct builtin_scene *read_spec(const char *spec, double values[PARAMETERS], char *error,
                                             size_t error_size)
{
    const struct builtin_scene *scene = find(spec);
    if (scene == NULL) {
        name_scenes(spec, error, error_size);
        return NULL;
    }
    for (int i = 0; scene->parameters[i].name != NULL; i++)
        values[i] = scene->parameters[i].value;
    const char *item = spec + strlen(scene->name);
    while (*item != '\0') {
        item++; // the colon, then each comma
        size_t length = strcspn(item, ",");
        if (!read_item(scene, item, (int)(length < 4096 ? length : 4096), values, error, error_size))
            return NULL;
        item += length;
    }
    return scene;
}

bool builtin_scene_check(const char *spec, struct camera_path *out_path, char *error, size_t error_size)
{
    double values[PARAMETERS] = {0};
    const struct builtin_scene *scene = read_spec(spec, values, error, error_size);
    return scene != NULL && scene->path(out_path);
}

struct scene *builtin_scene_open(const char *spec, char *error, size_t error_size)
{
    double values[PARAMETERS] = {0};
    const struct builtin_scene *scene = read_spec(spec, values, error, error_size);
    if (scene == NULL)
        return NULL;
    struct scene *made = scene->make(values);
    if (made == NULL)
        snprintf(error, error_size, "scene '%s' does not fit into memory; ask for fewer triangles", spec);
    return made;
}
