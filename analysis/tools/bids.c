// What every BIDS dataset has, and the order in which its files are written.
#include "analysis/tools/bids.h"

#include "analysis/tools/bids_private.h"

static bool write_description(struct bids *b)
{
    FILE *out = bids_open(b, "dataset_description.json");
    if (!out)
        return false;
    char text[512];
    snprintf(text, sizeof text, "%s%s", b->simulated ? "SIMULATED DATA: " : "", b->tasks.items[0].text);
    struct json json = {out, false};
    json_open(&json, NULL, '{');
    json_text(&json, "Name", text);
    json_text(&json, "BIDSVersion", "1.11.1");
    json_text(&json, "DatasetType", "raw");
    json_open(&json, "GeneratedBy", '[');
    json_open(&json, NULL, '{');
    json_text(&json, "Name", "fovstats");
    json_text(&json, "Version", FOVSTUDY_VERSION);
    json_text(&json, "Description",
              b->simulated ? "Exported from a study file. SIMULATED DATA: no person answered."
                           : "Exported from a study file.");
    json_close(&json, '}');
    json_close(&json, ']');
    json_close(&json, '}');
    fputc('\n', out);
    return bids_close(b, out, "dataset_description.json");
}

static bool write_readme(struct bids *b)
{
    FILE *out = bids_open(b, "README.md");
    if (!out)
        return false;
    fprintf(out, "# %s%s\n\n", b->simulated ? "SIMULATED DATA: " : "", b->tasks.items[0].text);
    fputs(
        "A study of foveated rendering as a BIDS dataset. A session is a sitting, a run is one run of the "
        "program\n"
        "within it; times in seconds count from time 0 of the run and start anew with each. In `beh`:\n\n"
        "- `*_events.tsv`: trials, stretches of one option on the screen, adjustments;\n"
        "- `*_beh.tsv`: an answer a row;\n"
        "- `*_recording-eye1_physio.tsv.gz`: samples of the left eye (`eye2` the right eye, `eye3` one "
        "direction\n"
        "  for both), every one as the tracker sent it; directions of gaze in degrees, right and up positive;\n"
        "- `*_physioevents.tsv.gz`: fixations and saccades found in them.\n\n"
        "`n/a` is a missing value. `excluded` says whether a rule takes a row out, and `excluded_rules` which; "
        "such\n"
        "rows are here all the same. Trials that were interrupted left rows of several `attempt`s; fixations "
        "and\n"
        "saccades are of the last attempt, and of the time between trials. Tabs and line ends in texts became "
        "spaces.\n"
        "Frames, checks of the tracker, notes and other events, image errors and the protocol's text are in "
        "the\n"
        "Psych-DS export, which has the same numbers of sessions, trials and conditions.\n",
        out);
    if (b->counts.samples_without_rate)
        fprintf(out,
                "\n%lld samples of gaze are in the Psych-DS export alone: BIDS demands a sampling frequency, "
                "and theirs "
                "cannot be\nmeasured (too few in a row, or not between 10 Hz and 10 kHz).\n",
                (long long)b->counts.samples_without_rate);
    return bids_close(b, out, "README.md");
}

bool bids_write(struct store_reader *reader, const char *folder, struct bids_counts *out, char *error,
                size_t error_size)
{
    struct bids bids = {.reader = reader, .folder = folder, .error = error, .error_size = error_size};
    bids_fail(&bids, "not enough memory"); // until something else fails
    bool ok = bids_layout_load(&bids);
    if (ok && bids.session_count == 0)
        ok = bids_fail(&bids, "%s: the study is empty: no session was recorded", store_reader_path(reader));
    ok = ok && write_description(&bids) && bids_write_people(&bids) && bids_write_sessions(&bids) &&
         bids_write_trials(&bids) && bids_write_gaze(&bids) && write_readme(&bids);
    bids.counts.runs = (int64_t)bids.run_count;
    *out = bids.counts;
    bids_layout_free(&bids);
    return ok;
}
