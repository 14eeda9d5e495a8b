#define _XOPEN_SOURCE 700 // nftw

#include "analysis/tools/arguments.h"
#include "analysis/tools/bids.h"
#include "analysis/tools/json.h"
#include "analysis/tools/labs.h"
#include "analysis/tools/psych_ds.h"

#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char help[] =
    "usage: fovstats export DB... [--lab NAME=DB]... -o DIR [--format both|psych-ds|bids] [--simulated]\n"
    "                       [--json]\n"
    "\n"
    "Writes a study as datasets that other programs read:\n"
    "  psych-ds  tidy CSV tables of everything in data, their dictionary, with units and frames of reference, "
    "in\n"
    "            dataset_description.json (Psych-DS 1.4.0)\n"
    "  bids      answers, what was shown when, samples of the eye tracker, fixations and saccades, by "
    "subject,\n"
    "            session and run (BIDS 1.11.1, Eye-Tracking-BIDS)\n"
    "What rules take out stays in both; its rows say so (excluded). BIDS has no frames, checks of the tracker, "
    "notes\n"
    "and other events, image errors, nor the protocol's text.\n"
    "Several files are joined as fovstats merge joins them: a session that is in several of them counts once.\n"
    "  --lab NAME=DB    a file whose participants become NAME-CODE\n"
    "  -o DIR           must not exist; written whole or not at all\n"
    "  --format F       both (default): in DIR/psych-ds and DIR/bids; else DIR is the dataset\n"
    "  --new-protocol   sessions of several protocols may be in the files that are joined\n"
    "  --simulated      export simulated sessions, which are refused otherwise; names and description are "
    "branded\n"
    "  --json           one object with the counts\n";

struct job {
    const struct command *command;
    struct store_merge_input *inputs; // the files
    size_t input_count;
    const char *folder, *format;
    bool psych_ds, bids;
    bool new_protocol, simulated, json;
    char part[768]; // fits a sentence
    char error[1024];
    struct bids_counts counts;
    int64_t sessions;
};

struct found {
    int64_t sessions;
    bool simulated;
};

static bool look(void *user, const struct store_session_row *row)
{
    struct found *found = user;
    found->sessions++;
    found->simulated = found->simulated || row->simulated;
    return true;
}

static int remove_one(const char *path, const struct stat *info, int type, struct FTW *place)
{
    (void)info;
    (void)type;
    (void)place;
    return remove(path);
}

