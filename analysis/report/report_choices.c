// Choices and toggles.
#include "analysis/report/figures.h"
#include "analysis/report/html.h"
#include "analysis/report/level.h"
#include "analysis/report/sections.h"

#include <inttypes.h>
#include <math.h>

void report_cell_words(const struct choice_cell *cell, char out[256])
{
    char words[256];
    if (cell->level_count)
        level_join(cell, 0, cell->level_count, words);
    else
        snprintf(words, sizeof words, "%s", cell->label);
    snprintf(out, 256, "%s%s%.120s%s%.80s%s", cell->name_block ? cell->block : "", cell->name_block ? ": " : "",
             words, cell->options ? ", " : "", cell->options ? cell->options : "",
             cell->right && cell->level_count ? ", right answers" : "");
}

static const char *direction_words(const struct choice_cell *cell)
{
    static const char *const words[2][3] = {
        {"reference", "no clear preference", "test"},
        {"wrong more often", "no better than guessing", "right more often"}};
    if (report_outside(cell) && report_direction(cell) == 0)
        return "p and mean share disagree";
    return words[cell->right][report_direction(cell) + 1];
}

static void choices_caption(const struct report *r, char *out, size_t size)
{
    char region[512] = "", interval[384] = "";
    if (r->choices.one_each)
        snprintf(
            region, sizeof region,
            "<span class=\"key\" style=\"background:#cfe6d2\"></span> The %g&nbsp;%% region of the null "
            "hypothesis (both options chosen equally often) for each cell\u2019s own n, drawn half an answer "
            "wider on both sides; a bar that ends outside it shows a preference. ",
            100 * r->conf);
    if (r->choices.several)
        snprintf(
            interval, sizeof interval,
            "%s the mean of the people\u2019s shares, with its %g&nbsp;%% t interval as a line instead of a "
            "region; an arrow marks one that goes on beyond 0 or 100&nbsp;%%, which the table has whole. ",
            r->choices.one_each ? "Where a person answered several times in a cell, the bar is"
                                : "Each person answered several times in a cell; the bar is",
            100 * r->conf);
    snprintf(out, size,
             "<span class=\"key\" style=\"background:#e8912d\"></span> Percent of %s. %s%s"
             "Dashed: 50&nbsp;%%. %s%s",
             figure_choices_what(&r->choices), region, interval,
             !r->choices.several ? "In the bars: percent, and how many of all answers."
             : r->choices.one_each
                 ? "Under the bars: percent, and how many of all answers, or n, the people with several."
                 : "Under the bars: percent, and n, the people.",
             !figure_choices_numbered(&r->choices)
                 ? ""
                 : " Numbers under the bars are those of the table\u2019s rows.");
}

static void choice_row(const struct report *r, const struct choice_cell *cell, size_t index)
{
    FILE *out = r->out;
    const struct stat_region *region = &cell->binomial.null_region;
    char words[256], p[24], holm[24];
    report_cell_words(cell, words);
    html_p_value(p, cell->p_value);
    html_p_value(holm, cell->holm);
    fprintf(out, "<tr%s>", report_outside(cell) ? " class=\"outside\"" : "");
    if (figure_choices_numbered(&r->choices))
        html_cell(out, "td", "%zu", index + 1);
    html_cell(out, "th scope=\"row\" class=\"word\"", "%s", words);
    html_cell(out, "td", "%" PRId64, cell->chosen);
    html_cell(out, "td", "%" PRId64, cell->n);
    if (r->choices.several)
        html_cell(out, "td", "%zu", stat_people_sum(cell->counts, cell->people).people);
    if (cell->n) {
        html_cell(out, "td class=\"share\"", "%.1f\u00a0%%", 100 * cell->estimate);
        if (isnan(cell->ci.low))
            html_cell(out, "td", "\u2013");
        else
            html_cell(out, "td", "%.1f to %.1f\u00a0%%", 100 * cell->ci.low, 100 * cell->ci.high);
        if (cell->method == CHOICE_BINOMIAL)
            html_cell(out, "td", "%" PRId64 " to %" PRId64, region->low, region->high);
        else
            html_cell(out, "td", "\u2013");
        if (r->choices.several)
            html_cell(out, "td class=\"word\"", "%s", choice_method_word(cell->method));
        html_cell(out, "td", "%s", p);
        html_cell(out, "td", "%s", holm);
    } else {
        for (int i = 0; i < (r->choices.several ? 6 : 5); i++)
            html_cell(out, "td", "none");
    }
    html_cell(out, "td class=\"word\"", "%s", direction_words(cell));
    fputs("</tr>\n", out);
}

