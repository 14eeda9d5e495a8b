#include "app/session/desk.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#define DESK_INTERVAL_NS 250000000

struct desk {
    struct desk_desc desc;
    struct termios before;
    bool noting;
    char note[DESK_NOTE];
    size_t note_length;
    double frame_ms[DESK_FRAMES]; // the latest ones, a ring
    uint64_t frames, late;
    int64_t shown_ns;
    bool shown;
    int lines; // of the panel as drawn
};

struct desk *desk_open(const struct desk_desc *desc)
{
    struct desk *desk = NULL;
    struct termios raw;
    if (!isatty(desc->in) || !isatty(fileno(desc->out)) || tcgetattr(desc->in, &raw) != 0)
        return NULL;
    desk = calloc(1, sizeof *desk);
    if (!desk)
        return NULL;
    desk->desc = *desc;
    desk->before = raw;
    raw.c_lflag &= (tcflag_t) ~(ICANON | ECHO); // keys at once, Ctrl-C as ever
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    tcsetattr(desc->in, TCSANOW, &raw);
    return desk;
}

void desk_close(struct desk *desk)
{
    if (!desk)
        return;
    tcsetattr(desk->desc.in, TCSANOW, &desk->before);
    free(desk);
}

enum desk_command desk_key(char key, const struct machine_view *view, struct machine_event *out_event)
{
    bool waits = view->screen == MACHINE_INSTRUCTIONS || view->screen == MACHINE_READY ||
                 view->screen == MACHINE_REST || view->screen == MACHINE_BREAK ||
                 view->screen == MACHINE_PAUSED;
    bool asks = view->screen == MACHINE_ABORT; // consent is the participant's alone
    enum machine_event_kind kind;
    if (key == 's' && waits)
        kind = MACHINE_START;
    else if (key == 'p' && view->screen != MACHINE_CONSENT && !asks)
        kind = MACHINE_PAUSE;
    else if (key == 'a')
        kind = MACHINE_ABORT_KEY;
    else if (key == 'f' && view->screen != MACHINE_CONSENT && !asks)
        kind = MACHINE_FLAG;
    else if ((key == 'y' || key == 'n') && asks)
        kind = key == 'y' ? MACHINE_YES : MACHINE_NO;
    else
        return DESK_NOTHING;
    *out_event = (struct machine_event){.kind = kind};
    return DESK_EVENT;
}

// A note is typed to its end with Enter; Escape drops it.
static enum desk_command type_note(struct desk *desk, char key, char out_note[DESK_NOTE])
{
    if (key == '\n' || key == '\r') {
        desk->noting = false;
        memcpy(out_note, desk->note, desk->note_length);
        out_note[desk->note_length] = '\0';
        return desk->note_length > 0 ? DESK_NOTED : DESK_NOTHING;
    }
    if (key == '\x1b')
        desk->noting = false;
    else if ((key == '\b' || key == '\x7f') && desk->note_length > 0)
        desk->note_length--;
    else if ((unsigned char)key >= ' ' && key != '\x7f' && desk->note_length + 1 < DESK_NOTE)
        desk->note[desk->note_length++] = key;
    return DESK_NOTHING;
}

enum desk_command desk_take(struct desk *desk, const struct machine_view *view, struct machine_event *out_event,
                            char out_note[DESK_NOTE])
{
    char key;
    while (read(desk->desc.in, &key, 1) == 1) {
        enum desk_command command = DESK_NOTHING;
        desk->shown = false; // a key shows its effect at once
        if (desk->noting) {
            command = type_note(desk, key, out_note);
        } else if (key == 'n' && view->screen != MACHINE_ABORT) {
            desk->noting = true;
            desk->note_length = 0;
        } else {
            command = desk_key(key, view, out_event);
        }
        if (command != DESK_NOTHING)
            return command;
    }
    return DESK_NOTHING;
}

void desk_frame(struct desk *desk, double frame_ms, bool late)
{
    desk->frame_ms[desk->frames++ % DESK_FRAMES] = frame_ms;
    desk->late += late;
}

