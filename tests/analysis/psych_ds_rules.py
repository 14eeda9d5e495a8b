"""The published rules of Psych-DS that an exported folder must keep, and that its cells read back as the study file
has them. Rules: schema of psychds-validator 1.4.0 (JSON_INVALID, JSON_KEY_REQUIRED, INCORRECT_DATASET_TYPE,
FILENAME_KEYWORD_FORMATTING_ERROR, FILENAME_UNOFFICIAL_KEYWORD_WARNING, CSV_HEADER_MISSING, CSV_HEADER_REPEATED,
CSV_HEADER_LENGTH_MISMATCH, CSV_COLUMN_MISSING_FROM_METADATA, ROWID_VALUES_NOT_UNIQUE, FILE_EMPTY,
INVALID_SCHEMAORG_PROPERTY of what is written here). Prints each breach; fails if there is one.
Usage: psych_ds_rules.py DIR STUDY.db"""
import csv, io, json, os, re, sqlite3, struct, sys

root, study = sys.argv[1:3]
faults = []
OFFICIAL = {"study", "site", "subject", "session", "task", "condition", "trial", "stimulus", "description"}
about = json.load(open(f"{root}/dataset_description.json", encoding="utf-8"))
if about.get("@type") != "Dataset" or not about.get("@context", "").rstrip("/").endswith("schema.org"):
    faults.append("dataset_description.json is no schema.org Dataset")
for key in ("name", "description", "variableMeasured"):
    if not about.get(key):
        faults.append(f"dataset_description.json lacks {key}")
known = [v["name"] for v in about["variableMeasured"]]
if len(known) != len(set(known)) or any(v["@type"] != "PropertyValue" or not v["description"] for v in about["variableMeasured"]):
    faults.append("variableMeasured names a column twice or without a description")
if not os.path.getsize(f"{root}/README.md"):
    faults.append("README.md is empty")
used, tables = set(), {}
for name in sorted(os.listdir(f"{root}/data")):
    if not re.fullmatch(r"([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\.csv", name):
        faults.append(f"{name}: no keyword formatting")
    if {pair.split("-")[0] for pair in name.split("_")[:-1]} - OFFICIAL:
        faults.append(f"{name}: unofficial keyword")
    raw = open(f"{root}/data/{name}", "rb").read().decode("utf-8")
    rows = list(csv.reader(io.StringIO(raw, newline=""), strict=True))
    header = rows[0] if rows else []
    if not header or len(header) != len(set(header)):
        faults.append(f"{name}: header missing or repeated")
    if any(len(row) != len(header) for row in rows):
        faults.append(f"{name}: rows and header differ in length")
    if set(header) - set(known):
        faults.append(f"{name}: columns without description: {set(header) - set(known)}")
    if "row_id" in header and len({r[header.index("row_id")] for r in rows[1:]}) != len(rows) - 1:
        faults.append(f"{name}: row_id is not unique")
    used |= set(header)
    tables[name.split("_description-")[1][:-9]] = [dict(zip(header, row)) for row in rows[1:]]
if set(known) - used:
    faults.append(f"described and in no file: {set(known) - used}")

# Read back bit for bit, and nothing lost.
db = sqlite3.connect(f"file:{study}?mode=ro", uri=True)
for table, sql_table, key, columns in (
        ("gaze", "gaze", "id", ("x_deg", "y_deg", "pupil_mm", "device_ns", "confidence")),
        ("frames", "frame", "id", ("gpu_us", "cpu_us", "start_ns", "fade_level")),
        ("ratings", "rating", "id", ("question", "answered_ns")),
        ("choices", "choice", "id", ("reaction_ns", "toggles"))):
    stored = db.execute(f"SELECT {key}, {', '.join(columns)} FROM {sql_table} ORDER BY {key}").fetchall()
    if len(stored) != len(tables[table]):
        faults.append(f"{table}: {len(tables[table])} rows of {len(stored)}")
    for row, want in zip(tables[table], stored):
        for column, value in zip(columns, want[1:]):
            text = row[column]
            same = text == "" if value is None else (
                struct.pack("d", float(text)) == struct.pack("d", value) if isinstance(value, float) else text == str(value))
            if not same or row["row_id"] != str(want[0]):
                faults.append(f"{table} {want[0]}: {column} is {text!r}, stored {value!r}")
people = {r[0] for r in db.execute("SELECT code FROM participant")}
if {r["participant_id"] for r in tables["participants"]} != people:
    faults.append("participants differ")
if db.execute("SELECT kind FROM participant").fetchone()[0] == "simulated" and not (
        "SIMULATED" in about["name"] and all("SIMULATED" in n for n in os.listdir(f"{root}/data"))):
    faults.append("simulated data is not branded")
print("\n".join(map(str, faults[:20])))
sys.exit(bool(faults))
