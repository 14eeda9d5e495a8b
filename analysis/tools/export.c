#define _XOPEN_SOURCE 700 // nftw

#include "analysis/tools/arguments.h"
#include "analysis/tools/json.h"
#include "analysis/tools/psych_ds.h"

#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char help[] =
    "usage: fovstats export DB -o DIR [--simulated] [--json]\n"
    "\n"
    "Writes a study file as a Psych-DS dataset: tidy CSV tables in DIR/data and their dictionary, with units "
    "and\n"
    "frames of reference, in DIR/dataset_description.json. Several files: fovstats merge first, which counts "
    "no\n"
    "session twice.\n"
    "  -o DIR       must not exist; written whole or not at all\n"
    "  --simulated  export simulated sessions, which are refused otherwise; names and description are branded\n"
    "  --json       one object with the counts\n";

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

// Beside itself as "DIR.part" and renamed.
static bool write_beside(struct store_reader *reader, const char *folder, char *error, size_t error_size)
{
    char part[768]; // fits a sentence
    if (snprintf(part, sizeof part, "%s.part", folder) >= (int)sizeof part) {
        snprintf(error, error_size, "%s: the name is too long", folder);
        return false;
    }
    remove_folder(part); // of an export that was interrupted
    if (mkdir(part, 0777) != 0) {
        snprintf(error, error_size, "%s: cannot be made: %s", part, strerror(errno));
        return false;
    }
    bool ok = psych_ds_write(reader, part, error, error_size);
    if (ok && rename(part, folder) != 0) {
        snprintf(error, error_size, "%s: cannot be made: %s", folder, strerror(errno));
        ok = false;
    }
    if (!ok)
        remove_folder(part);
    return ok;
}

static int export_file(const struct command *command, struct store_reader *reader, const char *folder,
                       bool simulated, bool json)
{
    char error[1024] = "not enough memory";
    struct found found = {0};
    if (!store_read_sessions(reader, look, &found))
        return command_fail(command, EXIT_FAILED, "%s", store_reader_error(reader));
    if (found.sessions == 0)
        return command_fail(command, EXIT_FAILED, "%s: the study is empty: no session was recorded",
                            store_reader_path(reader));
    if (found.simulated != simulated)
        return command_fail(command, EXIT_FAILED,
                            simulated ? "%s: there is no simulated session in it; leave --simulated out"
                                      : "%s: only simulated sessions are in it; add --simulated to export them",
                            store_reader_path(reader));
    if (!write_beside(reader, folder, error, sizeof error))
        return command_fail(command, EXIT_FAILED, "%s", error);
    if (json) {
        struct json out = {stdout, false};
        json_open(&out, NULL, '{');
        json_bool(&out, "simulated", simulated);
        json_integer(&out, "sessions", found.sessions);
        json_close(&out, '}');
        putchar('\n');
    } else {
        printf("%s%s: %lld sessions\n", simulated ? "SIMULATED DATA. " : "", folder, (long long)found.sessions);
    }
    return command_finish(command);
}

static int run(const struct command *command, int argc, char **argv)
{
    const char *folder = NULL;
    bool simulated = false, json = false;
    const struct option options[] = {
        {"-o", OPTION_TEXT, &folder}, {"--simulated", OPTION_FLAG, &simulated}, {"--json", OPTION_FLAG, &json}};
    int count = 0;
    int code = arguments_parse(command, argc, argv, options, sizeof options / sizeof options[0], &count);
    if (code >= 0)
        return code;
    if (count != 1)
        return command_fail(command, EXIT_USAGE,
                            "needs one study file; join several with fovstats merge first");
    if (!folder)
        return command_fail(command, EXIT_USAGE, "needs -o DIR");
    if (access(folder, F_OK) == 0)
        return command_fail(command, EXIT_FAILED, "%s: exists already; give a new name", folder);
    char error[1024];
    struct store_reader *reader = store_reader_open(argv[0], error, sizeof error);
    if (!reader)
        return command_fail(command, EXIT_FAILED, "%s", error);
    code = export_file(command, reader, folder, simulated, json);
    store_reader_close(reader);
    return code;
}

const struct command command_export = {"export", "a Psych-DS dataset: CSV tables and their dictionary", help,
                                       run};
