#include "planned_study.h"

#include "reference.h"
#include "study_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

void planned_study_plan(const char *plans)
{
    char sql[4096];
    snprintf(sql, sizeof sql, "UPDATE session SET settings = json_set(settings, '$.planned', json('[%s]'))",
             plans);
    study_file_sql("s.db", sql);
}

void planned_study_load(struct planned_study *l)
{
    char error[SAMPLE_ERROR_SIZE] = "";
    const char *paths[] = {"s.db"};
    *l = (struct planned_study){0};
    assert_true(sample_load(&l->sample, paths, 1, false, NULL, error, sizeof error));
    assert_true(plans_load(&l->plans, &l->sample));
    assert_true(ratings_load(&l->ratings, &l->sample, 0.95, false, error, sizeof error));
    assert_true(thresholds_load(&l->thresholds, &l->sample, &(struct threshold_options){.conf = 0.95}, error,
                                sizeof error));
    assert_true(adjusted_load(&l->adjusted, &l->sample, 0.95, error, sizeof error));
    const struct planned_sources sources = {&l->ratings, &l->thresholds, &l->adjusted};
    if (!planned_load(&l->planned, &l->sample, &l->plans, &sources, 0.95, error, sizeof error))
        fail_msg("%s", error);
}

void planned_study_free(struct planned_study *l)
{
    planned_free(&l->planned);
    adjusted_free(&l->adjusted);
    thresholds_free(&l->thresholds);
    ratings_free(&l->ratings);
    plans_free(&l->plans);
    sample_free(&l->sample);
}

void planned_study_known(const char *name, double out[5])
{
    char line[256], *rest = NULL;
    FILE *file = reference_open("planned.csv");
    while (!rest && fgets(line, sizeof line, file))
        if (strncmp(line, name, strlen(name)) == 0 && line[strlen(name)] == ',')
            rest = line + strlen(name) + 1;
    fclose(file);
    assert_non_null(rest);
    rest[strcspn(rest, "\n")] = '\0';
    for (int i = 0; i < 5; i++)
        out[i] = reference_number(reference_field(&rest, ','));
}

void planned_study_compare(const struct planned_row *row, const char *name, double *io_worst)
{
    const double got[] = {row->estimate, row->low, row->high, row->p_value, row->holm};
    double r[5];
    planned_study_known(name, r);
    for (int i = 0; i < 5; i++) {
        *io_worst = fmax(*io_worst, reference_distance(got[i], r[i]));
        if (!reference_close(got[i], r[i], 1e-9))
            fail_msg("%s, number %d: %.17g, R %.17g (%s)", name, i + 1, got[i], r[i], row->words);
    }
}
