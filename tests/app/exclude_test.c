// Exclusion rules from the protocol file to the study file, end to end: what a session takes out when it ends
// is what plain SQL says; `fovstudy exclude` makes up for sessions that crashed, changes nothing twice, marks
// later rules late, takes out by hand; a number that an excluded person had is given again.
#include "tests/app/command.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char folder[512];

// Limits that take out some of the trials and not all.
#define PLANNED                                                                                                \
    "  - {rule: unseen_option, below: 2.5}\n  - {rule: gaze_loss, above: 0.02}\n"                              \
    "  - {rule: gaze_gap_ms, above: 140}\n  - {rule: reaction, above: 9}\n"                                    \
    "  - {rule: reaction, above: 7, set: stricter}\n  - {rule: fallback}\n"                                    \
    "  - {rule: failed_catch, of: person, above: 0.2}\n"

static void write_file(const char *name, const char *text)
{
    char path[640];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void write_protocol(const char *name, const char *study, const char *rules)
{
    char text[4096];
    snprintf(text, sizeof text,
             "fovstudy: 1\nname: %s\ntitle: t\nseed: 3\nscenes: [atrium]\noptions:\n"
             "  foveated: {mode: time_warped}\n  blurred: {mode: time_warped, epsilon: 1}\n"
             "  regular: {mode: regular}\nreference: regular\n"
             "settings: {advance: auto, rest_s: 0.1, question: prefer, moving_objects: off}\n"
             "questions:\n  prefer: {text: Which one?}\ninstructions: i\n"
             "consent: {version: \"1\", text: c}\nblocks:\n"
             "  - {name: learn, kind: toggle, role: practice, options: [foveated, regular]}\n"
             "  - {name: main, kind: toggle, options: [foveated, regular], repetitions: 12, null: 2,\n"
             "     catch: {count: 8, option: blurred}}\nexclude:\n%s",
             study, rules);
    write_file(name, text);
}

static int run(const char *protocol, const char *db, const char *code, const char *observer)
{
    const struct command_result *result =
        command("fovstudy run '%s/%s' --db '%s/%s' --participant %s --display none --gaze sim --observer "
                "'sim:errors=%s/errors.txt%s'",
                folder, protocol, folder, db, code, folder, observer);
    if (result->status != 0 || result->err[0])
        print_error("%s", result->err);
    return result->status;
}

static const struct command_result *exclude(const char *db, const char *more)
{
    return command("fovstudy exclude --db '%s/%s' %s", folder, db, more);
}

static const char *ask(const char *db, const char *query)
{
    static char answer[COMMAND_TEXT];
    const struct command_result *result = command("sqlite3 '%s/%s' \"%s\"", folder, db, query);
    if (result->err[0])
        print_error("%s\n%s\n", query, result->err);
    assert_int_equal(result->status, 0);
    strcpy(answer, result->out);
    answer[strcspn(answer, "\n")] = '\0';
    return answer;
}

#define expect(db, query, answer) assert_string_equal(ask(db, query), answer)

// Both sides of an exact comparison, and that there is something to compare.
static void expect_trials(const char *rule, const char *set, const char *by_hand)
{
    char query[2048], found[4096];
    snprintf(query, sizeof query,
             "SELECT group_concat(trial_id) FROM (SELECT trial_id FROM exclusion WHERE rule = '%s' AND "
             "rule_set = '%s' "
             "ORDER BY trial_id)",
             rule, set);
    snprintf(found, sizeof found, "%s", ask("a.db", query));
    snprintf(query, sizeof query,
             "SELECT group_concat(id) FROM (SELECT t.id FROM trial t JOIN choice c ON c.trial_id = "
             "t.id WHERE t.kind <> 'practice' AND %s ORDER BY t.id)",
             by_hand);
    assert_string_equal(found, ask("a.db", query));
    assert_true(strlen(found) > 0);
}

static void the_session_takes_out_what_the_rules_say(void **state)
{
    (void)state;
    expect("a.db", "SELECT count(*), min(detail ->> '$.set') FROM event WHERE kind = 'rules_applied'",
           "1|planned");
    expect("a.db",
           "SELECT count(*) FROM exclusion WHERE \\\"by\\\" NOT GLOB 'fovstudy [0-9]*' OR applied_at NOT GLOB "
           "'20*Z' OR reason = ''",
           "0");
    expect_trials("reaction", "planned", "c.reaction_ns > 9e9");
    expect_trials("reaction", "stricter", "c.reaction_ns > 7e9 AND c.reaction_ns <= 9e9");
    expect_trials(
        "unseen_option", "planned",
        "(SELECT min(s) FROM (SELECT coalesce(sum(full_end_ns - full_start_ns), 0) AS s FROM exposure e WHERE "
        "e.trial_id = t.id GROUP BY option)) < 2.5e9");
    expect_trials(
        "gaze_loss", "planned",
        "(SELECT avg(NOT valid) FROM gaze g WHERE g.trial_id = t.id AND host_ns BETWEEN (SELECT min(start_ns) "
        "FROM exposure WHERE trial_id = t.id) AND (SELECT max(end_ns) FROM exposure WHERE trial_id = t.id)) > "
        "0.02");
    expect("a.db", "SELECT count(*) > 0 FROM exclusion WHERE rule = 'gaze_gap_ms'", "1");
    expect("a.db", "SELECT count(*) FROM exclusion WHERE rule IN ('fallback', 'failed_catch')", "0");
    expect("a.db", "SELECT count(*) FROM exclusion e JOIN trial t ON t.id = trial_id WHERE t.kind = 'practice'",
           "0");
    expect(
        "a.db",
        "SELECT reason GLOB 'answered after * s, more than 9 s' FROM exclusion WHERE rule = 'reaction' LIMIT 1",
        "1");
}

// The session as a crash after its last answer would have left it.
static void a_crashed_session_gets_them_later(void **state)
{
    (void)state;
    static char before[COMMAND_TEXT];
    static const char rows[] = "SELECT group_concat(trial_id || rule || rule_set || reason) FROM exclusion";
    command("cp '%s/a.db' '%s/crash.db'", folder, folder);
    strcpy(before, ask("crash.db", rows));
    ask("crash.db",
        "DELETE FROM exclusion; DELETE FROM event WHERE kind = 'rules_applied'; UPDATE session SET status = "
        "'running', ended_at = NULL");
    const struct command_result *result = exclude("crash.db", "");
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "The rules were applied to 1 session that lacked them: "));
    assert_non_null(strstr(result->out, "answered after "));
    assert_string_equal(before, ask("crash.db", rows));
    result = exclude("crash.db", "");
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "to 0 sessions that lacked them: 0 taken out."));
    assert_string_equal(before, ask("crash.db", rows));
    expect("crash.db", "SELECT count(*) FROM event WHERE kind = 'rules_applied'", "1");
    ask("crash.db", "DELETE FROM event WHERE kind = 'rules_applied'"); // as if it were resumed: looked at again
    assert_int_equal(exclude("crash.db", "--json")->status, 0);
    assert_string_equal(before, ask("crash.db", rows));
}

