// The experimenter's desk: a panel on the terminal that says where the session is, and keys to act on it.
//
//     s start or go on   p pause   a end the session (asks)   f flag the trial as bad   n a note   y, n answer
//
// The participant sees none of it, and it says nothing of which option is under test: frame times are those of
// all frames, the options are named only where desc.unblind is set.
//
// Use: desk_open -> each frame desk_take until it returns DESK_NOTHING, desk_frame, desk_show -> desk_close.
// Does not: decide what a key does to the session, keep time.
#ifndef APP_SESSION_DESK_H
#define APP_SESSION_DESK_H

#include "app/gaze/fovea.h"
#include "studies/engine/machine.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { DESK_NOTE = 240, DESK_FRAMES = 512, DESK_TEXT = 4096 };

struct desk_desc {
    FILE *out; // a terminal
    int in;    // file descriptor of its keys
    const struct plan *plan;
    const char *participant; // code
    double refresh_hz;       // 0: not known
    bool has_gaze, unblind;
};

struct desk;
// NULL: no memory, or `in` or `out` is no terminal.
struct desk *desk_open(const struct desk_desc *desc);
void desk_close(struct desk *desk); // gives the terminal back; NULL is fine

enum desk_command { DESK_NOTHING, DESK_EVENT, DESK_NOTED };
// What the experimenter asked for: an event for the machine, or a note that is complete.
enum desk_command desk_take(struct desk *desk, const struct machine_view *view, struct machine_event *out_event,
                            char out_note[DESK_NOTE]);

void desk_frame(struct desk *desk, double frame_ms, bool late);
// Draws the panel, at most four times a second. trouble: a sentence, NULL: none.
void desk_show(struct desk *desk, int64_t now_ns, const struct machine_view *view, const struct fovea_use *gaze,
               const char *trouble);

// A sentence that stays above the panel.
void desk_say(struct desk *desk, const char *sentence);

// The parts, for tests.
enum desk_command desk_key(char key, const struct machine_view *view, struct machine_event *out_event);
struct desk_frames {
    double p50_ms, p99_ms;
    uint64_t count, late;
};
void desk_text(const struct desk_desc *desc, const struct machine_view *view, const struct fovea_use *gaze,
               const struct desk_frames *frames, const char *trouble, char out[DESK_TEXT]);

#endif
