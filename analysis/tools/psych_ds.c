// Psych-DS: data files first, then the description of what they hold.
#include "analysis/tools/psych_ds.h"

#include "analysis/tools/cell.h"
#include "analysis/tools/json.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct study {
    char name[96];    // of the protocol
    char keyword[96]; // the same as the value of a keyword: letters and digits
    char hash[65], program[64];
    bool simulated;
};

static bool note_study(void *user, const struct store_session_row *row)
{
    struct study *s = user;
    if (!s->name[0]) {
        snprintf(s->name, sizeof s->name, "%s", row->protocol_name);
        snprintf(s->hash, sizeof s->hash, "%s", row->protocol_sha256);
        snprintf(s->program, sizeof s->program, "%s", row->app_version);
    }
    s->simulated = s->simulated || row->simulated;
    return true;
}

static void make_keyword(struct study *s)
{
    size_t size = 0;
    if (s->simulated)
        size = (size_t)snprintf(s->keyword, sizeof s->keyword, "SIMULATED");
    for (const char *c = s->name; *c && size + 1 < sizeof s->keyword; c++)
        if (isalnum((unsigned char)*c))
            s->keyword[size++] = *c;
    s->keyword[size] = '\0';
    if (size == 0)
        snprintf(s->keyword, sizeof s->keyword, "study");
}

// RFC 4180: quoted where the text holds a comma, a quote or a line end.
static void write_text(FILE *out, const char *text)
{
    if (!strpbrk(text, ",\"\r\n") && text[0]) {
        fputs(text, out);
        return;
    }
    fputc('"', out); // also an empty text, which is not a missing value
    for (const char *c = text; *c; c++) {
        if (*c == '"')
            fputc('"', out);
        fputc(*c, out);
    }
    fputc('"', out);
}

static void write_cell(FILE *out, bool header, const struct store_cell *cell)
{
    if (header) {
        fputs(cell->name, out);
    } else if (cell->kind == STORE_CELL_INTEGER) {
        fprintf(out, "%" PRId64, cell->integer);
    } else if (cell->kind == STORE_CELL_REAL) {
        char text[CELL_NUMBER_SIZE];
        fputs(cell_number(cell->real, text), out);
    } else if (cell->kind == STORE_CELL_TEXT) {
        write_text(out, cell->text);
    }
}

static bool write_row(void *user, bool header, const struct store_cell *cells, size_t count)
{
    FILE *out = user;
    for (size_t i = 0; i < count; i++) {
        if (i)
            fputc(',', out);
        write_cell(out, header, &cells[i]);
    }
    fputs("\r\n", out);
    return !ferror(out);
}

static FILE *open_file(const char *folder, const char *name, char *error, size_t error_size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    if (!file)
        snprintf(error, error_size, "%s: cannot be written: %s", path, strerror(errno));
    return file;
}

static bool close_file(FILE *file, const char *folder, const char *name, char *error, size_t error_size)
{
    bool ok = fflush(file) == 0 && !ferror(file) && fsync(fileno(file)) == 0;
    int reason = errno;
    ok = fclose(file) == 0 && ok;
    if (!ok)
        snprintf(error, error_size, "%s/%s: cannot be written: %s", folder, name, strerror(reason));
    return ok;
}

static bool write_table(struct store_reader *reader, const struct study *study, const char *folder,
                        const char *table, char *error, size_t error_size)
{
    char name[256];
    snprintf(name, sizeof name, "data/study-%s_description-%s_data.csv", study->keyword, table);
    FILE *out = open_file(folder, name, error, error_size);
    if (!out)
        return false;
    bool read = store_read_export(reader, table, write_row, out);
    if (!read && store_reader_error(reader)[0])
        snprintf(error, error_size, "%s", store_reader_error(reader));
    bool closed = close_file(out, folder, name, error, error_size);
    return read && closed;
}