static void later_rules_are_late(void **state)
{
    (void)state;
    write_protocol("later.yaml", "rules",
                   "  - {rule: reaction, above: 5}\n  - {rule: gaze_loss, above: 0, set: stricter}\n");
    write_protocol("other.yaml", "other", "  - {rule: reaction, above: 5}\n");
    command("cp '%s/a.db' '%s/late.db'", folder, folder);
    char option[640];
    snprintf(option, sizeof option, "--protocol '%s/later.yaml'", folder);
    for (int i = 0; i < 2; i++) {
        const struct command_result *result = exclude("late.db", option);
        assert_int_equal(result->status, 0);
        assert_non_null(strstr(result->out, i ? "late rules were applied to 0 sessions"
                                              : "late rules were applied to 1 session "));
        expect(
            "late.db",
            "SELECT (SELECT count(*) FROM exclusion WHERE rule_set = 'late' AND rule = 'reaction') = count(*), "
            "count(*) > "
            "0 FROM choice JOIN trial t ON t.id = trial_id WHERE reaction_ns > 5e9 AND reaction_ns <= 9e9 AND "
            "t.kind <> 'practice'",
            "1|1");
        expect("late.db", "SELECT count(*) FROM exclusion WHERE rule_set = 'late' AND rule <> 'reaction'", "0");
    }
    const struct command_result *result = exclude("late.db", "--list --json");
    assert_int_equal(result->status, 0);
    assert_non_null(strstr(result->out, "\"rule_set\":\"late\""));
    snprintf(option, sizeof option, "--protocol '%s/other.yaml'", folder);
    result = exclude("late.db", option);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "is the study 'other', and"));
    snprintf(option, sizeof option, "--protocol '%s/rules.yaml'", folder);
    result = exclude("late.db", option);
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "leave --protocol out"));
}

