#include "app/fovstudy/run_file.h"

#include "studies/protocol/text.h"
#include "studies/store/read.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SHA256_SHOWN = 12 }; // digits, as `fovstudy check` shows them

// The protocols of a file's sessions against the one that is to run.
struct protocols {
    const struct protocol *wanted;
    const char *scenes; // what is to be shown, as store_session_row has it
    bool found, same_scenes, same_name;
    char shown[1024]; // of the last session of the same protocol
    char name[PROTOCOL_NAME],
        sha256[SHA256_HEX]; // of the last one; of one with the wanted name, where there is
};

// Whether two such texts name the same scenes, wherever the files lie.
static bool same_scenes(const char *a, const char *b)
{
    char without[2][2048];
    const char *const texts[2] = {a, b};
    for (int i = 0; i < 2; i++) {
        size_t used = 0, word = 0;
        for (const char *c = texts[i]; *c && used + 1 < sizeof without[i]; c++) {
            if (*c == '/') {
                used = word; // what came before was a folder
                continue;
            }
            without[i][used++] = *c;
            word = *c == ' ' ? used : word;
        }
        without[i][used] = '\0';
    }
    return strcmp(without[0], without[1]) == 0;
}

static bool take_protocol(void *user, const struct store_session_row *row)
{
    struct protocols *protocols = user;
    bool same_name = strcmp(row->protocol_name, protocols->wanted->name) == 0;
    if (strcmp(row->protocol_sha256, protocols->wanted->sha256_hex) == 0) {
        protocols->found = true;
        protocols->same_scenes = same_scenes(row->scenes, protocols->scenes);
        snprintf(protocols->shown, sizeof protocols->shown, "%s", row->scenes);
    }
    if (same_name || !protocols->same_name) {
        snprintf(protocols->name, sizeof protocols->name, "%s", row->protocol_name);
        snprintf(protocols->sha256, sizeof protocols->sha256, "%s", row->protocol_sha256);
    }
    protocols->same_name = protocols->same_name || same_name;
    return !protocols->same_scenes;
}

static void say_difference(const struct run_options *options, const struct protocols *protocols, char *error,
                           size_t error_size)
{
    const struct protocol *wanted = protocols->wanted;
    static const char way[] =
        "one file is one study: give another --db, or --new-protocol to keep both in this "
        "file, which is logged";
    if (protocols->found)
        snprintf(error, error_size,
                 "%s: its sessions showed other scenes (%s) than this one would (%s); one study shows "
                 "everybody the same: "
                 "bind the same with --scene, or give --new-protocol to go on, which is logged",
                 options->database, protocols->shown, protocols->scenes);
    else if (protocols->same_name)
        snprintf(error, error_size,
                 "%s: its sessions are of protocol '%s' with another text (%.*s) than %s has now (%.*s); %s",
                 options->database, protocols->name, SHA256_SHOWN, protocols->sha256, options->protocol,
                 SHA256_SHOWN, wanted->sha256_hex, way);
    else
        snprintf(error, error_size, "%s: its sessions are of another protocol, '%s', and %s is '%s'; %s",
                 options->database, protocols->name, options->protocol, wanted->name, way);
}

// "town: town:triangles=200000, ..."; NULL where memory ran out.
static char *scenes_text(const struct run_options *options, const struct protocol *protocol)
{
    struct text text = {0};
    for (uint32_t i = 0; i < protocol->scene_count; i++)
        text_add(&text, "%s%s: %s", i ? ", " : "", protocol->scenes[i],
                 study_shown_scene(protocol, i, options->scenes, options->scene_count));
    return text_take(&text);
}

bool run_file_protocol(const struct run_options *options, const struct protocol *protocol, char *error,
                       size_t error_size)
{
    char *scenes = scenes_text(options, protocol);
    if (!scenes) {
        snprintf(error, error_size, "out of memory");
        return false;
    }
    struct protocols protocols = {.wanted = protocol, .scenes = scenes};
    struct store_reader *reader = store_reader_open(options->database, error, error_size);
    if (!reader) {
        free(scenes);
        return false;
    }
    bool read = store_read_sessions(reader, take_protocol, &protocols) || protocols.same_scenes;
    if (!read)
        snprintf(error, error_size, "%s", store_reader_error(reader));
    store_reader_close(reader);
    bool differs = read && !protocols.same_scenes && protocols.name[0];
    if (differs)
        say_difference(options, &protocols, error, error_size);
    free(scenes);
    return read && !differs;
}

