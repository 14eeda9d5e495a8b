// The fades of a sequential trial (one option, gray with a marker, the other, gray) against the protocol, by
// the frames' times and levels. A pause holds the trial's clock and is not in the frames: such trials are not
// judged.
#include "analysis/report/audit_private.h"

#include <math.h>
#include <stdio.h>

static bool judge_between(struct audit_pass *pass, const struct store_audit_trial_row *trial, int64_t full_ns,
                          double frame)
{
    const struct audit_watch *w = &pass->watch;
    int64_t out = w->view_ns + trial->view_ns, gray = out + trial->fade_ns[0], back = gray + trial->gap_ns;
    // The frame that ends the gap is still gray: the way back begins with it and is seen from the next one on.
    int64_t step = (int64_t)frame;
    char what[96] = "";
    bool off = w->first_ns < 0;
    if (off)
        snprintf(what, sizeof what, "the second option came without a fade");
    if (!off && trial->gap_ns > 0 && w->gray_ns < 0) {
        snprintf(what, sizeof what, "no frame between the options was gray");
        off = true;
    }
    off = off || audit_corner("the first option's fade began", w->first_ns, out, frame, what) ||
          (w->gray_ns >= 0 && audit_corner("it was gray", w->gray_ns, gray, frame, what)) ||
          (w->back_ns >= 0 && audit_corner("it came back from gray", w->back_ns, back + step, frame, what)) ||
          (w->back_ns >= 0 &&
           audit_corner("the fade ended", full_ns, w->back_ns + trial->fade_ns[2], frame, what)) ||
          (w->back_ns < 0 &&
           audit_corner("the fade ended", full_ns, back + trial->fade_ns[2] + step, frame, what));
    pass->audit->sessions[pass->session].judged++;
    return !off || audit_note_fade(pass, pass->session, trial, 1, what);
}

// Out of the second option, where the trial's pictures end.
static bool judge_end(struct audit_pass *pass, const struct store_audit_trial_row *trial, double frame)
{
    const struct audit_watch *w = &pass->watch;
    int64_t out = w->view_ns + trial->view_ns;
    char what[96] = "";
    bool off =
        audit_corner("the second option's fade began", w->first_ns, out, frame, what) ||
        audit_corner("after the second option it was gray", w->gray_ns, out + trial->fade_ns[0], frame, what);
    return !off || audit_note_fade(pass, pass->session, trial, 2, what);
}

bool audit_watch_sequence(struct audit_pass *pass, const struct store_audit_trial_row *trial,
                          const struct store_audit_frame_row *row)
{
    struct audit_watch *w = &pass->watch;
    double frame = audit_frame_ns(pass, pass->session);
    bool judged = !w->gap && !isnan(frame) &&
                  !audit_paused_between(pass, w->trial_id, w->segment_id, INT64_MIN, row->start_ns);
    bool ok = true;
    if (row->fade_level > 0) {
        bool gray = row->fade_level >= 1, first_gray = gray && w->gray_ns < 0;
        if (w->first_ns < 0)
            w->first_ns = row->start_ns;
        if (first_gray)
            w->gray_ns = row->start_ns;
        if (!gray && w->gray_ns >= 0 && w->back_ns < 0)
            w->back_ns = row->start_ns;
        return !(first_gray && w->second && judged) || judge_end(pass, trial, frame);
    }
    if (w->option && w->option != row->option) {
        pass->audit->sessions[pass->session].toggles++;
        ok = !judged || judge_between(pass, trial, row->start_ns, frame);
        w->second = true;
    }
    if (w->option != row->option)
        w->view_ns = row->start_ns;
    w->option = row->option;
    w->first_ns = w->gray_ns = w->back_ns = -1;
    w->gap = w->gap && w->view_ns != row->start_ns; // a new showing has none yet
    return ok;
}
