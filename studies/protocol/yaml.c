#include "studies/protocol/yaml.h"

#include "studies/protocol/protocol.h"

#include <libfyaml.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct builder {
    struct arena *arena;
    struct yaml_error *error;
    struct yaml_node *root;
    struct yaml_node *open[PROTOCOL_DEPTH];
    struct yaml_node *key[PROTOCOL_DEPTH]; // of a mapping: the name that waits for its value
    uint32_t depth, nodes, documents;
};

static bool fail(struct builder *builder, uint32_t line, uint32_t column, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static bool fail(struct builder *builder, uint32_t line, uint32_t column, const char *format, ...)
{
    builder->error->line = line;
    builder->error->column = column;
    va_list args;
    va_start(args, format);
    vsnprintf(builder->error->sentence, sizeof builder->error->sentence, format, args);
    va_end(args);
    return false;
}

// How many bytes the UTF-8 character at `at` has; 0 where it is none (RFC 3629: no overlong forms, no
// surrogates).
static size_t utf8_length(const uint8_t *at, size_t left)
{
    if (at[0] < 0x80)
        return at[0] == 0 ? 0 : 1;
    size_t length = at[0] >= 0xc2 && at[0] <= 0xdf   ? 2
                    : (at[0] & 0xf0) == 0xe0         ? 3
                    : at[0] >= 0xf0 && at[0] <= 0xf4 ? 4
                                                     : 0;
    if (length == 0 || length > left)
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((at[i] & 0xc0) != 0x80)
            return 0;
    if ((at[0] == 0xe0 && at[1] < 0xa0) || (at[0] == 0xed && at[1] > 0x9f) || (at[0] == 0xf0 && at[1] < 0x90) ||
        (at[0] == 0xf4 && at[1] > 0x8f))
        return 0;
    return length;
}

static bool check_utf8(struct builder *builder, const char *text, size_t size)
{
    uint32_t line = 1, column = 1;
    for (size_t at = 0; at < size;) {
        size_t length = utf8_length((const uint8_t *)text + at, size - at);
        if (length == 0)
            return fail(builder, line, column, "byte 0x%02x is not UTF-8 text; save the file as UTF-8",
                        (unsigned)(uint8_t)text[at]);
        column = text[at] == '\n' ? 1 : column + 1;
        line += text[at] == '\n';
        at += length;
    }
    return true;
}

// Hangs a node under the innermost open mapping or list, or takes it as a mapping's next name.
static bool attach(struct builder *builder, struct yaml_node *node)
{
    if (builder->depth == 0) {
        builder->root = node;
        return true;
    }
    struct yaml_node *parent = builder->open[builder->depth - 1];
    if (parent->kind == YAML_MAP) {
        struct yaml_node *key = builder->key[builder->depth - 1];
        if (!key) {
            if (node->kind != YAML_SCALAR)
                return fail(builder, node->line, node->column,
                            "a name is needed here, not a list or a mapping");
            if (yaml_get(parent, node->text))
                return fail(builder, node->line, node->column, "'%.60s' stands here twice; keep one",
                            node->text);
            builder->key[builder->depth - 1] = node;
            return true;
        }
        node->key = key->text;
        node->key_line = key->line;
        node->key_column = key->column;
        if (node->kind == YAML_SCALAR && !node->quoted &&
            !*node->text) { // nothing there has no place of its own
            node->line = key->line;
            node->column = key->column;
        }
        builder->key[builder->depth - 1] = NULL;
    }
    if (parent->last)
        parent->last->next = node;
    else
        parent->first = node;
    parent->last = node;
    parent->count++;
    return true;
}

static struct yaml_node *new_node(struct builder *builder, struct fy_event *event, enum yaml_kind kind)
{
    const struct fy_mark *mark = fy_event_start_mark(event);
    uint32_t line = mark ? (uint32_t)mark->line + 1 : 1, column = mark ? (uint32_t)mark->column + 1 : 1;
    if (++builder->nodes > YAML_NODES) {
        fail(builder, line, column, "more than %d values; a protocol is never that long", YAML_NODES);
        return NULL;
    }
    struct yaml_node *node = arena_zeroed(builder->arena, sizeof *node);
    if (!node) {
        fail(builder, line, column, "out of memory");
        return NULL;
    }
    *node = (struct yaml_node){.kind = kind, .line = line, .column = column};
    return node;
}

static bool add_scalar(struct builder *builder, struct fy_event *event)
{
    struct yaml_node *node = new_node(builder, event, YAML_SCALAR);
    if (!node)
        return false;
    size_t length = 0;
    const char *text = event->scalar.value ? fy_token_get_text(event->scalar.value, &length) : "";
    node->text = arena_text(builder->arena, text ? text : "", length);
    enum fy_scalar_style style = event->scalar.value ? fy_token_scalar_style(event->scalar.value) : FYSS_PLAIN;
    node->quoted = style != FYSS_PLAIN;
    if ((style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED) && node->column > 1)
        node->column--; // libfyaml's mark stands behind the quote
    if (text && memchr(text, 0, length))
        return fail(builder, node->line, node->column, "a text may not hold the character NUL");
    return node->text ? attach(builder, node) : fail(builder, node->line, node->column, "out of memory");
}

static bool open_node(struct builder *builder, struct fy_event *event, enum yaml_kind kind)
{
    struct yaml_node *node = new_node(builder, event, kind);
    if (!node)
        return false;
    if (builder->depth == PROTOCOL_DEPTH)
        return fail(builder, node->line, node->column, "nested deeper than %d levels; no protocol needs that",
                    PROTOCOL_DEPTH);
    if (!attach(builder, node))
        return false;
    builder->key[builder->depth] = NULL;
    builder->open[builder->depth++] = node;
    return true;
}

// What YAML has and a protocol does not use.
static bool check_plain(struct builder *builder, struct fy_event *event)
{
    const struct fy_mark *mark = fy_event_start_mark(event);
    uint32_t line = mark ? (uint32_t)mark->line + 1 : 1, column = mark ? (uint32_t)mark->column + 1 : 1;
    if (event->type == FYET_ALIAS && column > 1)
        column--; // libfyaml's mark stands behind the sign
    bool anchor = event->type == FYET_ALIAS || (event->type == FYET_SCALAR && event->scalar.anchor) ||
                  (event->type == FYET_MAPPING_START && event->mapping_start.anchor) ||
                  (event->type == FYET_SEQUENCE_START && event->sequence_start.anchor);
    if (anchor)
        return fail(builder, line, column,
                    "anchors (&) and aliases (*) are not used in protocols; write the value out");
    bool tag = (event->type == FYET_SCALAR && event->scalar.tag) ||
               (event->type == FYET_MAPPING_START && event->mapping_start.tag) ||
               (event->type == FYET_SEQUENCE_START && event->sequence_start.tag);
    if (tag)
        return fail(builder, line, column, "tags (!) are not used in protocols; remove it");
    if (event->type == FYET_DOCUMENT_START && ++builder->documents > 1)
        return fail(builder, line, column, "a second document begins here; a protocol is one document");
    return true;
}

static bool take(struct builder *builder, struct fy_event *event)
{
    if (!check_plain(builder, event))
        return false;
    switch (event->type) {
    case FYET_SCALAR:
        return add_scalar(builder, event);
    case FYET_MAPPING_START:
        return open_node(builder, event, YAML_MAP);
    case FYET_SEQUENCE_START:
        return open_node(builder, event, YAML_LIST);
    case FYET_MAPPING_END:
    case FYET_SEQUENCE_END:
        builder->depth--;
        return true;
    default:
        return true;
    }
}

// The parser's own words for a syntax error.
static void syntax_error(struct builder *builder, struct fy_diag *diag)
{
    void *iterator = NULL;
    const struct fy_diag_error *found = fy_diag_errors_iterate(diag, &iterator);
    if (found)
        fail(builder, (uint32_t)(found->line > 0 ? found->line : 1),
             (uint32_t)(found->column > 0 ? found->column : 1), "this is not YAML: %s",
             found->msg ? found->msg : "syntax error");
    else
        fail(builder, 1, 1, "this is not YAML");
}

static bool run(struct builder *builder, struct fy_parser *parser, struct fy_diag *diag)
{
    bool ok = true, ended = false;
    while (ok && !ended) {
        struct fy_event *event = fy_parser_parse(parser);
        if (!event) {
            syntax_error(builder, diag);
            return false;
        }
        ended = event->type == FYET_STREAM_END;
        ok = take(builder, event);
        fy_parser_event_free(parser, event);
    }
    return ok;
}

static void discard(struct fy_diag *diag, void *user, const char *words, size_t length)
{
    (void)diag, (void)user, (void)words, (void)length;
}

struct yaml_node *yaml_parse(const char *text, size_t size, struct arena *arena, struct yaml_error *error)
{
    struct builder builder = {.arena = arena, .error = error};
    if (size > PROTOCOL_BYTES) {
        fail(&builder, 1, 1, "the file is larger than %d bytes; a protocol is never that long", PROTOCOL_BYTES);
        return NULL;
    }
    if (!check_utf8(&builder, text, size))
        return NULL;

    struct fy_diag_cfg diag_setup;
    fy_diag_cfg_default(&diag_setup);
    diag_setup.fp = NULL;
    diag_setup.output_fn = discard;
    struct fy_diag *diag = fy_diag_create(&diag_setup);
    struct fy_parser *parser = NULL;
    if (diag) {
        fy_diag_set_collect_errors(diag, true);
        parser = fy_parser_create(&(struct fy_parse_cfg){.flags = FYPCF_DEFAULT_PARSE, .diag = diag});
    }
    bool ok = false;
    if (!parser || fy_parser_set_string(parser, text, size))
        fail(&builder, 1, 1, "out of memory");
    else
        ok = run(&builder, parser, diag);
    if (ok && !builder.root)
        ok = fail(&builder, 1, 1, "the file is empty; a protocol begins with 'fovstudy: 1'");
    if (parser)
        fy_parser_destroy(parser);
    if (diag)
        fy_diag_destroy(diag);
    return ok ? builder.root : NULL;
}

const struct yaml_node *yaml_get(const struct yaml_node *map, const char *key)
{
    if (map->kind != YAML_MAP)
        return NULL;
    for (const struct yaml_node *child = map->first; child; child = child->next)
        if (strcmp(child->key, key) == 0)
            return child;
    return NULL;
}