// What a session is shown on, where frames are drawn.
struct screen {
    const char *sha256;
    double refresh_hz, width_px, height_px, fov_deg; // of this run; 0: nothing is drawn
    int64_t other;                                   // a session that was shown otherwise; 0: none
    char was[128];
};

static void screen_text(double refresh_hz, double width_px, double height_px, double fov_deg, char out[128])
{
    snprintf(out, 128, "%g x %g px at %.6g Hz, %.6g degrees high", width_px, height_px, refresh_hz, fov_deg);
}

static bool take_screen(void *user, const struct store_session_row *row)
{
    struct screen *screen = user;
    char now[128], was[128];
    if (strcmp(row->protocol_sha256, screen->sha256) != 0 || isnan(row->width_px))
        return true;
    screen_text(screen->refresh_hz, screen->width_px, screen->height_px, screen->fov_deg, now);
    screen_text(row->refresh_hz, row->width_px, row->height_px, row->fov_deg, was);
    if (strcmp(now, was) == 0)
        return true;
    screen->other = row->id;
    memcpy(screen->was, was, sizeof was);
    return false;
}

void run_file_remark(const struct run_options *options, const struct protocol *protocol,
                     const struct run_view *view)
{
    char unused[256], now[128];
    if (!view->display)
        return;
    struct screen screen = {.sha256 = protocol->sha256_hex,
                            .refresh_hz = view->display->refresh_hz,
                            .width_px = view->display->width,
                            .height_px = view->display->height,
                            .fov_deg = options->fov_deg};
    struct store_reader *reader = store_reader_open(options->database, unused, sizeof unused);
    if (reader)
        store_read_sessions(reader, take_screen, &screen); // what cannot be read was said before
    store_reader_close(reader);
    screen_text(screen.refresh_hz, screen.width_px, screen.height_px, screen.fov_deg, now);
    if (screen.other)
        fprintf(stderr,
                "fovstudy: remark: session %" PRId64 " of this study was shown on %s; this one is on %s, and "
                "the analysis pools them\n",
                screen.other, screen.was, now);
}

void run_file_code(uint64_t i, char out[RUN_CODE])
{
    snprintf(out, RUN_CODE, "S%03" PRIu64, i);
}

// Of each code whether it has a complete session of the protocol, and one that is not.
struct codes {
    const char *sha256;
    uint64_t count;
    bool *complete;
    bool unfinished[RUN_PARTICIPANTS + 1];
};

static bool take_code(void *user, const struct store_session_row *row)
{
    struct codes *codes = user;
    char code[RUN_CODE];
    uint64_t i = 1;
    for (; i <= codes->count; i++) {
        run_file_code(i, code);
        if (strcmp(code, row->code) == 0)
            break;
    }
    if (i > codes->count || strcmp(row->protocol_sha256, codes->sha256) != 0)
        return true;
    bool complete = strcmp(row->status, "complete") == 0;
    codes->unfinished[i] = codes->unfinished[i] || !complete;
    codes->complete[i] = !codes->unfinished[i];
    return true;
}

uint64_t run_file_complete(const struct run_options *options, const char *sha256,
                           bool out_complete[RUN_PARTICIPANTS + 1])
{
    char unused[256];
    struct codes codes = {.sha256 = sha256, .count = options->participants, .complete = out_complete};
    memset(out_complete, 0, (RUN_PARTICIPANTS + 1) * sizeof *out_complete);
    struct store_reader *reader = access(options->database, F_OK) == 0
                                      ? store_reader_open(options->database, unused, sizeof unused)
                                      : NULL;
    if (reader && !store_read_sessions(reader, take_code, &codes))
        memset(out_complete, 0, (RUN_PARTICIPANTS + 1) * sizeof *out_complete);
    store_reader_close(reader);
    uint64_t found = 0;
    for (uint64_t i = 1; i <= options->participants; i++)
        found += out_complete[i];
    return found;
}
