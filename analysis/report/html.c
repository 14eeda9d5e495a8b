#include "analysis/report/html.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void html_text(FILE *out, const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        switch (*c) {
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '&':
            fputs("&amp;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        case '\'':
            fputs("&#39;", out);
            break;
        default:
            if ((*c < 0x20 && *c != '\n' && *c != '\t') || *c == 0x7f)
                fputs("\xef\xbf\xbd", out);
            else
                fputc(*c, out);
        }
    }
}

static void write_formatted(FILE *out, const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    char small[256];
    int size = vsnprintf(small, sizeof small, format, arguments);
    if (size >= 0 && (size_t)size < sizeof small) {
        html_text(out, small);
    } else if (size >= 0) {
        char *text = malloc((size_t)size + 1);
        if (text) {
            vsnprintf(text, (size_t)size + 1, format, again);
            html_text(out, text);
        }
        free(text);
    }
    va_end(again);
}

void html_printf(FILE *out, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_formatted(out, format, arguments);
    va_end(arguments);
}

void html_cell(FILE *out, const char *tag, const char *format, ...)
{
    fprintf(out, "<%s>", tag);
    va_list arguments;
    va_start(arguments, format);
    write_formatted(out, format, arguments);
    va_end(arguments);
    fprintf(out, "</%.2s>", tag);
}

void html_p_value(char out[24], double p)
{
    if (isnan(p))
        snprintf(out, 24, "not defined");
    else if (p < 0.0001)
        snprintf(out, 24, "< 0.0001");
    else
        snprintf(out, 24, "%.4f", p);
}
