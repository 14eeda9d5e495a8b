// Wrong usage and bad input from the command line: one sentence, the right exit status, nothing half-written.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[512];

// One sentence on stderr that holds `about`, nothing on stdout.
static void expect(const struct command_result *result, int status, const char *about)
{
    const char *newline = strchr(result->err, '\n');
    if (result->status != status || !strstr(result->err, about) || !newline || newline[1] || result->out[0])
        print_error("status %d (expected %d)\nstderr: %s\nstdout: %s\nexpected about: %s\n", result->status,
                    status, result->err, result->out, about);
    assert_int_equal(result->status, status);
    assert_int_equal(strncmp(result->err, "fovstudy", 8), 0);
    assert_non_null(strstr(result->err, about));
    assert_true(newline && !newline[1]);
    assert_int_equal(result->out[0], '\0');
}

// A copy of short.yaml with one text replaced.
static void write_protocol(const char *name, const char *from, const char *to)
{
    const struct command_result *result = command("sed 's|%s|%s|' '%s/studies/protocols/short.yaml' > '%s/%s' "
                                                  "&& ! cmp -s '%s/studies/protocols/short.yaml' "
                                                  "'%s/%s'",
                                                  from, to, SOURCE_DIR, folder, name, SOURCE_DIR, folder, name);
    assert_int_equal(result->status, 0);
}