static void remove_folder(const char *path)
{
    nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

static bool fail(struct job *job, const char *path, const char *what)
{
    snprintf(job->error, sizeof job->error, "%.700s: %s", path, what);
    return false;
}

static void say(void *user, const char *sentence)
{
    const struct job *job = user;
    fprintf(stderr, "fovstats %s: %s\n", job->command->name, sentence);
}

static bool joins(const struct job *job)
{
    return job->input_count > 1 || job->inputs[0].lab;
}

// The one file, or all of them joined in the folder that is being written.
static struct store_reader *open_study(struct job *job, const char *merged)
{
    if (!joins(job))
        return store_reader_open(job->inputs[0].path, job->error, sizeof job->error);
    struct store_merge_desc desc = {.inputs = job->inputs,
                                    .input_count = job->input_count,
                                    .output = merged,
                                    .new_protocol = job->new_protocol,
                                    .say = say,
                                    .user = job};
    struct store_merge_counts counts;
    bool ok = store_merge(&desc, &counts, job->error, sizeof job->error);
    return ok ? store_reader_open(merged, job->error, sizeof job->error) : NULL;
}

static bool check(struct job *job, struct store_reader *reader)
{
    const char *name = job->inputs[0].path;
    struct found found = {0};
    if (!store_reader_whole(reader, true) || !store_read_sessions(reader, look, &found)) {
        snprintf(job->error, sizeof job->error, "%s", store_reader_error(reader));
        return false;
    }
    job->sessions = found.sessions;
    if (found.sessions == 0)
        return fail(job, name, "the study is empty: no session was recorded");
    if (found.simulated != job->simulated)
        return fail(job, name,
                    job->simulated ? "there is no simulated session in it; leave --simulated out"
                                   : "only simulated sessions are in it; add --simulated to export them");
    return true;
}

// One dataset, in the folder itself or in a folder within.
static bool write_set(struct job *job, struct store_reader *reader, bool bids)
{
    char path[800];
    bool both = job->psych_ds && job->bids;
    snprintf(path, sizeof path, "%s%s", job->part, !both ? "" : bids ? "/bids" : "/psych-ds");
    if (both && mkdir(path, 0777) != 0)
        return fail(job, path, strerror(errno));
    return bids ? bids_write(reader, path, &job->counts, job->error, sizeof job->error)
                : psych_ds_write(reader, path, job->error, sizeof job->error);
}

static bool write_sets(struct job *job)
{
    char merged[800];
    snprintf(merged, sizeof merged, "%s/merged.db", job->part);
    struct store_reader *reader = open_study(job, merged);
    bool ok = reader && check(job, reader) && (!job->psych_ds || write_set(job, reader, false)) &&
              (!job->bids || write_set(job, reader, true));
    store_reader_close(reader);
    if (ok && joins(job) && remove(merged) != 0)
        ok = fail(job, merged, strerror(errno));
    return ok;
}

// Beside itself as "DIR.part" and renamed.
static bool write_beside(struct job *job)
{
    if (snprintf(job->part, sizeof job->part, "%s.part", job->folder) >= (int)sizeof job->part)
        return fail(job, job->folder, "the name is too long");
    remove_folder(job->part); // of an export that was interrupted
    if (mkdir(job->part, 0777) != 0) {
        snprintf(job->error, sizeof job->error, "%s: cannot be made: %s", job->part, strerror(errno));
        return false;
    }
    bool ok = write_sets(job);
    if (ok && rename(job->part, job->folder) != 0) {
        snprintf(job->error, sizeof job->error, "%.700s: cannot be made: %s", job->folder, strerror(errno));
        ok = false;
    }
    if (!ok)
        remove_folder(job->part);
    return ok;
}

static int print_json(const struct job *job)
{
    struct json out = {stdout, false};
    json_open(&out, NULL, '{');
    json_bool(&out, "simulated", job->simulated);
    json_text(&out, "format", job->format);
    json_integer(&out, "sessions", job->sessions);
    if (job->bids) {
        json_integer(&out, "recordings", job->counts.recordings);
        json_integer(&out, "gaze_samples", job->counts.samples);
        json_integer(&out, "gaze_samples_without_rate", job->counts.samples_without_rate);
    }
    json_close(&out, '}');
    putchar('\n');
    return command_finish(job->command);
}

static int print_text(const struct job *job)
{
    printf("%s%s: %lld %s", job->simulated ? "SIMULATED DATA. " : "", job->folder, (long long)job->sessions,
           job->sessions == 1 ? "session" : "sessions");
    if (job->bids)
        printf(", %lld %s of gaze", (long long)job->counts.recordings,
               job->counts.recordings == 1 ? "recording" : "recordings");
    putchar('\n');
    if (job->counts.samples_without_rate)
        printf("Left out of BIDS, which demands a sampling frequency: %lld samples of gaze of which it cannot "
               "be measured (too few in a row, or not between 10 Hz and 10 kHz).\n",
               (long long)job->counts.samples_without_rate);
    return command_finish(job->command);
}

static int export(struct job *job, int argc, char **argv, char **labs)
{
    const struct command *command = job->command;
    const struct option options[] = {{"-o", OPTION_TEXT, &job->folder},
                                     {"--format", OPTION_TEXT, &job->format},
                                     {"--new-protocol", OPTION_FLAG, &job->new_protocol},
                                     {"--simulated", OPTION_FLAG, &job->simulated},
                                     {"--json", OPTION_FLAG, &job->json}};
    int count = 0, code = labs_take(command, &argc, argv, labs);
    if (code < 0)
        code = arguments_parse(command, argc, argv, options, sizeof options / sizeof options[0], &count);
    if (code >= 0)
        return code;
    for (int i = 0; i < count; i++)
        job->inputs[job->input_count++] = labs_input(argv[i], labs);
    bool both = strcmp(job->format, "both") == 0;
    job->psych_ds = both || strcmp(job->format, "psych-ds") == 0;
    job->bids = both || strcmp(job->format, "bids") == 0;
    if (!job->psych_ds && !job->bids)
        return command_fail(command, EXIT_USAGE, "--format is \"%s\" but must be both, psych-ds or bids",
                            job->format);
    if (count == 0)
        return command_fail(command, EXIT_USAGE, "needs at least one study file; see --help");
    if (!job->folder)
        return command_fail(command, EXIT_USAGE, "needs -o DIR");
    if (access(job->folder, F_OK) == 0)
        return command_fail(command, EXIT_FAILED, "%s: exists already; give a new name", job->folder);
    if (!write_beside(job))
        return command_fail(command, EXIT_FAILED, "%s", job->error);
    return job->json ? print_json(job) : print_text(job);
}

static int run(const struct command *command, int argc, char **argv)
{
    struct job job = {.command = command, .format = "both", .error = "not enough memory"};
    char **labs = calloc((size_t)argc + 1, sizeof *labs);
    job.inputs = calloc((size_t)argc + 1, sizeof *job.inputs);
    int code = labs && job.inputs ? export(&job, argc, argv, labs)
                                  : command_fail(command, EXIT_FAILED, "%s", job.error);
    free(job.inputs);
    free(labs);
    return code;
}

const struct command command_export = {"export", "Psych-DS and BIDS datasets: tables, gaze, dictionaries", help,
                                       run};
