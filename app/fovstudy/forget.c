// `fovstudy forget`: erases a person's rows from a study file.
#include "studies/store/forget.h"
#include "app/command/options.h"
#include "app/fovstudy/commands.h"
#include "app/session/record.h"

#include <inttypes.h>
#include <stdio.h>

enum option { DB, OPTIONS };

static const struct option_spec specs[OPTIONS + 1] = {
    [DB] = {"db", "FILE", "the study file"},
    [OPTIONS] = {NULL, NULL, NULL},
};

static const char about[] =
    "Erases all that the study file holds of the participant: sessions, trials, answers, gaze, frames, "
    "events,\n"
    "attributes and the code. A tombstone without any of it stays, so that the numbers of the study can be\n"
    "explained; the participant's number may be given again. The file is rewritten, which needs as much room "
    "as\n"
    "it has. Copies, exports and event files are yours to delete.";

static bool forget(const char *database, const char *code, struct store_forgotten *out,
                   struct store_error *error)
{
    struct store_error late;
    char now[RECORD_TIME];
    record_time_utc(now);
    struct store *store = store_open(&(struct store_desc){.path = database, .access = STORE_WRITE}, error);
    if (!store)
        return false;
    bool done = store_forget(store, code, now, out, error) == STORE_OK;
    if (store_close(store, &late) == STORE_OK || !done)
        return done;
    *error = late;
    return false;
}

int command_forget(int argc, char **argv)
{
    struct options options;
    const char *database = NULL, *code = NULL;
    options_start(&options, argc, argv, "fovstudy forget", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(stdout, "fovstudy forget --db FILE CODE", about, specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        if (i == OPTIONS_WORD && code)
            return options_wrong("fovstudy forget", "one participant at a time, not also '%s'", options.value);
        if (i == OPTIONS_WORD)
            code = options.value;
        else
            database = options.value;
    }
    if (!database || !code)
        return options_wrong("fovstudy forget",
                             database ? "whom? name the participant's code" : "of which study? give --db FILE");
    struct store_forgotten gone;
    struct store_error error;
    if (!forget(database, code, &gone, &error)) {
        fprintf(stderr, "fovstudy: %s\n", error.text);
        return EXIT_FAILED;
    }
    const struct {
        int64_t count;
        const char *one, *many;
    } parts[] = {{gone.sessions, "session", "sessions"},
                 {gone.trials, "trial", "trials"},
                 {gone.answers, "answer", "answers"},
                 {gone.frames, "frame", "frames"},
                 {gone.gaze, "gaze sample", "gaze samples"}};
    printf("erased participant %s", code);
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        printf("%s %" PRId64 " %s", i ? "," : ":", parts[i].count,
               parts[i].count == 1 ? parts[i].one : parts[i].many);
    putchar('\n');
    return EXIT_DONE;
}