static void wrong_usage_is_exit_2(void **state)
{
    (void)state;
    static const struct {
        const char *line, *about;
    } cases[] = {
        {"fovstudy", "command is missing"},
        {"fovstudy fly", "'fly'"},
        {"fovstudy modes --xml", "'--xml'"},
        {"fovstudy modes extra", "'extra'"},
        {"fovstudy modes --json=yes", "takes no value"},
        {"fovstudy scenes -x", "'-x'"},
        {"fovstudy check", "which protocol"},
        {"fovstudy check a.yaml b.yaml", "'b.yaml'"},
        {"fovstudy check a.yaml --number 0", "'0'"},
        {"fovstudy run", "which protocol"},
        {"fovstudy run a.yaml", "--db"},
        {"fovstudy run a.yaml --db x.db", "--participant"},
        {"fovstudy run a.yaml --db", "wants a value"},
        {"fovstudy run a.yaml --db x.db --participant p --size 10x10", "10x10"},
        {"fovstudy run a.yaml --db x.db --participant p --size 640", "640"},
        {"fovstudy run a.yaml --db x.db --participant p --seed -1", "-1"},
        {"fovstudy run a.yaml --db x.db --participant p --seed 1e3", "1e3"},
        {"fovstudy run a.yaml --db x.db --participant p --fov nan", "nan"},
        {"fovstudy run a.yaml --db x.db --participant p --refresh 0", "0"},
        {"fovstudy run a.yaml --db x.db --participant p --scene town", "town"},
        {"fovstudy run a.yaml --db x.db --participant p --attribute age", "age"},
        {"fovstudy run a.yaml --db x.db --participant p --display headless", "--observer"},
        {"fovstudy run a.yaml --db x.db --participant p --display none", "--observer"},
        {"fovstudy run a.yaml --db x.db --participant 'Anna M\xc3\xbcller'", "no code for a participant"},
        {"fovstudy run a.yaml --db x.db --participant p/1", "no code for a participant"},
        {"fovstudy run a.yaml --db x.db --participant p12345678901234567890123456789012", "1 to 32"},
        {"fovstudy check a.yaml --participant 'Anna M'", "no code for a participant"},
        {"fovstudy check a.yaml --participant=", "no code for a participant"},
        {"fovstudy run a.yaml --db x.db --participant p --display none --observer person", "person"},
        {"fovstudy run a.yaml --db x.db --participant p --display none --observer sim:threshold=-1",
         "threshold"},
        {"fovstudy run a.yaml --db x.db --participant p --display none --observer sim:luck=1",
         "'luck' is not known"},
        {"fovstudy resume --db x.db --observer sim:luck=1", "'luck' is not known"},
        {"fovstudy resume --db x.db --again", "--again"},
        {"fovstudy resume --db x.db --new-protocol", "--new-protocol"},
        {"fovstudy resume --db x.db --participants 3", "--participants"},
        {"fovstudy run a.yaml --db x.db --participant p --protocol -", "--protocol"},
        {"fovstudy run '" SOURCE_DIR "/studies/protocols/short.yaml' --db no-such-folder/x.db --participant p "
         "--attribute shoe=44",
         "shoe"},
        {"fovstudy strip --scene town --out x.png", "--modes"},
        {"fovstudy strip --modes vrs regular --scene town", "--out"},
        {"fovstudy strip --modes regular --out x.png", "--scene"},
        {"fovstudy strip --modes regular warped --scene town --out x.png", "warped"},
        {"fovstudy strip --modes regular --scene town --out x.png word", "word"},
        {"fovstudy strip --modes vrs --scene town --out x.png --size 8x8", "8x8"},
        {"fovstudy strip --modes vrs vrs vrs vrs vrs vrs vrs vrs vrs --scene town --out x.png", "more than 8"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect(command("%s", cases[i].line), 2, cases[i].about);
}

static void help_is_exit_0(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "fovstudy --help",         "fovstudy --version",     "fovstudy run --help",    "fovstudy check --help",
        "fovstudy modes --help",   "fovstudy scenes --help", "fovstudy render --help", "fovstudy strip --help",
        "fovstudy devices --help", "fovstudy schema --help"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        const struct command_result *result = command("%s", lines[i]);
        assert_int_equal(result->status, 0);
        assert_true(strlen(result->out) > 10 && !result->err[0]);
    }
    // Each lists what it takes and nothing else.
    static const char *const run_only[] = {"--participants", "--again", "--new-protocol"};
    char text[COMMAND_TEXT];
    strcpy(text, command("fovstudy resume --help")->out);
    assert_non_null(strstr(text, "  --protocol "));
    for (size_t i = 0; i < sizeof run_only / sizeof run_only[0]; i++) {
        assert_null(strstr(text, run_only[i]));
        assert_non_null(strstr(command("fovstudy run --help")->out, run_only[i]));
    }
    assert_null(strstr(command("fovstudy run --help")->out, "  --protocol "));
}

static void tables_are_valid_json(void **state)
{
    (void)state;
    static const char *const lines[] = {"modes --json", "scenes --json", "schema",
                                        "check '" SOURCE_DIR "/studies/protocols/calibration.yaml' --json"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        const struct command_result *result =
            command("fovstudy %s > '%s/table.json' && python3 -m json.tool '%s/table.json' > /dev/null",
                    lines[i], folder, folder);
        assert_int_equal(result->status, 0);
        assert_int_equal(result->err[0], '\0');
    }
    assert_non_null(strstr(command("fovstudy modes")->out, "epsilon"));
    assert_non_null(strstr(command("fovstudy scenes")->out, "triangles"));
}

static void the_reference_page_is_up_to_date(void **state)
{
    (void)state;
    const struct command_result *result =
        command("fovstudy schema --reference | diff '" SOURCE_DIR "/docs/protocol.md' -");
    if (result->status != 0)
        fail_msg("docs/protocol.md is stale; run: fovstudy schema --reference > docs/protocol.md\n%.2000s",
                 result->out);
    expect(command("fovstudy schema now"), 2, "now");
}

// The same participant gets the same table, another one another, and all of them nine decisions and two
// ratings.
static void check_prints_a_participants_trials(void **state)
{
    (void)state;
    char first[COMMAND_TEXT];
    const char *line = "fovstudy check '" SOURCE_DIR "/studies/protocols/calibration.yaml' --number %d";
    strcpy(first, command(line, 1)->out);
    assert_true(strlen(first) > 500);
    assert_string_equal(command(line, 1)->out, first);
    assert_string_not_equal(command(line, 2)->out, first);
}

static void protocol_mistakes_have_their_place(void **state)
{
    (void)state;
    static const struct {
        const char *from, *to, *about;
    } cases[] = {
        {"mode: time_warped", "mode: time_wrapped", "time_wrapped"},
        {"{mode: time_warped}", "{mode: time_warped, epsilom: 0.1}", "epsilom"},
        {"{mode: time_warped}", "{mode: time_warped, epsilon: 7}", "7"},
        {"scenes: \\[atrium\\]", "scenes: [cathedral]", "cathedral"},
        {"epsilon: \\[0.2, 0.05\\]", "epsilon: [0.2, many]", "many"},
        {"reference: regular", "reference: [", ""},
        {"seed: 1", "sead: 1", "sead"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char place[600];
        write_protocol("wrong.yaml", cases[i].from, cases[i].to);
        snprintf(place, sizeof place, "%s/wrong.yaml:", folder);
        const struct command_result *result = command("fovstudy check '%s/wrong.yaml'", folder);
        expect(result, 1, cases[i].about);
        const char *at = strstr(result->err, place);
        int row = 0, column = 0;
        assert_non_null(at);
        assert_int_equal(sscanf(at + strlen(place), "%d:%d:", &row, &column), 2);
        assert_true(row > 1 && column > 0);
        expect(
            command(
                "fovstudy run '%s/wrong.yaml' --db '%s/never.db' --participant p --display none --observer sim",
                folder, folder),
            1, cases[i].about);
    }
    // each in its range, but not together
    write_protocol("wrong.yaml", "{mode: time_warped}", "{mode: time_warped, fovea_deg: 30}");
    expect(command("fovstudy check '%s/wrong.yaml'", folder), 1, "it must be more than fovea_deg, 30");
    expect(command("fovstudy check '" SOURCE_DIR "/studies/protocols/short.yaml' --scene atrum=town"), 1,
           "--scene binds 'atrum', which is no scene of this protocol; it has: atrium");
    expect(command("fovstudy check '%s/no-such.yaml'", folder), 1, "no-such.yaml");
    char path[600];
    snprintf(path, sizeof path, "%s/never.db", folder);
    assert_int_not_equal(access(path, F_OK), 0); // nothing was written
}

#define RUN_SHORT "fovstudy run '" SOURCE_DIR "/studies/protocols/short.yaml' --participant p "

static void run_refuses_before_it_writes(void **state)
{
    (void)state;
    static const struct {
        const char *options, *about;
    } cases[] = {
        {"--display none --observer sim", "measured"},
        {"--display none --observer sim:errors=/no/such/file", "/no/such/file"},
        {"--display none --observer sim --scene atrium=town:trees=5", "trees=5"},
        {"--display none --observer sim --scene atrium=/no/such.glb", "/no/such.glb cannot be opened"},
        {"--display none --observer sim --scene atrium=cathedral", "'cathedral' is not known"},
        {"--display none --observer sim --scene atrium=/", "/ is a folder; name a .gltf or .glb file"},
        {"--display none --observer sim --scene atrium=/no/such", "/no/such cannot be opened"},
        {"--display telepathy --observer sim", "telepathy"},
        {"--display headless:3 --observer sim", "headless"},
        {"--display headless --size 32x36 --observer sim --gaze tea-leaves", "'tea-leaves' is not known"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        expect(command(RUN_SHORT "--db '%s/none.db' %s", folder, cases[i].options), 1, cases[i].about);
        assert_string_equal(command("ls '%s' | grep none.db", folder)->out, ""); // nor an empty study file
    }
}

// Errors from a file let a simulated participant answer without a GPU; the parts of the file are checked.
static void a_session_runs_without_frames(void **state)
{
    (void)state;
    const struct command_result *result;
    const char *run =
        RUN_SHORT "--db '%s/errors.db' --display none --observer sim:errors=%s/errors.csv --events -";
    command("printf 'atrium,0.03,time_warped:epsilon=0.2\\n' > '%s/errors.csv'", folder);
    expect(command(run, folder, folder), 1, "0.05"); // the other option is missing
    expect(
        command(run, folder, folder), 1,
        "errors.csv nor the study file holds the error of time_warped:epsilon=0.05 on 'atrium'; add the line "
        "'atrium,ERROR,time_warped:epsilon=0.05'");
    command("printf '# better\\natrium,0.02,time_warped:epsilon=0.05\\n' >> '%s/errors.csv'", folder);
    result = command(run, folder, folder);
    assert_string_equal(result->err, "");
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "{\"seq\":1,\"event\":\"trial\",\"t_ns\":"));
    assert_non_null(strstr(result->out, "\"table\":\"choice\",\"row\":1"));
    assert_non_null(strstr(result->out, "\"event\":\"end\""));
    result =
        command("sqlite3 '%s/errors.db' \"SELECT (SELECT count(*) FROM choice), (SELECT count(*) FROM rating), "
                "(SELECT count(*) FROM frame), (SELECT status FROM session)\"",
                folder);
    assert_string_equal(result->out, "2|1|0|complete\n");
    expect(command(run, folder, folder), 1, "p"); // the same code again
    command("printf 'atrium,0.5,time_warped\\natrium,1.5,regular\\n' > '%s/errors.csv'", folder);
    expect(command("cd '%s' && " RUN_SHORT "--db other.db --display none --observer sim:errors=errors.csv",
                   folder),
           1, "errors.csv:2: '1.5' is no error; it is a number from 0 to 1");
    command("printf 'atrium,bad,regular\\n' > '%s/errors.csv'", folder);
    expect(
        command(
            "fovstudy run '%s/studies/protocols/short.yaml' --participant q --db '%s/errors.db' --display none "
            "--observer sim:errors=%s/errors.csv",
            SOURCE_DIR, folder, folder),
        1, "errors.csv:1");
}

// One file is one study: another text is refused before a row is written, unless it was asked for.
static void a_file_keeps_its_protocol(void **state)
{
    (void)state;
#define HERE "cd '%s' && fovstudy run %s --db one.db --display none --observer sim:errors=one.csv "
    const char *rows =
        "sqlite3 '%s/one.db' \"SELECT (SELECT count(*) FROM participant), (SELECT count(*) FROM session), "
        "(SELECT count(*) FROM protocol), (SELECT count(*) FROM event WHERE kind = 'new_protocol')\"";
    command("printf 'atrium,0.03,time_warped\\natrium,0.02,time_warped:epsilon=0.05\\n' > '%s/one.csv'",
            folder);
    command("cp '" SOURCE_DIR "/studies/protocols/short.yaml' '%s/one.yaml'", folder);
    assert_int_equal(command(HERE "--participant p1", folder, "one.yaml")->status, 0);
    write_protocol("text.yaml", "seed: 1", "seed: 1 # as before");
    write_protocol("name.yaml", "^name: short", "name: longer");
    expect(command(HERE "--participant p2", folder, "text.yaml"), 1,
           "one.db: its sessions are of protocol 'short' with another text (");
    expect(command(HERE "--participant p2", folder, "text.yaml"), 1, "give another --db, or --new-protocol");
    expect(command(HERE "--participant p2", folder, "name.yaml"), 1,
           "one.db: its sessions are of another protocol, 'short', and name.yaml is 'longer'");
    assert_string_equal(command(rows, folder)->out, "1|1|1|0\n");
    assert_int_equal(command(HERE "--participant p2 --new-protocol", folder, "text.yaml")->status, 0);
    assert_string_equal(command(rows, folder)->out, "2|2|2|1\n");
    // Both are the file's now.
    assert_int_equal(command(HERE "--participant p3", folder, "one.yaml")->status, 0);
    assert_int_equal(command(HERE "--participant p4", folder, "text.yaml")->status, 0);
    expect(command(HERE "--participant p5", folder, "name.yaml"), 1, "is 'longer'");
    assert_string_equal(command(rows, folder)->out, "4|4|2|1\n");
    // Another protocol has its own seed, and nobody who is complete in this one is complete in that one.
    assert_int_equal(command(HERE "--participants 2", folder, "one.yaml")->status, 0);
    write_protocol("seed.yaml", "^seed: 1", "seed: 2");
    command("sed -i 's/^name: short/name: longer/' '%s/seed.yaml'", folder);
    const struct command_result *refused = command(HERE "--participants 2 --new-protocol", folder, "seed.yaml");
    assert_int_equal(refused->status, 1);
    assert_non_null(strstr(refused->err, "S001 has a session already"));
    assert_null(strstr(refused->err, "passed over"));
    assert_int_equal(command(HERE "--participants 2 --new-protocol --again", folder, "seed.yaml")->status, 0);
    assert_string_equal(command(rows, folder)->out, "6|8|3|3\n");
    assert_int_equal(command(HERE "--participant forgotten-5", folder, "one.yaml")->status, 2);
    // Everybody sees the same scene under one name.
    command("printf 'atrium,0.03,time_warped\\natrium,0.02,time_warped:epsilon=0.05\\n' > '%s/one.csv'",
            folder);
    expect(command(HERE "--participant p6 --scene atrium=town", folder, "one.yaml"), 1,
           "one.db: its sessions showed other scenes (atrium: atrium) than this one would (atrium: town)");
    assert_int_equal(command(HERE "--participant p6 --scene atrium=atrium", folder, "one.yaml")->status, 0);
    // Another screen is said.
    static const struct {
        const char *options, *about;
    } screens[] = {
        {"s1 --size 32x36 --refresh 60", ""},
        {"s2 --size 32x36 --refresh 60", ""},
        {"s3 --size 48x36 --refresh 90", "session 1 of this study was shown on 32 x 36 px at 60 Hz, 100 "
                                         "degrees high; this one is on 48 x 36 px "
                                         "at 90 Hz"},
    };
    for (size_t i = 0; i < sizeof screens / sizeof screens[0]; i++) {
        const struct command_result *shown =
            command("cd '%s' && fovstudy run one.yaml --db screen.db --display headless --observer sim --scene "
                    "atrium=town:triangles=20000 --participant %s",
                    folder, screens[i].options);
        assert_int_equal(shown->status, 0);
        assert_non_null(strstr(shown->err, screens[i].about));
        assert_int_equal(strstr(shown->err, "remark") != NULL, *screens[i].about != '\0');
    }
    assert_int_equal(
        command(HERE "--participant p7 --scene atrium=town --new-protocol", folder, "one.yaml")->status, 0);
}

// `--participants N` goes on where it stopped: complete ones stay, an unfinished one is named.
static void participants_are_filled_up(void **state)
{
    (void)state;
    const char *fill =
        "cd '%s' && fovstudy run one.yaml --db many.db --display none --observer sim:errors=one.csv "
        "--participants %d %s";
    const char *sessions =
        "sqlite3 '%s/many.db' \"SELECT group_concat(code || ' ' || status, ', ') FROM (SELECT code, "
        "status FROM session s JOIN participant p ON p.id = participant_id ORDER BY s.id)\"";
    assert_int_equal(command(fill, folder, 2, "")->status, 0);
    const struct command_result *result = command(fill, folder, 4, "");
    assert_int_equal(result->status, 0);
    assert_string_equal(result->err, "fovstudy: 2 of 4 participants are complete and passed over\n");
    assert_string_equal(command(sessions, folder)->out,
                        "S001 complete, S002 complete, S003 complete, S004 complete\n");
    result = command(fill, folder, 4, "");
    assert_int_equal(result->status, 0);
    assert_string_equal(result->err, "fovstudy: 4 of 4 participants are complete and passed over\n");
    // Those of another protocol are not complete in this one.
    expect(
        command("cd '%s' && fovstudy run text.yaml --db many.db --display none --observer sim:errors=one.csv "
                "--participants 4",
                folder),
        1, "with another text (");
    command("sqlite3 '%s/many.db' \"UPDATE session SET status = 'running', ended_at = NULL WHERE id = 3\"",
            folder);
    result = command(fill, folder, 5, "");
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "fovstudy: 3 of 5 participants are complete and passed over\n"));
    assert_non_null(strstr(result->err, "session 3 is unfinished: fovstudy resume --db 'many.db' 3"));
    assert_non_null(strstr(result->err, "stopped at participant S003 of 5\n"));
    assert_int_equal(command("cd '%s' && fovstudy resume --db many.db", folder)->status, 0);
    assert_int_equal(command(fill, folder, 5, "")->status, 0);
    assert_string_equal(
        command("sqlite3 '%s/many.db' \"SELECT count(*), sum(status = 'complete') FROM session\"", folder)->out,
        "5|5\n");
}

static int set_up(void **state)
{
    (void)state;
    command_folder("cli", folder, sizeof folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_usage_is_exit_2),
        cmocka_unit_test(help_is_exit_0),
        cmocka_unit_test(tables_are_valid_json),
        cmocka_unit_test(the_reference_page_is_up_to_date),
        cmocka_unit_test(check_prints_a_participants_trials),
        cmocka_unit_test(protocol_mistakes_have_their_place),
        cmocka_unit_test(run_refuses_before_it_writes),
        cmocka_unit_test(a_session_runs_without_frames),
        cmocka_unit_test(a_file_keeps_its_protocol),
        cmocka_unit_test(participants_are_filled_up),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
