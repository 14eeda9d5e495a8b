// Null and catch trials.
#include "analysis/report/html.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>

static void p_words(const struct report *r, const char *test, const struct check_bias *b)
{
    char p[24], holm[24];
    html_p_value(p, b->p_value);
    html_p_value(holm, b->holm);
    html_printf(r->out, "%s p %s%s", test, p[0] == '<' ? "" : "= ", p);
    if (!isnan(r->checks.side.p_value) && !isnan(r->checks.first.p_value))
        html_printf(r->out, ", with Holm\u2019s correction for these two checks %s", holm);
    fputs("). ", r->out);
}

static void bias_sentence(const struct report *r, const char *what, const struct check_bias *b)
{
    const struct stat_binomial *all = &b->binomial;
    html_printf(r->out, "%s was chosen in %" PRId64 " of %" PRId64, what, all->k, all->n);
    if (!b->several) {
        html_printf(r->out, " (%.1f\u00a0%%, %g\u00a0%% interval %.1f to %.1f\u00a0%%, ", 100 * all->estimate,
                    100 * r->conf, 100 * all->ci.low, 100 * all->ci.high);
        p_words(r, "exact", b);
        return;
    }
    html_printf(r->out, "; mean of the shares of %zu %s %.1f\u00a0%% (", b->people,
                b->people == 1 ? "person" : "people", 100 * b->estimate);
    if (isnan(b->t.ci_low))
        fputs("no interval can be estimated, ", r->out);
    else
        html_printf(r->out, "%g\u00a0%% t interval %.1f to %.1f\u00a0%%, ", 100 * r->conf, 100 * b->t.ci_low,
                    100 * b->t.ci_high);
    if (isnan(b->p_value))
        fputs("one person cannot be tested). ", r->out);
    else
        p_words(r, "exact sign-flip", b);
}

static void people_table(const struct report *r)
{
    FILE *out = r->out;
    const struct checks *c = &r->checks;
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Null and catch "
          "trials\"><table>\n<caption>"
          "Null and catch trials per person</caption>\n<thead><tr><th scope=\"col\" "
          "class=\"word\">participant</th>"
          "<th scope=\"col\">null trials, slot a chosen</th><th scope=\"col\">catch trials "
          "missed</th></tr></thead>\n"
          "<tbody>\n",
          out);
    for (size_t i = 0; i < c->person_count; i++) {
        const struct check_person *p = &c->people[i];
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s%s", r->sample->people[p->person].code,
                  p->excluded ? " (excluded)" : "");
        if (p->nulls)
            html_cell(out, "td", "%" PRId64 " of %" PRId64, p->null_a, p->nulls);
        else
            html_cell(out, "td", "\u2013");
        if (p->catches)
            html_cell(out, "td", "%" PRId64 " of %" PRId64, p->missed, p->catches);
        else
            html_cell(out, "td", "\u2013");
        fputs("</tr>\n", out);
    }
    fputs("</tbody></table></div>\n", out);
}

void report_checks(const struct report *r)
{
    const struct checks *c = &r->checks;
    if (c->person_count == 0)
        return;
    report_heading(r, "Null and catch trials");
    fputs("<p>", r->out);
    if (c->nulls) {
        html_printf(
            r->out,
            "In null trials both options are the same, so a side that is chosen more often is a bias. ");
        bias_sentence(r, "Slot a", &c->side);
        if (c->first_unknown < c->nulls)
            bias_sentence(r, "The option shown first", &c->first);
        fputs("A large p does not show that there is no bias. ", r->out);
    }
    if (c->first_unknown)
        html_printf(
            r->out,
            "In %" PRId64 " of %" PRId64
            " null %s it is not recorded which option was shown first, which says nothing of the order. ",
            c->first_unknown, c->nulls, c->nulls == 1 ? "trial" : "trials");
    if (c->null_equal)
        html_printf(r->out, "\u201cEqual\u201d was answered in %" PRId64 " null %s. ", c->null_equal,
                    c->null_equal == 1 ? "trial" : "trials");
    if (c->catches)
        html_printf(r->out, "Of %" PRId64 " catch %s with an obvious difference %" PRId64 " %s missed. ",
                    c->catches, c->catches == 1 ? "trial" : "trials", c->missed,
                    c->missed == 1 ? "was" : "were");
    if (c->catch_unknown)
        html_printf(r->out,
                    "Catch trials left out, since the file does not tell which answer was right: %" PRId64 ".",
                    c->catch_unknown);
    fputs("</p>\n", r->out);
    people_table(r);
}
