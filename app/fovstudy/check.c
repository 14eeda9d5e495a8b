// `fovstudy check`: reads a protocol as `run` would and says what it comes to: a participant's exact trials,
// the balance over all of them, how long it takes, what it can show. No GPU, nothing written.
#include "app/command/options.h"
#include "app/fovstudy/catalogue.h"
#include "app/fovstudy/check_figures.h"
#include "app/fovstudy/check_number.h"
#include "app/fovstudy/check_report.h"
#include "app/fovstudy/check_scenes.h"
#include "app/fovstudy/commands.h"
#include "app/fovstudy/run_options.h"
#include "studies/engine/plan.h"
#include "studies/store/store.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum option { PARTICIPANT, DB, NUMBER, SEED, SCENE, SCENES, COUNTS, JSON, OPTIONS };
enum {
    PARTICIPANTS = 20, // as language.c says of a file without 'participants'
    MANY = 5000,       // counting them takes a second or more
};

static const struct option_spec specs[OPTIONS + 1] = {
    [PARTICIPANT] = {"participant", "CODE", "the trials of this participant of --db, or of a new one"},
    [DB] = {"db", "FILE", "the study file that knows the participants' numbers; without it CODE is the first"},
    [NUMBER] = {"number", "N", "the trials of participant number N, from 1 (default 1)"},
    [SEED] = {"seed", "N", "instead of the protocol's seed"},
    [SCENE] = {"scene", "NAME=SPEC", "as for run: a name the protocol may use; repeatable"},
    [SCENES] = {"scenes", NULL, "load the files bound with --scene, to see their camera paths; may take long"},
    [COUNTS] = {"counts", "N",
                "balance and planned tests over participants 1 to N, not the file's 'participants'"},
    [JSON] = {"json", NULL, "print JSON"},
    [OPTIONS] = {NULL, NULL, NULL},
};

struct request {
    const char *protocol, *participant, *database;
    uint64_t number, seed, counts;
    bool has_number, has_seed, load, json;
    struct bound_scene scenes[STUDY_BOUND_SCENES];
    size_t scene_count;
};

static int set(struct request *out, int option, const char *value)
{
    char error[256];
    switch (option) {
    case OPTIONS_WORD:
        if (out->protocol)
            return options_wrong("fovstudy check", "one protocol at a time, not also '%s'", value);
        out->protocol = value;
        return -1;
    case PARTICIPANT:
        out->participant = value;
        return run_options_code("fovstudy check", value);
    case DB:
        out->database = value;
        return -1;
    case NUMBER:
        out->has_number = options_uint64(value, 1, 1000000, &out->number);
        return out->has_number
                   ? -1
                   : options_wrong("fovstudy check", "--number '%s' is no number from 1 to 1000000", value);
    case SEED:
        out->has_seed = options_uint64(value, 0, INT64_MAX, &out->seed);
        return out->has_seed
                   ? -1
                   : options_wrong("fovstudy check", "--seed '%s' is no number from 0 to 2^63-1", value);
    case COUNTS:
        return options_uint64(value, 1, 100000, &out->counts)
                   ? -1
                   : options_wrong("fovstudy check", "--counts '%s' is no number from 1 to 100000", value);
    case SCENE:
        return study_bind_scene(out->scenes, &out->scene_count, value, error, sizeof error)
                   ? -1
                   : options_wrong("fovstudy check", "%s", error);
    case SCENES:
        out->load = true;
        return -1;
    default:
        out->json = true;
        return -1;
    }
}

static int read_request(struct request *out, int argc, char **argv)
{
    struct options options;
    *out = (struct request){.number = 1};
    options_start(&options, argc, argv, "fovstudy check", specs);
    for (int i = options_next(&options); i != OPTIONS_DONE; i = options_next(&options)) {
        if (i == OPTIONS_HELP) {
            options_help(
                stdout,
                "fovstudy check PROTOCOL [--participant CODE --db FILE | --number N] [--counts N] [--json]",
                "Checks a protocol; prints a participant's trials in their order, the balance over all "
                "participants, the "
                "expected duration, the smallest effects that the tests of fovstats planned find, and what "
                "seems odd.",
                specs);
            return EXIT_DONE;
        }
        if (i == OPTIONS_ERROR)
            return EXIT_USAGE;
        int status = set(out, i, options.value);
        if (status >= 0)
            return status;
    }
    if (!out->protocol)
        return options_wrong("fovstudy check", "which protocol? name its file");
    return -1;
}

