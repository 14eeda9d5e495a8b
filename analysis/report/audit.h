// Every frame accounted for: rows against frames submitted, late frames, stale gaze, foveation that quietly was
// another one, and the fade of every switch against the protocol.
//
// Use: audit_load() -> read -> audit_free(). All sessions of the sample, excluded ones too.
// A clean session has no finding. A frame may be counted under several headings, under each once.
// Does not: judge what the display did after the program handed it a frame; the file has no measurement of it.
#ifndef ANALYSIS_REPORT_AUDIT_H
#define ANALYSIS_REPORT_AUDIT_H

#include "analysis/report/sample.h"

// A frame drawn by a gaze sample older than this, or one that frames have used for longer, is stale. Foveation
// tolerates 50 to 70 ms in all (Albert et al. 2017, ACM TAP 14:25); a tracker of 30 Hz that loses two samples
// is 100 ms old. Through a blink, where samples come without a direction, the direction is held on purpose.
#define AUDIT_STALE_MS 100.0
#define AUDIT_BLINK_MS 500.0
// Fades may be off by one refresh of the display, and a tenth of it for the clock's jitter.
#define AUDIT_FADE_FRAMES 1.1

enum audit_count {
    AUDIT_MISSING,  // frames submitted that have no row
    AUDIT_REPEATED, // rows whose number is not higher than the one before
    AUDIT_LATE_STIMULUS,
    AUDIT_LATE_FADE,
    AUDIT_LATE_OTHER, // questions, rest
    AUDIT_STALE,
    AUDIT_FIXED,   // foveated option, fovea fixed though the trial asks for gaze or target
    AUDIT_LOST,    // the same, gaze lost
    AUDIT_WRONG,   // the same, fovea from something else
    AUDIT_DIFFERS, // rendered otherwise than the condition says, for another reason than lost gaze
    AUDIT_COPIED,  // the right eye's fovea is the left one's though the tracker gave both
    AUDIT_FADES,   // fades off the protocol
    AUDIT_COUNTS
};
const char *audit_words(enum audit_count count); // "stale gaze"
const char *audit_key(enum audit_count count);   // "stale", for JSON

struct audit_session {
    size_t session;              // index into the sample's sessions
    int64_t segments, uncounted; // uncounted: segments that drew and did not end by themselves
    int64_t frames, submitted;   // rows; by the counted segments' own word
    int64_t dropped;             // of the missing: what the store said it could not take
    int64_t late_unknown;
    int64_t toggles,
        judged; // switches; those whose fade could be judged (not cut short by a pause or an answer)
    int64_t counts[AUDIT_COUNTS];
};

struct audit_trial {           // one that has a finding
    size_t session;            // index into audit.sessions
    int64_t trial_id, ordinal; // 0: between trials
    int64_t counts[AUDIT_COUNTS];
};

struct audit_fade { // one that is off
    size_t session;
    int64_t trial_id, ordinal, toggle; // the how manieth of the trial
    char what[96];                     // "the fade ended 40.0 ms late"
};

struct audit {
    size_t session_count, trial_count, fade_count;
    struct audit_session *sessions; // those that drew or have frames
    struct audit_trial *trials;     // by session and trial
    struct audit_fade *fades;
    int64_t findings; // all counts of all sessions; segments without a count are none
};

bool audit_load(struct audit *out, struct sample *sample, char *error, size_t error_size);
void audit_free(struct audit *audit);

#endif