static void write_column(struct json *json, const struct psych_ds_column *column)
{
    json_open(json, NULL, '{');
    json_text(json, "@type", "PropertyValue");
    json_text(json, "name", column->name);
    char text[512];
    snprintf(text, sizeof text, "%s%s%s%s", column->description, column->levels ? " Values: " : "",
             column->levels ? column->levels : "", column->levels ? "." : "");
    json_text(json, "description", text);
    if (column->unit)
        json_text(json, "unitText", column->unit);
    json_close(json, '}');
}

static bool write_description(const struct study *study, const char *folder, char *error, size_t error_size)
{
    FILE *out = open_file(folder, "dataset_description.json", error, error_size);
    if (!out)
        return false;
    char text[512];
    struct json json = {out, false};
    json_open(&json, NULL, '{');
    json_text(&json, "@context", "https://schema.org/");
    json_text(&json, "@type", "Dataset");
    snprintf(text, sizeof text, "%s%s", study->simulated ? "SIMULATED DATA: " : "", study->name);
    json_text(&json, "name", text);
    snprintf(
        text, sizeof text,
        "%sA study of foveated rendering by the protocol %s (SHA-256 %s), recorded by fovstudy %s, exported by "
        "fovstats " FOVSTUDY_VERSION ".",
        study->simulated ? "SIMULATED DATA: no person answered. " : "", study->name, study->hash,
        study->program);
    json_text(&json, "description", text);
    json_text(&json, "schemaVersion", "Psych-DS 1.4.0");
    json_open(&json, "variableMeasured", '[');
    for (const struct psych_ds_column *column = psych_ds_columns(); column->name; column++)
        write_column(&json, column);
    json_close(&json, ']');
    json_close(&json, '}');
    fputc('\n', out);
    return close_file(out, folder, "dataset_description.json", error, error_size);
}

static bool write_readme(const struct study *study, const char *folder, char *error, size_t error_size)
{
    FILE *out = open_file(folder, "README.md", error, error_size);
    if (!out)
        return false;
    fprintf(out, "# %s%s\n\n", study->simulated ? "SIMULATED DATA: " : "", study->name);
    fputs(
        "Every file in `data` is one table; `dataset_description.json` says what each column means, with "
        "unit and\n"
        "frame of reference. An empty cell is a missing value, never zero. Rows are joined by `trial_id`,\n"
        "`session_id`, `segment_id` and `condition_id`; `row_id` is unique in its file.\n\n"
        "`excluded` says whether a rule takes a row out, and `excluded_rules` which; such rows are here all "
        "the "
        "same,\n"
        "as are those of trials that are not `done`. The table `exclusions` says why. `gaze`, `gazechecks` and "
        "`frames`\n"
        "are as they were recorded: whether their trial or session is out stands in `trials` and `sessions`.\n"
        "Trials that were interrupted left rows of several attempts; the last one is the `attempt` of "
        "`trials`.\n\n"
        "`events` holds everything else that happened, switches, pauses and notes among it; `measurederrors` "
        "what\n"
        "simulated observers answer from; `protocols` the protocol's text. Times ending in `_ns` start anew "
        "with\n"
        "each segment.\n",
        out);
    return close_file(out, folder, "README.md", error, error_size);
}

bool psych_ds_write(struct store_reader *reader, const char *folder, char *error, size_t error_size)
{
    struct study study = {.simulated = false};
    if (!store_read_sessions(reader, note_study, &study)) {
        snprintf(error, error_size, "%s", store_reader_error(reader));
        return false;
    }
    make_keyword(&study);
    char data[4096];
    snprintf(data, sizeof data, "%s/data", folder);
    if (mkdir(data, 0777) != 0) {
        snprintf(error, error_size, "%s: cannot be made: %s", data, strerror(errno));
        return false;
    }
    bool ok = true;
    for (const char *const *table = store_export_tables(); ok && *table; table++)
        ok = write_table(reader, &study, folder, *table, error, error_size);
    return ok && write_description(&study, folder, error, error_size) &&
           write_readme(&study, folder, error, error_size);
}
