// Making gnuplot's SVG part of a page: several figures in one page must not share ids, and a page has no XML
// prolog.
#include "analysis/report/figure.h"

#include "analysis/report/html.h"

#include <stdlib.h>
#include <string.h>

// Where an id is made or used, within a tag.
static const char *const id_marks[] = {" id='", " id=\"", "href='#", "href=\"#", "url(#"};

static size_t id_mark(const char *at)
{
    for (size_t i = 0; i < sizeof id_marks / sizeof id_marks[0]; i++)
        if (strncmp(at, id_marks[i], strlen(id_marks[i])) == 0)
            return strlen(id_marks[i]);
    return 0;
}

// The element's end where `at` begins one that the page must not have: gnuplot's own titles show as tool tips.
static const char *skip_element(const char *at)
{
    static const char *const names[][2] = {{"<title>", "</title>"}, {"<desc>", "</desc>"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const char *end = strncmp(at, names[i][0], strlen(names[i][0])) == 0 ? strstr(at, names[i][1]) : NULL;
        if (end)
            return end + strlen(names[i][1]);
    }
    return NULL;
}

static void write_body(FILE *out, const char *at, const char *id)
{
    bool in_tag = false;
    while (*at) {
        const char *after = in_tag ? NULL : skip_element(at);
        if (after) {
            at = after;
            continue;
        }
        size_t mark = in_tag ? id_mark(at) : 0;
        if (mark) {
            fprintf(out, "%.*s%s-", (int)mark, at, id);
            at += mark;
            continue;
        }
        if (*at == '<' || *at == '>')
            in_tag = *at == '<';
        if (*at != '\t')
            fputc(*at, out);
        at++;
    }
}

char *figure_embeddable(const char *svg, const struct figure_text *text)
{
    const char *root = strstr(svg, "<svg"), *box = root ? strstr(root, "viewBox=\"") : NULL;
    const char *body = root ? strchr(root, '>') : NULL;
    const char *end = root ? strstr(root, "</svg>") : NULL;
    if (!body || !end || !box || box > body)
        return NULL;
    char *result = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&result, &size);
    if (!out)
        return NULL;
    fprintf(
        out,
        "<svg class=\"%s\" xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"",
        text->css_class);
    const char *box_end = strchr(box + strlen("viewBox=\""), '"');
    fprintf(out, " %.*s role=\"img\" aria-labelledby=\"%s-title %s-desc\">\n", (int)(box_end + 1 - box), box,
            text->id, text->id);
    fprintf(out, "<title id=\"%s-title\">", text->id);
    html_text(out, text->title);
    fprintf(out, "</title>\n<desc id=\"%s-desc\">", text->id);
    html_text(out, text->description);
    fputs("</desc>", out);
    write_body(out, body + 1, text->id);
    bool ok = !ferror(out);
    if (fclose(out) == 0 && ok)
        return result;
    free(result);
    return NULL;
}