static int by_value(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static struct desk_frames summarise(const struct desk *desk)
{
    double sorted[DESK_FRAMES];
    size_t count = desk->frames < DESK_FRAMES ? (size_t)desk->frames : DESK_FRAMES;
    struct desk_frames frames = {.p50_ms = NAN, .p99_ms = NAN, .count = desk->frames, .late = desk->late};
    if (count == 0)
        return frames;
    memcpy(sorted, desk->frame_ms, count * sizeof sorted[0]);
    qsort(sorted, count, sizeof sorted[0], by_value);
    frames.p50_ms = sorted[count / 2];
    frames.p99_ms = sorted[(count * 99) / 100];
    return frames;
}

static void gaze_line(const struct desk_desc *desc, const struct fovea_use *gaze, char *out, size_t size)
{
    if (!desc->has_gaze)
        snprintf(out, size, "gaze     no tracker: the fovea stays straight ahead");
    else if (!gaze->known)
        snprintf(out, size, "gaze     no sample yet");
    else
        snprintf(out, size, "gaze     %+6.1f %+6.1f deg   %s, %.0f ms old", gaze->x_deg[EYE_LEFT],
                 gaze->y_deg[EYE_LEFT], gaze->lost ? "LOST" : "tracked", (double)gaze->age_ns * 1e-6);
}

static void trial_line(const struct desk_desc *desc, const struct machine_view *view, char *out, size_t size)
{
    const struct plan_trial *trial = view->trial;
    if (!trial) {
        snprintf(out, size, "trial    %" PRIu32 " of %" PRIu32 " done", view->done, view->total);
        return;
    }
    snprintf(out, size,
             "trial    %" PRIu32 " (%" PRIu32 " of %" PRIu32 " done)   %s, %s   scene %s   attempt %" PRIu32,
             view->trial_index + 1, view->done, view->total, desc->plan->protocol->blocks[trial->block].name,
             plan_trial_kind(trial), trial->scene, view->attempt);
}

static void options_line(const struct desk_desc *desc, const struct machine_view *view, char *out, size_t size)
{
    out[0] = '\0';
    for (int slot = 0; slot < 2 && desc->unblind && view->trial; slot++) {
        int32_t condition = view->trial->option[slot];
        size_t used = strlen(out);
        if (condition >= 0)
            snprintf(out + used, size - used, "%-9s%.40s %.900s\n", plan_slot_name((enum plan_slot)slot),
                     desc->plan->conditions[condition].mode, desc->plan->conditions[condition].parameters);
    }
}

void desk_text(const struct desk_desc *desc, const struct machine_view *view, const struct fovea_use *gaze,
               const struct desk_frames *frames, const char *trouble, char out[DESK_TEXT])
{
    char trial[256], eyes[128], options[2048], times[128] = "frames   none yet";
    trial_line(desc, view, trial, sizeof trial);
    gaze_line(desc, gaze, eyes, sizeof eyes);
    options_line(desc, view, options, sizeof options);
    if (frames->count > 0)
        snprintf(times, sizeof times, "frames   %.1f ms median, %.1f ms p99, %" PRIu64 " of %" PRIu64 " late%s",
                 frames->p50_ms, frames->p99_ms, frames->late, frames->count,
                 desc->refresh_hz > 0.0 ? "" : " (refresh rate not known)");
    snprintf(out, DESK_TEXT, "%s, participant %s (number %" PRIu32 ")   %s\n%s\n%s\n%s\n%s%s%s%s",
             desc->plan->protocol->name, desc->participant, desc->plan->number + 1,
             machine_screen_name(view->screen), trial, eyes, times, options, trouble ? "TROUBLE  " : "",
             trouble ? trouble : "", trouble ? "\n" : "");
}

void desk_say(struct desk *desk, const char *sentence)
{
    if (desk->lines > 0)
        fprintf(desk->desc.out, "\033[%dA", desk->lines);
    fprintf(desk->desc.out, "\033[0J%s\n", sentence);
    desk->lines = 0;
    desk->shown = false;
}

void desk_show(struct desk *desk, int64_t now_ns, const struct machine_view *view, const struct fovea_use *gaze,
               const char *trouble)
{
    char text[DESK_TEXT];
    if (desk->shown && now_ns - desk->shown_ns < DESK_INTERVAL_NS && view->screen != MACHINE_END)
        return;
    const struct desk_frames frames = summarise(desk);
    desk_text(&desk->desc, view, gaze, &frames, trouble, text);
    if (desk->lines > 0)
        fprintf(desk->desc.out, "\033[%dA", desk->lines); // back up over the panel before
    desk->lines = 1;
    for (char *line = text, *end; *line; line = end + (*end == '\n')) {
        end = line + strcspn(line, "\n");
        fprintf(desk->desc.out, "\033[2K%.*s\n", (int)(end - line), line);
        desk->lines++;
    }
    if (desk->noting)
        fprintf(desk->desc.out, "\033[2Knote: %.*s_   (Enter stores it, Escape drops it)\n\033[0J",
                (int)desk->note_length, desk->note);
    else
        fprintf(desk->desc.out, "\033[2K%s\n\033[0J",
                view->screen == MACHINE_ABORT ? "end the session?   y yes   n no"
                                              : "s start   p pause   a end   f flag the trial as bad   n note");
    fflush(desk->desc.out);
    desk->shown = true;
    desk->shown_ns = now_ns;
}
