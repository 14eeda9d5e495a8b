#include "analysis/report/effects.h"

#include "analysis/report/effects_private.h"
#include "analysis/stats/moments.h"
#include "analysis/stats/multiple.h"
#include "studies/store/views.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *key, *words, *null, *unit;
    double scale, offset;
} checks[EFFECT_CHECKS] = {
    [EFFECT_SIDE] = {"side", "slot a chosen", "nobody had the test option in both slots, evenly enough", "%",
                     100, 50},
    [EFFECT_FIRST] = {"first", "option shown first chosen",
                      "nobody had the test option both first and second, evenly enough", "%", 100, 50},
    [EFFECT_LAST] = {"last", "option shown last chosen",
                     "nobody answered with the test option last on screen and with the other one, evenly "
                     "enough",
                     "%", 100, 50},
    [EFFECT_PLACE] = {"place", "test option chosen later in the session minus earlier",
                      "nobody made two choices", "points", 100, 0},
    [EFFECT_REPETITION] = {"repetition", "same slot as before, beyond chance",
                           "nobody chose both slots in one sitting", "points", 100, 0},
    [EFFECT_TOGGLES] = {"toggles", "switches before choosing the test option minus before the other",
                        "nobody who could switch chose both options", "switches", 1, 0},
    [EFFECT_VIEWING] = {"viewing", "test option's share of viewing when chosen minus when not",
                        "nobody whose viewing time is known chose both options", "points", 100, 0},
};

const char *effect_key(enum effect_check check)
{
    return checks[check].key;
}

const char *effect_words(enum effect_check check)
{
    return checks[check].words;
}

const char *effect_null(enum effect_check check)
{
    return checks[check].null;
}

const char *effect_unit(enum effect_check check)
{
    return checks[check].unit;
}

double effect_shown(enum effect_check check, double value)
{
    return checks[check].offset + checks[check].scale * value;
}

struct filling {
    struct sample *sample;
    size_t file;
    struct store_view_row *views; // of this file, in the order of its trials
    size_t view_count, view;
    struct effect_answer *answers;
    size_t count;
    int64_t equal_session; // the last answer was "equal", in this session; 0: it was not
};

static bool take_view(void *user, const struct store_view_row *row)
{
    struct filling *f = user;
    if (!sample_grow(&f->views, f->view_count, sizeof f->views[0]))
        return false;
    f->views[f->view_count++] = *row;
    return true;
}

static struct effect_answer make_answer(const struct filling *f, const struct store_trial_row *row,
                                        const struct store_view_row *view)
{
    struct effect_answer answer = {.place = f->count,
                                   .test = row->chosen == 't',
                                   .a = row->chosen_a,
                                   .test_a = view->test_slot == 'a',
                                   .first = view->first_shown ? view->first_shown == view->test_slot : -1,
                                   .last = view->last_shown ? view->last_shown == view->test_slot : -1,
                                   .after_equal = f->equal_session == row->session_id,
                                   .toggles = (double)NAN,
                                   .test_view = (double)NAN};
    double test_s = view->test_slot == 'a' ? view->a_s : view->b_s;
    if (strcmp(row->kind, "toggle") ==
        0) // nobody chooses how long to look at options shown one after the other
    {
        answer.toggles = (double)row->toggles;
        if (view->a_s + view->b_s > 0)
            answer.test_view = test_s / (view->a_s + view->b_s);
    }
    return answer;
}

static bool take_trial(void *user, const struct store_trial_row *row)
{
    struct filling *f = user;
    size_t session = sample_find_session(f->sample, f->file, row->session_id);
    while (f->view < f->view_count && f->views[f->view].trial_id != row->id)
        f->view++;
    if (session == SAMPLE_NONE || row->choice_id == 0 || strcmp(row->status, "done") != 0 ||
        (strcmp(row->kind, "toggle") != 0 && strcmp(row->kind, "sequential") != 0) || f->view == f->view_count)
        return true;
    if ((row->chosen != 't' && row->chosen != 'r') || sample_trial_excluded(f->sample, f->file, row->id)) {
        f->equal_session = row->session_id; // what was answered here is no choice that counts
        return true;
    }
    if (!sample_grow(&f->answers, f->count, sizeof f->answers[0]))
        return false;
    struct effect_answer answer = make_answer(f, row, &f->views[f->view]);
    answer.session = session;
    answer.person = f->sample->sessions[session].person;
    f->answers[f->count++] = answer;
    f->equal_session = 0;
    return true;
}

static int by_person(const void *x, const void *y)
{
    const struct effect_answer *a = x, *b = y;
    if (a->person != b->person)
        return a->person < b->person ? -1 : 1;
    return (a->place > b->place) - (a->place < b->place);
}

static void finish_check(struct effect *effect, const double *values, double conf)
{
    struct stat_moments moments = stat_moments(values, effect->people);
    effect->estimate = moments.mean;
    effect->d = moments.sd > 0 ? moments.mean / moments.sd : (double)NAN;
    effect->t = stat_ttest_one_sample(values, effect->people, &(struct stat_ttest_options){.conf = conf});
    effect->flip = stat_signflip_values(values, effect->people);
    effect->exact = effect->people <= STAT_FLIP_VALUES;
    bool testable = effect->people > 1 && effect->flip.uneven > 0; // nothing but 0 has no sign
    effect->p_value = !testable ? (double)NAN : effect->exact ? effect->flip.p_value : effect->t.p_value;
}

// `values` has room for one per answer.
static void finish(struct effects *out, const struct effect_answer *answers, size_t count, double *values)
{
    double p[EFFECT_CHECKS], holm[EFFECT_CHECKS];
    for (size_t check = 0; check < EFFECT_CHECKS; check++) {
        struct effect *effect = &out->checks[check];
        for (size_t from = 0, to; from < count; from = to) {
            for (to = from; to < count && answers[to].person == answers[from].person;)
                to++;
            double value = effect_value((enum effect_check)check, answers + from, to - from);
            effect->left_out += isnan(value) ? 1 : 0;
            if (!isnan(value))
                values[effect->people++] = value;
        }
        finish_check(effect, values, out->conf);
        p[check] = effect->p_value;
        out->tested += isnan(effect->p_value) ? 0 : 1;
    }
    stat_adjust_holm(p, EFFECT_CHECKS, holm);
    for (size_t check = 0; check < EFFECT_CHECKS; check++)
        out->checks[check].holm = holm[check];
}

bool effects_load(struct effects *out, struct sample *sample, double conf, char *error, size_t error_size)
{
    struct filling f = {.sample = sample};
    bool ok = true;
    *out = (struct effects){.conf = conf};
    snprintf(error, error_size, "not enough memory");
    for (; ok && f.file < sample->file_count; f.file++) {
        struct store_reader *reader = sample->files[f.file];
        f.view_count = f.view = 0;
        f.equal_session = 0;
        free(f.views); // sample_grow() counts from the items it is told of
        f.views = NULL;
        ok = store_read_views(reader, take_view, &f) && store_read_trials(reader, take_trial, &f);
        if (!ok && store_reader_error(reader)[0])
            snprintf(error, error_size, "%s", store_reader_error(reader));
    }
    double *values = ok ? malloc((f.count + 1) * sizeof *values) : NULL;
    if (values) {
        if (f.count)
            qsort(f.answers, f.count, sizeof f.answers[0], by_person);
        out->choices = (int64_t)f.count;
        finish(out, f.answers, f.count, values);
        error[0] = '\0';
    }
    ok = values != NULL;
    free(values);
    free(f.views);
    free(f.answers);
    return ok;
}