static void choices_table(const struct report *r)
{
    FILE *out = r->out;
    const struct choices *c = &r->choices;
    bool numbered = figure_choices_numbered(c);
    fprintf(out,
            "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Choices per "
            "cell\"><table class=\"wrap\">\n<caption>Choices per cell, %s against "
            "50&nbsp;%%</caption>\n<thead><tr>",
            !c->several   ? "exact two-sided binomial test"
            : c->one_each ? "exact two-sided binomial or sign-flip test"
                          : "exact two-sided sign-flip test");
    fputs(numbered ? "<th scope=\"col\">no.</th>" : "", out);
    fputs(c->several
              ? "<th scope=\"col\" class=\"word\">cell</th><th scope=\"col\">chosen (all)</th><th "
                "scope=\"col\">n (all)</th><th scope=\"col\">people</th><th scope=\"col\">mean share</th>"
              : "<th scope=\"col\" class=\"word\">cell</th><th scope=\"col\">chosen</th><th "
                "scope=\"col\">n</th><th scope=\"col\">share</th>",
          out);
    fprintf(out, "<th scope=\"col\">%g&nbsp;%% interval</th><th scope=\"col\">null region</th>", 100 * c->conf);
    fputs(c->several ? "<th scope=\"col\" class=\"word\">tested by</th>" : "", out);
    fputs("<th scope=\"col\">p</th><th scope=\"col\">p (Holm)</th><th scope=\"col\" "
          "class=\"word\">result</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < c->cell_count; i++)
        choice_row(r, &c->cells[i], i);
    fputs("</tbody></table></div>\n", out);
}

static void choices_notes(const struct report *r)
{
    const struct choices *c = &r->choices;
    bool first = true;
    if (c->several)
        fputs("<p>Where somebody answered several times, the mean share is that over people of each one\u2019s "
              "own "
              "share, every person counting the same; it is not chosen of n where some answered more than "
              "others. "
              "People are those with an answer that is part of n.</p>\n",
              r->out);
    if (c->equal == 0)
        return;
    fputs("<p>Answers \u201cequal\u201d are not part of n: ", r->out);
    for (size_t i = 0; i < c->cell_count; i++) {
        char words[256];
        if (c->cells[i].equal == 0)
            continue;
        report_cell_words(&c->cells[i], words);
        html_printf(r->out, "%s%s (%" PRId64 ")", first ? "" : "; ", words, c->cells[i].equal);
        first = false;
    }
    fputs(".</p>\n", r->out);
}

static void options_sentence(const struct report *r)
{
    const struct choice_cell *first = &r->choices.cells[0];
    bool same = true;
    for (size_t i = 1; i < r->choices.cell_count; i++)
        same = same && r->choices.cells[i].reference == first->reference;
    fputs("<p>", r->out);
    if (same && first->test != SAMPLE_NONE && first->reference != SAMPLE_NONE)
        html_printf(r->out, "Test option: %s. Reference: %s.", r->sample->conditions[first->test].mode,
                    report_label(r, first->reference));
    fputs("</p>\n", r->out);
}

void report_choices(const struct report *r)
{
    report_heading(r, "Choices");
    if (r->choices.cell_count == 0) {
        fputs("<p class=\"note\">No choice was recorded that counts.</p>\n", r->out);
        return;
    }
    char caption[1536];
    choices_caption(r, caption, sizeof caption);
    options_sentence(r);
    report_figure(r, &r->choices_figure, caption);
    choices_table(r);
    choices_notes(r);
    report_equivalence(r);
    report_people(r);
    report_choice_factors(r);
    report_choice_three(r);
}

static void number_cell(FILE *out, double value, const char *unit)
{
    if (isnan(value))
        html_cell(out, "td", "\u2013");
    else
        html_cell(out, "td", "%.2f%s", value, unit);
}

static void toggles_table(const struct report *r)
{
    FILE *out = r->out;
    fputs("<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"Toggles per "
          "cell\"><table>\n<caption>Switches before "
          "the answer, and reaction time</caption>\n<thead><tr><th scope=\"col\" class=\"word\">cell</th><th "
          "scope=\"col\">"
          "answers</th><th scope=\"col\">toggles M</th><th scope=\"col\">SD</th><th scope=\"col\">reaction "
          "time, median"
          "</th></tr></thead>\n<tbody>\n",
          out);
    for (size_t i = 0; i < r->choices.cell_count; i++) {
        const struct choice_cell *cell = &r->choices.cells[i];
        char words[256];
        report_cell_words(cell, words);
        fputs("<tr>", out);
        html_cell(out, "th scope=\"row\" class=\"word\"", "%s", words);
        html_cell(out, "td", "%zu", cell->answers);
        number_cell(out, cell->toggles.mean, "");
        number_cell(out, cell->toggles.sd, "");
        number_cell(out, cell->reaction_median_s, "\u00a0s");
        fputs("</tr>\n", out);
    }
    fputs("</tbody></table></div>\n", out);
}

void report_toggles(const struct report *r)
{
    const struct choices *c = &r->choices;
    if (c->cell_count == 0)
        return;
    report_heading(r, "Toggles before answering");
    fputs("<p>", r->out);
    if (c->toggles.n > 1)
        html_printf(r->out, "%.2f switches before a decision (SD %.2f) over %zu answers. ", c->toggles.mean,
                    c->toggles.sd, c->toggles.n);
    int64_t decided = c->answers - c->equal;
    if (decided) {
        html_printf(r->out, "Of all %" PRId64 " %s for an option, counted as they are: ", decided,
                    decided == 1 ? "answer" : "answers");
        if (c->first_known)
            html_printf(r->out, "the one shown first was chosen in %" PRId64 " (%.0f\u00a0%%), ",
                        c->chosen_first, 100 * (double)c->chosen_first / (double)c->first_known);
        html_printf(r->out, "the one in slot a in %" PRId64 " (%.0f\u00a0%%).", c->chosen_a,
                    100 * (double)c->chosen_a / (double)decided);
        if (c->first_known < decided)
            html_printf(r->out, " Of %" PRId64 " it is not known which was shown first.",
                        decided - c->first_known);
        fputs(" These are counts of answers; whether side or order has an effect is tested below, where each "
              "person gives one value that a preference does not move, so that percentages there differ.",
              r->out);
    }
    fputs("</p>\n", r->out);
    toggles_table(r);
}
