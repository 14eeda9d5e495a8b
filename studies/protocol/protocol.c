#include "studies/protocol/protocol.h"

#include "studies/protocol/parts.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The protocol is the first member, so that a pointer to one leads to its memory.
struct owned_protocol {
    struct protocol protocol;
    struct arena arena;
};

static bool head_read(struct reader *reader, const struct yaml_node *root)
{
    const struct language_section *section = &language_protocol;
    struct protocol *protocol = reader->protocol;
    int64_t version, seed;
    uint32_t several = 0;
    if (!read_section(reader, root, section, NULL) ||
        !read_integer(reader, yaml_get(root, "fovstudy"), "fovstudy (the version of the protocol language)", 1,
                      1, &version) ||
        !key_name(reader, root, section, "name", protocol->name) ||
        !read_integer(reader, yaml_get(root, "seed"), "seed", 0, INT64_MAX, &seed) ||
        !key_integer(reader, root, section, "participants", &protocol->participants) ||
        !key_word(reader, root, section, "sessions", &several) ||
        !key_text(reader, root, "title", "", &protocol->title) ||
        !key_text(reader, root, "instructions", "", &protocol->instructions))
        return false;
    protocol->seed = (uint64_t)seed;
    protocol->several_sessions = several == 1;
    return true;
}

static bool all_read(struct reader *reader, const struct yaml_node *root)
{
    struct protocol_settings settings;
    settings_defaults(reader->catalogue, &settings);
    bool ok = head_read(reader, root) && scenes_read(reader, root) && options_read(reader, root) &&
              questions_read(reader, root) && consent_read(reader, root) && participant_read(reader, root) &&
              analysis_read(reader, root) && exclude_read(reader, root) &&
              settings_read(reader, yaml_get(root, "settings"), &settings) &&
              blocks_read(reader, root, &settings);
    if (ok)
        agreement_remark(reader, root);
    return ok;
}

struct protocol *protocol_parse(const char *name, const char *text, size_t size,
                                const struct catalogue *catalogue, char *error, size_t error_size)
{
    struct owned_protocol *owned = calloc(1, sizeof *owned);
    if (!owned) {
        snprintf(error, error_size, "%s: out of memory", name);
        return NULL;
    }
    struct protocol *protocol = &owned->protocol;
    protocol->catalogue = catalogue;
    struct arena tree = {0};
    struct yaml_error problem = {0};
    struct reader reader = {name, catalogue, protocol, &owned->arena, error, error_size};
    const struct yaml_node *root = yaml_parse(text, size, &tree, &problem);
    bool ok = false;
    if (!root)
        snprintf(error, error_size, "%s:%u:%u: %s", name, problem.line, problem.column, problem.sentence);
    else
        ok = all_read(&reader, root);
    arena_free(&tree);
    if (ok && !(protocol->text = arena_text(&owned->arena, text, size))) {
        snprintf(error, error_size, "%s: out of memory", name);
        ok = false;
    }
    if (!ok) {
        protocol_destroy(protocol);
        return NULL;
    }
    protocol->text_size = size;
    sha256(text, size, protocol->sha256);
    sha256_hex(protocol->sha256, protocol->sha256_hex);
    return protocol;
}

struct protocol *protocol_load(const char *path, const struct catalogue *catalogue, char *error,
                               size_t error_size)
{
    FILE *file = fopen(path, "rb");
    char *text = file ? malloc(PROTOCOL_BYTES + 1) : NULL;
    if (!text) {
        snprintf(error, error_size, "%s: cannot be opened: %s; give the path of a protocol file", path,
                 strerror(errno));
        if (file)
            fclose(file);
        return NULL;
    }
    errno = 0;
    size_t size = fread(text, 1, PROTOCOL_BYTES + 1, file); // one byte more than allowed shows a file too large
    bool failed = ferror(file) != 0;
    int reason = errno;
    fclose(file);
    struct protocol *protocol = NULL;
    if (failed)
        snprintf(error, error_size, "%s: cannot be read: %s; give the path of a protocol file", path,
                 strerror(reason));
    else
        protocol = protocol_parse(path, text, size, catalogue, error, error_size);
    free(text);
    return protocol;
}

void protocol_destroy(struct protocol *protocol)
{
    if (!protocol)
        return;
    struct owned_protocol *owned = (struct owned_protocol *)(void *)protocol;
    arena_free(&owned->arena);
    free(owned);
}