// The number that the study file gives this participant, unless the command line did.
static bool look_up(struct request *request)
{
    char error[STORE_ERROR_SIZE];
    if (request->participant && !request->database && !request->has_number)
        fprintf(stderr,
                "fovstudy: without --db nothing is known of %s; these are the first participant's trials\n",
                request->participant);
    if (!request->participant || !request->database || request->has_number)
        return true;
    bool found = check_number(request->database, request->participant, &request->number, error, sizeof error);
    if (!found)
        fprintf(stderr, "fovstudy: %s\n", error);
    return found;
}

// Remarks of the file itself, and of its scenes.
static char *gather_remarks(const struct request *request, const struct protocol *protocol,
                            const struct check_analyses *analyses, char *error, size_t error_size)
{
    struct text remarks = {0};
    for (uint32_t i = 0; i < protocol->remark_count; i++)
        text_add(&remarks, "%s\n", protocol->remarks[i]);
    bool ok = check_scenes(request->protocol, protocol, request->scenes, request->scene_count, request->load,
                           &remarks, error, error_size);
    check_figures_remarks(&remarks, request->protocol, analyses);
    char *all = text_take(&remarks);
    if (ok && !all)
        snprintf(error, error_size, "out of memory");
    if (ok)
        return all;
    free(all);
    return NULL;
}

// What takes long, on a terminal; NULL: nothing any more.
static void progress(const struct check_report *report, const char *what)
{
    if (report->people >= MANY && isatty(STDERR_FILENO))
        fprintf(stderr, "\r\033[K%s%s", what ? what : "", what ? " of all participants ..." : "");
}

static bool print(const struct request *request, const struct check_report *report)
{
    char *text = request->json ? check_report_json(report) : check_report_text(report);
    progress(report, NULL);
    if (text)
        fputs(text, stdout);
    bool done = text != NULL;
    free(text);
    return done;
}

static bool examine(const struct request *request, const struct protocol *protocol)
{
    char error[PROTOCOL_ERROR] = "out of memory";
    struct check_report report = {.protocol = protocol,
                                  .seed = request->has_seed ? request->seed : protocol->seed,
                                  .people = request->counts          ? (uint32_t)request->counts
                                            : protocol->participants ? protocol->participants
                                                                     : PARTICIPANTS,
                                  .people_assumed = !request->counts && !protocol->participants};
    struct plan *plan = plan_create(protocol, report.seed, (uint32_t)(request->number - 1));
    progress(&report, "the planned tests");
    bool done = false,
         planned = plan && check_analyses_init(&report.analyses, protocol, report.seed, report.people);
    char *remarks = planned ? gather_remarks(request, protocol, &report.analyses, error, sizeof error) : NULL;
    if (remarks) {
        report.plan = plan;
        report.remarks = remarks;
        observer_defaults(&report.pace);
        duration_of(plan, &report.pace, &report.duration);
        progress(&report, "the orders");
        done = plan_carry_over(protocol, report.seed, 0, report.people, report.carry);
        progress(&report, "the balance");
        done = done && print(request, &report);
    }
    check_analyses_finish(&report.analyses);
    if (!done)
        fprintf(stderr, "fovstudy: %s\n", error);
    free(remarks);
    plan_destroy(plan);
    return done;
}

int command_check(int argc, char **argv)
{
    struct request request;
    struct study_names names;
    char error[PROTOCOL_ERROR];
    int status = read_request(&request, argc, argv);
    if (status >= 0)
        return status;
    if (!study_names_init(&names, request.scenes, request.scene_count)) {
        fprintf(stderr, "fovstudy: out of memory\n");
        return EXIT_FAILED;
    }
    struct protocol *protocol =
        study_load(request.protocol, &names, request.scenes, request.scene_count, error, sizeof error);
    if (!protocol)
        fprintf(stderr, "fovstudy: %s\n", error);
    bool done = protocol && look_up(&request) && examine(&request, protocol);
    protocol_destroy(protocol);
    study_names_finish(&names);
    return done ? EXIT_DONE : EXIT_FAILED;
}
