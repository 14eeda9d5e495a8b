// Writing HTML: every text of a study goes through html_text().
#ifndef ANALYSIS_REPORT_HTML_H
#define ANALYSIS_REPORT_HTML_H

#include <stdio.h>

// Escaped for element content and quoted attributes; control characters become U+FFFD.
void html_text(FILE *out, const char *text);

// printf into html_text(): for numbers and mixed text.
void html_printf(FILE *out, const char *format, ...) __attribute__((format(printf, 2, 3)));

// A table cell. `tag` is "td", "th" or one with attributes, such as "th scope=\"row\"".
void html_cell(FILE *out, const char *tag, const char *format, ...) __attribute__((format(printf, 3, 4)));

// "0.0437", "< 0.0001", or "not defined" for NaN.
void html_p_value(char out[24], double p);

#endif
