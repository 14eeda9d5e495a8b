// Errors of what was never measured: between the known ones, by setting, and the study file before the errors
// file.
#include "app/session/errors_table.h"
#include "renderer/mode.h"
#include "tests/app/command.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static char folder[512];

static struct errors_table *read(const char *lines)
{
    char path[600], database[600], error[1024] = "";
    struct store_error why;
    snprintf(path, sizeof path, "%s/errors.csv", folder);
    snprintf(database, sizeof database, "%s/study.db", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(lines, file);
    fclose(file);
    remove(database);
    struct store *store = store_open(&(struct store_desc){.path = database, .access = STORE_CREATE}, &why);
    assert_non_null(store);
    // What a session measured: epsilon 0.4 in town:triangles=1, which stands for town.
    int64_t reference = 0, tested = 0;
    const struct store_condition conditions[] = {
        {"regular", "{}"},
        {"time_warped", "{\"epsilon\":0.4,\"fovea_deg\":10,\"periphery_deg\":30,\"hole_decay\":0.6,"
                        "\"dynamic_decay\":0.75,\"dynamic_objects\":\"foveated\",\"splat\":\"atomic\"}"}};
    assert_int_equal(store_add_condition(store, &conditions[0], &reference, &why), STORE_OK);
    assert_int_equal(store_add_condition(store, &conditions[1], &tested, &why), STORE_OK);
    const struct store_error_key key = {tested, reference, "town:triangles=1", "wrmse"};
    assert_int_equal(store_set_measured_error(store, &key, 0.08, &why), STORE_OK);
    struct errors_table *table = errors_table_read(store, reference, path, error, sizeof error);
    assert_string_equal(table ? "" : error, "");
    store_close(store, &why);
    return table;
}

static struct mode_choice option(const char *spec)
{
    struct mode_choice choice;
    char error[256] = "";
    mode_parse(spec, &choice, error, sizeof error);
    assert_string_equal(error, "");
    return choice;
}

static void close_to(double value, double wanted)
{
    if (!(fabs(value - wanted) < 1e-12))
        fail_msg("%g is not %g", value, wanted);
}

static void lines_between_known_errors(void **state)
{
    (void)state;
    struct errors_table *table = read("# by hand\ntown,0.02,time_warped:epsilon=0.1\n"
                                      "town,0.04,time_warped:epsilon=0.2\n"
                                      "town,0.5,time_warped:epsilon=0.4\n" // the study file knows better
                                      "town,0.9,time_warped:epsilon=0.3,fovea_deg=6\n"
                                      "town;ssao=on,0.7,time_warped:epsilon=0.2\n"
                                      "atrium,0.6,time_warped:epsilon=0.3\n");
    const struct errors_place town = {"town", "town:triangles=1", "wrmse"};
    const struct errors_place shaded = {"town", "town:triangles=1", "wrmse;ssao=on"};
    const struct mode_choice base = option("time_warped:epsilon=0.77");
    const uint32_t epsilon = 0;
    uint32_t count = 0;
    assert_string_equal(base.mode->parameters[epsilon].name, "epsilon");
    close_to(errors_table_between(table, &town, &base, epsilon, 0.1, &count), 0.02);
    assert_int_equal(count >= 2, 1);
    close_to(errors_table_between(table, &town, &base, epsilon, 0.15, NULL), 0.03);
    close_to(errors_table_between(table, &town, &base, epsilon, 0.3, NULL), 0.06);
    close_to(errors_table_between(table, &town, &base, epsilon, 0.4, NULL), 0.08);
    close_to(errors_table_between(table, &town, &base, epsilon, 1.0, NULL), 0.08); // no further
    close_to(errors_table_between(table, &town, &base, epsilon, 0.0, NULL), 0.02);
    double last = 0.0;
    for (int i = 0; i <= 1000; i++) {
        double error = errors_table_between(table, &town, &base, epsilon, i * 1e-3, NULL);
        assert_true(error >= last);
        last = error;
    }
    const struct mode_choice known = option("time_warped:epsilon=0.4"),
                             other = option("time_warped:epsilon=0.3");
    close_to(errors_table_find(table, &town, &known), 0.08);
    assert_true(isnan(errors_table_find(table, &town, &other)));
    // Another setting is another picture, and one value says nothing of others.
    const struct mode_choice standard = option("time_warped");
    close_to(errors_table_find(table, &shaded, &standard), 0.7);
    assert_true(isnan(errors_table_between(table, &shaded, &base, epsilon, 0.2, &count)));
    assert_int_equal(count, 1);
    const struct mode_choice wider = option("time_warped:fovea_deg=17");
    assert_true(isnan(errors_table_between(table, &shaded, &wider, epsilon, 0.2, &count)));
    assert_int_equal(count, 0);
    errors_table_destroy(table);
}

int main(void)
{
    command_folder("errors", folder, sizeof folder);
    const struct CMUnitTest tests[] = {cmocka_unit_test(lines_between_known_errors)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
