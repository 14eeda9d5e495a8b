// `fovstudy exclude`: applies exclusion rules to the sessions that lack them, takes out by hand, lists what is
// out.
#include "app/command/options.h"
#include "app/fovstudy/catalogue.h"
#include "app/fovstudy/commands.h"
#include "app/fovstudy/exclude_list.h"
#include "app/fovstudy/rules.h"
#include "app/session/record.h"
#include "studies/store/exclusions.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum option { DB, PROTOCOL, LIST, PERSON, TRIAL, REASON, BY, JSON, OPTIONS };

static const struct option_spec specs[OPTIONS + 1] = {
    [DB] = {"db", "FILE", "the study file"},
    [PROTOCOL] = {"protocol", "LATER.yaml", "apply the rules of this later file, marked 'late'"},
    [LIST] = {"list", NULL, "only list what is out"},
    [PERSON] = {"person", "CODE", "take this person out by hand; the participant number becomes free again"},
    [TRIAL] = {"trial", "ID", "take this trial out by hand (the id that --list and the report name)"},
    [REASON] = {"reason", "TEXT", "why, with --person or --trial"},
    [BY] = {"by", "NAME", "who decided, with --person or --trial"},
    [JSON] = {"json", NULL, "print JSON"},
    [OPTIONS] = {NULL, NULL, NULL},
};

enum { ERROR_SIZE = 1024, SCENES = 64, SCENE_TEXT = 64 };

struct request {
    const char *database, *protocol, *person, *reason, *by;
    uint64_t trial; // 0: none
    bool list, json;
};

// All that one run needs; each part is freed by finish.
struct work {
    const struct request *request;
    struct store *store;
    struct store_reader *reader;
    struct study_names names;
    struct bound_scene scenes[SCENES]; // the names that the file's protocols had bound
    size_t scene_count;
    struct protocol *later;
    int64_t protocol_id; // of the protocol being applied
    struct rules_session *sessions;
    size_t session_count, capacity;
    size_t added, ruled; // rows, sessions
    char error[ERROR_SIZE];
};

static int set(struct request *out, int option, const char *value)
{
    switch (option) {
    case DB:
        out->database = value;
        return -1;
    case PROTOCOL:
        out->protocol = value;
        return -1;
    case PERSON:
        out->person = value;
        return -1;
    case TRIAL:
        return options_uint64(value, 1, INT64_MAX, &out->trial)
                   ? -1
                   : options_wrong("fovstudy exclude", "--trial '%s' is no trial's id", value);
    case REASON:
        out->reason = value;
        return -1;
    case BY:
        out->by = value;
        return -1;
    case LIST:
        out->list = true;
        return -1;
    case JSON:
        out->json = true;
        return -1;
    default:
        return options_wrong("fovstudy exclude", "'%s' is too much", value);
    }
}