static void numbers_of_the_excluded_are_given_again(void **state)
{
    (void)state;
    command("cp '%s/a.db' '%s/hand.db'", folder, folder);
    assert_int_equal(exclude("hand.db", "--person p1")->status, 2);
    assert_int_equal(exclude("hand.db", "--person nobody --reason r --by me")->status, 1);
    assert_int_equal(exclude("hand.db", "--trial 99999 --reason r --by me")->status, 1);
    assert_int_equal(exclude("hand.db", "--trial 3 --reason 'the phone rang' --by 'E. X.'")->status, 0);
    expect("hand.db",
           "SELECT rule, rule_set, reason, \\\"by\\\" FROM exclusion WHERE trial_id = 3 AND rule = 'manual'",
           "manual|late|the phone rang|E. X.");
    assert_int_equal(run("rules.yaml", "hand.db", "p2", ""), 0);
    expect("hand.db", "SELECT number FROM participant WHERE code = 'p2'", "2");
    for (int i = 0; i < 2; i++)
        assert_int_equal(exclude("hand.db", "--person p1 --reason 'took the headset off' --by me")->status, 0);
    expect("hand.db", "SELECT count(*) FROM exclusion WHERE participant_id = 1", "1");
    assert_int_equal(run("rules.yaml", "hand.db", "p3", ""), 0);
    expect("hand.db", "SELECT number FROM participant WHERE code = 'p3'", "1");
    // The same trials in the same order as the person whose place it is.
    expect("hand.db",
           "SELECT count(*) FROM trial a JOIN trial b ON a.ordinal = b.ordinal WHERE a.session_id = 1 AND "
           "b.session_id = 3 "
           "AND (a.seed <> b.seed OR a.kind <> b.kind OR a.option_a IS NOT b.option_a)",
           "0");
    // By a planned rule: somebody who only guesses misses catch trials.
    assert_int_equal(run("rules.yaml", "hand.db", "p4", ",lapse=1"), 0);
    expect("hand.db",
           "SELECT p.number, e.rule, e.rule_set, e.reason GLOB 'missed [2-8] of 8 catch trials (* %), more "
           "than 20 %' FROM "
           "exclusion e JOIN participant p ON p.id = participant_id WHERE code = 'p4'",
           "3|failed_catch|planned|1");
    assert_int_equal(run("rules.yaml", "hand.db", "p5", ""), 0);
    expect("hand.db", "SELECT number FROM participant WHERE code = 'p5'", "3");
}

// Without a tracker a trial that foveates by gaze is not what was asked, but nothing is drawn here.
static void wrong_use_is_refused(void **state)
{
    (void)state;
    assert_int_equal(command("fovstudy exclude")->status, 2);
    assert_int_equal(exclude("a.db", "--list --person p1")->status, 2);
    assert_int_equal(exclude("a.db", "--reason r")->status, 2);
    assert_int_equal(exclude("a.db", "extra")->status, 2);
    assert_int_equal(exclude("a.db", "--help")->status, 0);
    const struct command_result *result = exclude("none.db", "--list");
    assert_int_equal(result->status, 1);
    assert_non_null(strstr(result->err, "there is no such file"));
    assert_int_equal(exclude("none.db", "")->status, 1);
}

static int set_up(void **state)
{
    (void)state;
    command_folder("exclude", folder, sizeof folder);
    write_protocol("rules.yaml", "rules", PLANNED);
    write_file("errors.txt", "atrium,0.02,time_warped\natrium,0.9,time_warped:epsilon=1\natrium,0,regular\n");
    return run("rules.yaml", "a.db", "p1", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_session_takes_out_what_the_rules_say),
        cmocka_unit_test(a_crashed_session_gets_them_later),
        cmocka_unit_test(later_rules_are_late),
        cmocka_unit_test(numbers_of_the_excluded_are_given_again),
        cmocka_unit_test(wrong_use_is_refused),
    };
    return cmocka_run_group_tests_name("exclude", tests, set_up, NULL);
}
