// The fade of every switch against the protocol: where it begins, is gray, and ends, by the frames' times and
// levels; and by the exposures' times, which hold also where frame rows are missing.
#include "analysis/report/audit_private.h"

#include <math.h>
#include <stdio.h>

double audit_frame_ns(const struct audit_pass *pass, size_t session)
{
    return 1e9 / pass->sample->sessions[pass->audit->sessions[session].session].refresh_hz; // NaN: not known
}

// The first moment of a trial, among all in their order; moment_count where it has none.
static size_t first_moment(const struct audit_pass *pass, int64_t trial_id)
{
    size_t low = 0, high = pass->moment_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (pass->moments[middle].row.trial_id < trial_id)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// The participant's switch whose fade left the full image at full_ns: the key came before the next frame. NULL:
// none.
static struct audit_moment *find_toggle(const struct audit_pass *pass, int64_t trial_id, int64_t segment_id,
                                        int64_t full_ns, double frame)
{
    for (size_t i = first_moment(pass, trial_id); i < pass->moment_count; i++) {
        struct audit_moment *moment = &pass->moments[i];
        if (moment->row.trial_id != trial_id)
            break;
        if (moment->row.segment_id == segment_id && moment->toggle && moment->row.at_ns >= full_ns &&
            (double)(moment->row.at_ns - full_ns) <= AUDIT_FADE_FRAMES * frame)
            return moment;
    }
    return NULL;
}

bool audit_paused_between(const struct audit_pass *pass, int64_t trial_id, int64_t segment_id, int64_t from_ns,
                          int64_t to_ns)
{
    for (size_t i = first_moment(pass, trial_id); i < pass->moment_count; i++) {
        const struct store_moment_row *row = &pass->moments[i].row;
        if (row->trial_id != trial_id)
            break;
        if (row->segment_id == segment_id && row->what == STORE_MOMENT_PAUSE && row->at_ns >= from_ns &&
            row->at_ns <= to_ns)
            return true;
    }
    return false;
}

bool audit_note_fade(struct audit_pass *pass, size_t session, const struct store_audit_trial_row *trial,
                     int64_t number, const char *what)
{
    struct audit *audit = pass->audit;
    if (!sample_grow(&audit->fades, audit->fade_count, sizeof *audit->fades))
        return false;
    struct audit_fade *fade = &audit->fades[audit->fade_count++];
    *fade = (struct audit_fade){
        .session = session, .trial_id = trial->id, .ordinal = trial->ordinal, .toggle = number};
    snprintf(fade->what, sizeof fade->what, "%s", what);
    return audit_note(pass, session, trial->id, AUDIT_FADES, 1);
}

// One fade is one finding, whichever way it was seen and however many of its corners are off.
static bool note_fade(struct audit_pass *pass, size_t session, const struct store_audit_trial_row *trial,
                      struct audit_moment *toggle, const char *what)
{
    if (toggle && toggle->off)
        return true;
    if (toggle)
        toggle->off = true;
    return audit_note_fade(pass, session, trial, toggle ? toggle->toggle : 0, what);
}

bool audit_corner(const char *what, int64_t seen_ns, int64_t due_ns, double frame, char out[96])
{
    double off = (double)(seen_ns - due_ns);
    if (fabs(off) <= AUDIT_FADE_FRAMES * frame)
        return false;
    snprintf(out, 96, "%s %.1f ms %s", what, fabs(off) / 1e6, off > 0 ? "late" : "early");
    return true;
}

static bool judge(struct audit_pass *pass, const struct store_audit_trial_row *trial,
                  const struct store_audit_frame_row *end)
{
    const struct audit_watch *w = &pass->watch;
    double frame = audit_frame_ns(pass, pass->session);
    struct audit_moment *toggle = find_toggle(pass, w->trial_id, w->segment_id, w->full_ns, frame);
    int64_t gray = w->full_ns + trial->fade_ns[0], back = gray + trial->fade_ns[1],
            full = back + trial->fade_ns[2];
    char what[96] = "";
    if (isnan(frame) || w->gap)
        return true;
    bool off = !toggle;
    if (off)
        snprintf(what, sizeof what, "the option changed without a key press at its beginning");
    off = off || audit_corner("the fade ended", end->start_ns, full, frame, what) ||
          audit_corner("the fade began", w->first_ns, toggle->row.at_ns, frame, what);
    if (!off && trial->fade_ns[1] > 0 && w->gray_ns < 0) {
        snprintf(what, sizeof what, "no frame of the fade was gray");
        off = true;
    }
    off = off || (w->gray_ns >= 0 && audit_corner("it was gray", w->gray_ns, gray, frame, what)) ||
          (w->back_ns >= 0 && audit_corner("it came back from gray", w->back_ns, back, frame, what));
    if (toggle)
        toggle->judged = true;
    return !off || note_fade(pass, pass->session, trial, toggle, what);
}

bool audit_watch_frame(struct audit_pass *pass, const struct store_audit_frame_row *row)
{
    struct audit_watch *w = &pass->watch;
    const struct store_audit_trial_row *trial = audit_find_trial(pass, row->trial_id);
    bool stimulus = row->phase == 's' || row->phase == 'f';
    bool ok = true;
    if (row->trial_id != w->trial_id || row->attempt != w->attempt || row->segment_id != w->segment_id ||
        !stimulus)
        *w = (struct audit_watch){.segment_id = row->segment_id,
                                  .trial_id = row->trial_id,
                                  .attempt = row->attempt,
                                  .last_number = row->number,
                                  .first_ns = -1};
    if (!stimulus || !trial || !(trial->switches || trial->sequence))
        return true;
    w->gap = w->gap || row->number > w->last_number + 1;
    w->last_number = row->number;
    if (trial->sequence)
        return audit_watch_sequence(pass, trial, row);
    if (row->fade_level > 0) {
        bool gray = row->fade_level >= 1;
        if (w->first_ns < 0)
            w->first_ns = row->start_ns;
        if (gray && w->gray_ns < 0)
            w->gray_ns = row->start_ns;
        if (!gray && w->gray_ns >= 0 && w->back_ns < 0)
            w->back_ns = row->start_ns;
        return true;
    }
    if (w->first_ns >= 0 && w->option && w->option != row->option)
        ok = judge(pass, trial, row);
    w->option = row->option;
    w->full_ns = row->start_ns;
    w->first_ns = w->gray_ns = w->back_ns = -1;
    w->gap = false;
    return ok;
}

// Two exposures of one attempt, one after the other, of different options: the time between their full images
// is the fade's.
static bool judge_exposures(struct audit_pass *pass, const struct store_exposure_row *from,
                            const struct store_exposure_row *to)
{
    const struct store_audit_trial_row *trial = audit_find_trial(pass, to->trial_id);
    if (!trial || !trial->switches || from->full_end_ns < 0 || to->full_start_ns < 0 ||
        from->option == to->option)
        return true;
    if (sample_any_session(pass->sample, pass->file, trial->session_id) == SAMPLE_NONE)
        return true;
    size_t index = sample_any_session(pass->sample, pass->file, trial->session_id), session = 0;
    while (session < pass->audit->session_count && pass->audit->sessions[session].session != index)
        session++;
    if (session == pass->audit->session_count) // it drew nothing: the times are those of the clock's steps
        return true;
    double frame = audit_frame_ns(pass, session);
    struct audit_moment *toggle = find_toggle(pass, to->trial_id, to->segment_id, from->full_end_ns, frame);
    char what[96] = "";
    if (isnan(frame) ||
        audit_paused_between(pass, to->trial_id, to->segment_id, from->full_end_ns, to->full_start_ns))
        return true;
    bool off = !toggle;
    if (off)
        snprintf(what, sizeof what, "the option changed without a key press at its beginning");
    else
        toggle->judged = true;
    off = off || audit_corner("the fade ended", to->full_start_ns,
                              from->full_end_ns + trial->fade_ns[0] + trial->fade_ns[1] + trial->fade_ns[2],
                              frame, what);
    return !off || note_fade(pass, session, trial, toggle, what);
}

bool audit_take_exposure(void *user, const struct store_exposure_row *row)
{
    struct audit_pass *pass = user;
    struct store_exposure_row last = pass->exposure;
    pass->exposure = *row;
    return last.trial_id != row->trial_id || last.attempt != row->attempt ||
           last.segment_id != row->segment_id || judge_exposures(pass, &last, row);
}
