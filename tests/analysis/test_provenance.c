// The data hash: the same for the same answers, whatever file they stand in, and another one for other answers.
#include "program.h"
#include "study_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char fovstats[] = BUILD_DIR "/bin/fovstats";

#define FOVSTATS(...) program_run((const char *const[]){fovstats, __VA_ARGS__, NULL}, NULL)

enum { HEX = 64 };

static void take_hash(struct program_result r, const char *mark, char out[HEX + 1])
{
    const char *at = strstr(r.out, mark);
    if (r.code != 0 || !at)
        fail_msg("exit %d, no %s in %s%s", r.code, mark, r.out, r.err);
    memcpy(out, at + strlen(mark), HEX);
    out[HEX] = '\0';
    assert_int_equal(strspn(out, "0123456789abcdef"), HEX);
    program_free(&r);
}

static void hash_of(const char *path, char out[HEX + 1])
{
    take_hash(FOVSTATS("choices", path, "--json"), "\"data_sha256\":\"", out);
}

static void one_hash_whatever_the_file(void **state)
{
    (void)state;
    char first[HEX + 1], other[HEX + 1];
    study_file_make("a.db", &(struct study_desc){.several = true, .excluded = true});
    hash_of("a.db", first);
    const char *changes[] = {
        "VACUUM", "PRAGMA page_size = 8192; VACUUM", "PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0",
        // ids are the file's own
        "PRAGMA foreign_keys = OFF; UPDATE choice SET id = id + 100000; UPDATE rating SET id = 100000 - id"};
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        study_file_sql("a.db", changes[i]);
        hash_of("a.db", other);
        if (strcmp(first, other) != 0)
            fail_msg("after %s: %s, before %s", changes[i], other, first);
    }
    // Every subcommand says it, as text and as JSON.
    const char *commands[] = {"choices", "ratings", "frames"};
    for (int i = 0; i < 3; i++) {
        take_hash(FOVSTATS(commands[i], "a.db"), "Data SHA-256 ", other);
        assert_string_equal(first, other);
        take_hash(FOVSTATS(commands[i], "a.db", "--json"), "\"data_sha256\":\"", other);
        assert_string_equal(first, other);
    }
}

static void another_hash_for_other_data(void **state)
{
    (void)state;
    const char *changes[] = {
        "UPDATE choice SET chosen = CASE chosen WHEN 'a' THEN 'b' ELSE 'a' END WHERE id = 7",
        "UPDATE choice SET reaction_ns = reaction_ns + 1 WHERE id = 7",
        "UPDATE rating SET value = value + 0.0000000001 WHERE id = 3",
        "UPDATE trial SET status = 'skipped' WHERE id = 51",
        "UPDATE trial SET test_slot = CASE test_slot WHEN 'a' THEN 'b' ELSE 'a' END WHERE id = 51",
        "UPDATE participant SET attributes = '{\"age\":99}' WHERE id = 2",
        "UPDATE condition SET parameters = '{\"epsilon\":0.3}' WHERE id = 2",
        "DELETE FROM exclusion WHERE rule_set = 'stricter'",
        "DELETE FROM choice WHERE id = 9"};
    char first[HEX + 1], other[HEX + 1];
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        study_file_make("b.db", &(struct study_desc){.excluded = true});
        hash_of("b.db", first);
        study_file_sql("b.db", changes[i]);
        hash_of("b.db", other);
        if (strcmp(first, other) == 0)
            fail_msg("the same hash after %s", changes[i]);
    }
}

static void order_of_files_plays_no_part(void **state)
{
    (void)state;
    char one[HEX + 1], two[HEX + 1], a[HEX + 1];
    study_file_make("a.db", &(struct study_desc){0});
    study_file_make("b.db", &(struct study_desc){0});
    study_file_sql("b.db", "UPDATE session SET started_at = '2027' || started_at");
    take_hash(FOVSTATS("choices", "a.db", "b.db", "--json"), "\"data_sha256\":\"", one);
    take_hash(FOVSTATS("choices", "b.db", "a.db", "--json"), "\"data_sha256\":\"", two);
    hash_of("a.db", a);
    assert_string_equal(one, two);
    assert_string_not_equal(one, a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_hash_whatever_the_file),
        cmocka_unit_test(another_hash_for_other_data),
        cmocka_unit_test(order_of_files_plays_no_part),
    };
    return cmocka_run_group_tests(tests, program_enter_folder, program_leave_folder);
}