static int read_request(struct request *out, int argc, char **argv)
{
    struct options options;
    *out = (struct request){0};
    options_start(&options, argc, argv, "fovstudy exclude", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(
                stdout,
                "fovstudy exclude --db FILE [--protocol LATER.yaml | --list | (--person CODE | --trial ID) "
                "--reason TEXT --by NAME] [--json]",
                "Applies each session's exclusion rules where that was not done (a session does it when it "
                "ends), and lists what is out and why.",
                specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        int status = set(out, i, options.value);
        if (status >= 0)
            return status;
    }
    bool by_hand = out->person || out->trial;
    if (!out->database)
        return options_wrong("fovstudy exclude", "which study file? give --db FILE");
    if ((out->person && out->trial) || (by_hand && (out->list || out->protocol)) ||
        (out->list && out->protocol))
        return options_wrong("fovstudy exclude", "--protocol, --list, --person and --trial go one at a time");
    if (by_hand && (!out->reason || !out->reason[0] || !out->by || !out->by[0]))
        return options_wrong("fovstudy exclude", "taking out by hand needs --reason TEXT and --by NAME");
    if (!by_hand && (out->reason || out->by))
        return options_wrong("fovstudy exclude", "--reason and --by go with --person or --trial");
    return -1;
}

static bool fail(struct work *work, const char *sentence)
{
    snprintf(work->error, sizeof work->error, "%s", sentence);
    return false;
}

static bool open_file(struct work *work)
{
    struct store_error why = {""};
    work->store =
        store_open(&(struct store_desc){.path = work->request->database, .access = STORE_WRITE}, &why);
    if (!work->store)
        return fail(work, why.text);
    work->reader = store_reader_open(work->request->database, work->error, sizeof work->error);
    return work->reader != NULL;
}

static bool by_hand(struct work *work)
{
    char now[RECORD_TIME];
    struct store_error why = {""};
    const struct request *request = work->request;
    struct store_exclusion row = {
        .rule = "manual", .rule_set = "late", .reason = request->reason, .by = request->by, .applied_at = now};
    record_time_utc(now);
    if (request->person)
        row.participant_id = store_find_participant(work->reader, request->person);
    else
        row.trial_id = store_find_trial(work->reader, (int64_t)request->trial);
    if (row.participant_id == 0 && row.trial_id == 0) {
        if (request->person)
            snprintf(work->error, sizeof work->error, "%s: has no participant '%s'", request->database,
                     request->person);
        else
            snprintf(work->error, sizeof work->error, "%s: has no trial %" PRIu64, request->database,
                     request->trial);
        return false;
    }
    return store_apply_exclusions(work->store, &row, 1, NULL, 0, &work->added, &why) == STORE_OK ||
           fail(work, why.text);
}

// Each scene's name is followed by a line end.
static bool take_scenes(void *user, const struct store_protocol_row *row)
{
    struct work *work = user;
    for (const char *name = row->scenes; *name && work->scene_count < SCENES;) {
        size_t length = strcspn(name, "\n");
        struct bound_scene *scene = &work->scenes[work->scene_count];
        snprintf(scene->name, sizeof scene->name, "%.*s", (int)length, name);
        scene->spec = scene->name;
        work->scene_count += length > 0;
        name += length;
        name += strspn(name, "\n,"); // the store joins with commas
    }
    return true;
}

static bool take_session(void *user, const struct store_ruled_row *row)
{
    struct work *work = user;
    if (row->ruled || row->protocol_id != work->protocol_id)
        return true;
    if (work->session_count == work->capacity) {
        size_t capacity = work->capacity ? 2 * work->capacity : 64;
        struct rules_session *grown = realloc(work->sessions, capacity * sizeof *grown);
        if (!grown)
            return fail(work, "out of memory");
        work->sessions = grown;
        work->capacity = capacity;
    }
    work->sessions[work->session_count++] =
        (struct rules_session){row->session_id, row->segment_id, row->participant_id, row->protocol_id};
    return true;
}

static int by_person(const void *x, const void *y)
{
    const struct rules_session *a = x, *b = y;
    if (a->participant_id != b->participant_id)
        return a->participant_id < b->participant_id ? -1 : 1;
    return (a->session_id > b->session_id) - (a->session_id < b->session_id);
}

// The rules, person by person, to the sessions under work->protocol_id that lack them.
static bool apply(struct work *work, const struct protocol *protocol)
{
    struct rules rules = {.store = work->store,
                          .path = work->request->database,
                          .protocol = protocol,
                          .late = work->later != NULL};
    work->session_count = 0;
    if (!store_read_ruled(work->reader, protocol->sha256_hex, take_session, work))
        return work->error[0] ? false : fail(work, store_reader_error(work->reader));
    if (work->session_count)
        qsort(work->sessions, work->session_count, sizeof *work->sessions, by_person);
    for (size_t i = 0, end = 0; i < work->session_count; i = end) {
        size_t added = 0;
        while (end < work->session_count &&
               work->sessions[end].participant_id == work->sessions[i].participant_id)
            end++;
        if (!rules_apply(&rules, work->reader, &work->sessions[i], end - i, &added, work->error,
                         sizeof work->error))
            return false;
        work->added += added;
        work->ruled += end - i;
    }
    return true;
}

static bool apply_stored(void *user, const struct store_protocol_row *row)
{
    struct work *work = user;
    struct protocol *stored = NULL;
    bool done = false;
    work->protocol_id = row->id;
    if (work->later)
        return strcmp(work->later->name, row->name) != 0 || apply(work, work->later);
    stored = protocol_parse(row->name, row->text, strlen(row->text), &work->names.catalogue, work->error,
                            sizeof work->error);
    done = stored && (stored->exclusion_count == 0 || apply(work, stored));
    protocol_destroy(stored);
    return done;
}

struct same_study {
    const struct protocol *later;
    bool found, planned;
    char name[PROTOCOL_NAME]; // of one that the file has
};

static bool compare_study(void *user, const struct store_protocol_row *row)
{
    struct same_study *same = user;
    same->found = same->found || strcmp(row->name, same->later->name) == 0;
    same->planned = same->planned || strcmp(row->sha256, same->later->sha256_hex) == 0;
    snprintf(same->name, sizeof same->name, "%s", row->name);
    return true;
}

static bool load_later(struct work *work)
{
    const char *path = work->request->protocol;
    work->later = study_load(path, &work->names, NULL, 0, work->error, sizeof work->error);
    if (!work->later)
        return false;
    struct same_study same = {.later = work->later};
    if (!store_read_protocols(work->reader, compare_study, &same))
        return fail(work, store_reader_error(work->reader));
    if (!same.found)
        snprintf(work->error, sizeof work->error,
                 "%s: is the study '%s', and %s holds '%s'; name a later file of it", path, work->later->name,
                 work->request->database, same.name);
    else if (same.planned)
        snprintf(work->error, sizeof work->error,
                 "%s: is what sessions ran with, so its rules are planned ones; leave --protocol out", path);
    for (uint32_t i = 0; i < work->later->exclusion_count && !work->request->json; i++)
        if (work->later->exclusions[i].stricter) {
            fprintf(
                stderr,
                "fovstudy: rules of the set 'stricter' are left away: a late rule is applied or it is not\n");
            break;
        }
    return same.found && !same.planned;
}

static bool apply_all(struct work *work)
{
    if (!store_read_protocols(work->reader, take_scenes, work))
        return fail(work, store_reader_error(work->reader));
    if (!study_names_init(&work->names, work->scenes, work->scene_count))
        return fail(work, "out of memory");
    if (work->request->protocol && !load_later(work))
        return false;
    return store_read_protocols(work->reader, apply_stored, work) ||
           (work->error[0] ? false : fail(work, store_reader_error(work->reader)));
}

static bool finish(struct work *work, bool done)
{
    struct store_error why = {""};
    store_reader_close(work->reader);
    protocol_destroy(work->later);
    study_names_finish(&work->names);
    free(work->sessions);
    if (work->store && store_close(work->store, &why) != STORE_OK && done)
        return fail(work, why.text);
    return done;
}

static void say(const struct work *work)
{
    if (work->request->person || work->request->trial)
        puts(work->added ? "1 taken out.\n" : "It was out by hand already; nothing changed.\n");
    else
        printf("The %srules were applied to %zu session%s that lacked them: %zu taken out.\n\n",
               work->request->protocol ? "late " : "", work->ruled, work->ruled == 1 ? "" : "s", work->added);
}

int command_exclude(int argc, char **argv)
{
    struct request request;
    struct work work = {.request = &request};
    int status = read_request(&request, argc, argv);
    if (status >= 0)
        return status;
    bool done = true;
    if (!request.list) {
        done = open_file(&work) && (request.person || request.trial ? by_hand(&work) : apply_all(&work));
        done = finish(&work, done);
    }
    if (done && request.json)
        printf("{\"added\":%zu,\"sessions_ruled\":%zu,\"exclusions\":", work.added, work.ruled);
    else if (done && !request.list)
        say(&work);
    done = done && exclude_list(request.database, request.json, work.error, sizeof work.error);
    if (done && request.json)
        puts("}");
    if (!done)
        fprintf(stderr, "fovstudy: %s\n", work.error);
    return done && fflush(stdout) == 0 ? EXIT_DONE : EXIT_FAILED;
}
