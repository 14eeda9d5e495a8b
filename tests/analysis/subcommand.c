#include "subcommand.h"

#include "said.h"

#include <ctype.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include <cmocka.h>

#define countof(array) (sizeof(array) / sizeof(array)[0])

// The subcommand's name and what stands behind the study; `json` where it prints a table.
static const struct {
    const char *words[6];
    bool json;
} subcommands[SUBCOMMANDS] = {
    [CHOICES] = {{"choices"}, true},
    [RATINGS] = {{"ratings"}, true},
    [ANOVA] = {{"anova"}, true},
    [THRESHOLDS] = {{"thresholds", "--bootstrap", "0"}, true},
    [JOD] = {{"jod"}, true},
    [FRAMES] = {{"frames"}, true},
    [AUDIT] = {{"frames", "--audit"}, true},
    [GAZE] = {{"gaze"}, true},
    [EVENTS] = {{"gaze", "--events"}, true},
    [PLANNED] = {{"planned"}, true},
    [POWER] = {{"power", "--share", "0.7", "--participants", "5"}, true},
    [REPORT] = {{"report", "-o", "out.html"}, false},
    [MERGE] = {{"merge", "-o", "out.db"}, true},
    [EXPORT] = {{"export", "-o", "out"}, true},
};

const char *subcommand_name(enum subcommand subcommand)
{
    return subcommands[subcommand].words[0];
}

struct program_result subcommand_run(enum subcommand subcommand, const char *path, const char *more,
                                     const char *most)
{
    static const char *const remove[] = {"/bin/rm", "-rf", "out.html", "out.db", "out", NULL};
    const char *argv[12] = {SUBCOMMAND_FOVSTATS, subcommand_name(subcommand), path};
    int count = 3;
    for (int i = 1; subcommands[subcommand].words[i]; i++)
        argv[count++] = subcommands[subcommand].words[i];
    argv[count++] = more;
    argv[count] = more ? most : NULL;
    struct program_result removed = program_run(remove, NULL);
    program_free(&removed);
    return program_run(argv, NULL);
}

void subcommand_fails(enum subcommand subcommand, const char *path, const char *sentence)
{
    static const char *const outputs[] = {"out.html",      "out.db",      "out",
                                          "out.html.part", "out.db.part", "out.part"};
    char whole[256];
    snprintf(whole, sizeof whole, "fovstats %s: %s", subcommand_name(subcommand), sentence);
    said_sentence(subcommand_run(subcommand, path, NULL, NULL), 1, whole);
    for (size_t i = 0; i < countof(outputs); i++)
        if (access(outputs[i], F_OK) == 0)
            fail_msg("%s %s left %s", subcommand_name(subcommand), path, outputs[i]);
    if (subcommands[subcommand].json)
        said_sentence(subcommand_run(subcommand, path, "--json", NULL), 1, whole);
}

// As words of their own. An odds ratio may be infinite: where nobody's answers went the other way.
static void all_are_numbers(enum subcommand subcommand, const char *text)
{
    const char *const words[] = {"nan", subcommand == CHOICES ? "nan" : "inf"};
    for (const char *at = text; *at; at++)
        for (size_t i = 0; i < countof(words); i++)
            if (strncasecmp(at, words[i], 3) == 0 && !isalpha((unsigned char)at[3]) &&
                (at == text || !isalpha((unsigned char)at[-1])))
                fail_msg("%s says %.60s", subcommand_name(subcommand), at > text + 30 ? at - 30 : text);
}

void subcommand_works(enum subcommand subcommand, const char *path)
{
    for (int json = 0; json < (subcommands[subcommand].json ? 2 : 1); json++) {
        struct program_result r = subcommand_run(subcommand, path, json ? "--json" : NULL, NULL);
        if (r.code != 0 || r.err[0])
            fail_msg("%s %s: exit %d, %s", subcommand_name(subcommand), path, r.code, r.err);
        all_are_numbers(subcommand, r.out);
        program_free(&r);
    }
    if (subcommand == REPORT) {
        struct program_result page = program_run((const char *const[]){"/bin/cat", "out.html", NULL}, NULL);
        all_are_numbers(subcommand, page.out);
        assert_non_null(strstr(page.out, "</html>"));
        program_free(&page);
    }
}

void subcommand_expect(const char *path, const char *const sentences[SUBCOMMANDS])
{
    for (enum subcommand c = 0; c < SUBCOMMANDS; c++)
        if (sentences[c])
            subcommand_fails(c, path, sentences[c]);
        else
            subcommand_works(c, path);
}
