#include "analysis/tools/study_arguments.h"

#include "analysis/report/facts.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

int study_arguments_load(const struct command *command, int argc, char **argv, bool takes_output,
                         struct study_arguments *out, struct sample *out_sample)
{
    return study_arguments_load_with(command, argc, argv, takes_output, NULL, 0, out, out_sample);
}

// By the sixteen bytes that every SQLite file begins with.
static bool is_database(const char *path)
{
    char head[16] = "";
    struct stat info; // a pipe would be waited for
    FILE *file = stat(path, &info) == 0 && S_ISREG(info.st_mode) ? fopen(path, "rb") : NULL;
    if (!file)
        return false;
    size_t size = fread(head, 1, sizeof head, file);
    fclose(file);
    return size == sizeof head && memcmp(head, "SQLite format 3", sizeof head) == 0;
}

int study_arguments_load_with(const struct command *command, int argc, char **argv, bool takes_output,
                              const struct option *own, size_t own_count, struct study_arguments *out,
                              struct sample *out_sample)
{
    *out = (struct study_arguments){.conf = 0.95};
    struct option options[4 + STUDY_OPTIONS] = {{"--simulated", OPTION_FLAG, &out->simulated},
                                                {"--protocol", OPTION_TEXT, &out->protocol},
                                                {"--conf", OPTION_NUMBER, &out->conf},
                                                takes_output
                                                    ? (struct option){"-o", OPTION_TEXT, &out->output}
                                                    : (struct option){"--json", OPTION_FLAG, &out->json}};
    for (size_t i = 0; i < own_count && i < STUDY_OPTIONS; i++)
        options[4 + i] = own[i];
    int count = 0, code = arguments_parse(command, argc, argv, options, 4 + own_count, &count);
    if (code >= 0)
        return code;
    if (count == 0)
        return command_fail(command, EXIT_USAGE, "needs at least one study file; see --help");
    if (takes_output && !out->output)
        return command_fail(command, EXIT_USAGE, "needs -o FILE.html");
    if (takes_output && is_database(out->output))
        return command_fail(command, EXIT_USAGE, "-o %s is a study file and would be overwritten; name another",
                            out->output);
    if (!(out->conf > 0 && 1 - out->conf > 0 && 1 - out->conf < 1))
        return command_fail(command, EXIT_USAGE, "--conf is %g but must lie between 0 and 1, for example 0.95",
                            out->conf);
    char error[SAMPLE_ERROR_SIZE];
    if (!sample_load(out_sample, (const char *const *)argv, (size_t)count, out->simulated, out->protocol, error,
                     sizeof error))
        return command_fail(command, EXIT_FAILED, "%s", error);
    return -1;
}

int study_arguments_run(const struct command *command, int argc, char **argv, study_analyse_fn analyse)
{
    struct study_arguments arguments;
    struct sample sample;
    int code = study_arguments_load(command, argc, argv, false, &arguments, &sample);
    if (code >= 0)
        return code;
    code = analyse(command, &arguments, &sample);
    sample_free(&sample);
    return code;
}

static void count_used(const struct sample *sample, int64_t *sessions, int64_t *people)
{
    *sessions = *people = 0;
    for (size_t i = 0; i < sample->session_count; i++) {
        if (sample->sessions[i].excluded)
            continue;
        bool known = false;
        for (size_t j = 0; j < i && !known; j++)
            known = !sample->sessions[j].excluded && sample->sessions[j].person == sample->sessions[i].person;
        *people += !known;
        ++*sessions;
    }
}

void study_title(const struct sample *sample, const char *what)
{
    int64_t sessions, people;
    count_used(sample, &sessions, &people);
    printf("%s%s: %" PRId64 " %s, %" PRId64 " %s\n", sample->simulated ? "SIMULATED DATA. " : "", what, people,
           sample->simulated ? (people == 1 ? "simulated observer" : "simulated observers")
                             : (people == 1 ? "participant" : "participants"),
           sessions, sessions == 1 ? "session" : "sessions");
    printf("Data SHA-256 %s, fovstats " FOVSTUDY_VERSION "\n\n", sample->data_hash);
}

void study_title_json(struct json *json, const struct sample *sample)
{
    int64_t sessions, people;
    count_used(sample, &sessions, &people);
    json_text(json, "data_sha256", sample->data_hash);
    json_text(json, "program", "fovstats " FOVSTUDY_VERSION);
    json_bool(json, "simulated", sample->simulated);
    json_integer(json, "participants", people);
    json_integer(json, "sessions", sessions);
    json_integer(json, "sessions_excluded", (int64_t)sample->session_count - sessions);
    json_integer(json, "sessions_left_out_simulated", (int64_t)sample->left_out_simulated);
    json_text(json, "protocol", sample->protocol);
    json_integer(json, "sessions_left_out_protocol", (int64_t)sample->left_out_protocol);
}

void study_notes(const struct sample *sample)
{
    if (sample->left_out_simulated)
        printf("Left out, simulated sessions (--simulated analyses them): %zu.\n", sample->left_out_simulated);
    if (sample->left_out_protocol)
        printf("Left out, sessions of another protocol than '%s' (--protocol NAME analyses them): %zu.\n",
               sample->protocol, sample->left_out_protocol);
    if (sample_repeaters(sample))
        printf("People with several sessions: %zu.\n", sample_repeaters(sample));
    if (sample_shared_codes(sample))
        printf("Codes that stand in several files: %zu; each file's is taken for another person.\n",
               sample_shared_codes(sample));
    char differing[256];
    if (facts_differing(sample, differing, sizeof differing))
        printf("The sessions differ in: %s. The numbers pool them.\n", differing);
    for (size_t i = 0; i < sample->session_count; i++) {
        const struct sample_session *s = &sample->sessions[i];
        if (s->excluded)
            printf("Left out: session %" PRId64 " of participant %s (excluded).\n", s->id,
                   sample->people[s->person].code);
    }
}
