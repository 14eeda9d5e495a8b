"""The published rules of BIDS that an exported folder must keep, and that its gaze reads back as the study file has it.
Rules: BIDS specification 1.11.1 (file names and entities of beh, dataset_description, participants and sessions tables,
compressed tabular files; Physiological recordings: SamplingFrequency, StartTime and Columns required, no header;
Eye-tracking: PhysioType, RecordedEye, SampleCoordinateSystem and a recording label required, timestamp, x_coordinate
and y_coordinate first; physioevents: onset first, a physio file of the same name, OnsetSource a column of it).
Prints each breach; fails if there is one. EVENTS.csv: what `fovstats gaze --events` says of the same file; all of it must be there.
Usage: bids_rules.py DIR [STUDY.db [EVENTS.csv]]"""
import csv, gzip, json, math, os, re, sqlite3, struct, sys

root = sys.argv[1]
faults = []
LABEL = "[0-9a-zA-Z+]+"
BEH = re.compile(rf"sub-({LABEL})/ses-({LABEL})/beh/sub-\1_ses-\2_task-({LABEL})(_run-[0-9]+)?"
                 rf"(_(beh|events)\.tsv|_recording-({LABEL})_(physio|physioevents)\.(tsv\.gz|json))")
OTHER = re.compile(rf"dataset_description\.json|README\.md|participants\.(tsv|json)|task-{LABEL}_(beh|events)\.json|"
                   rf"sub-({LABEL})/sub-\3_sessions\.(tsv|json)")
NUMBER = re.compile(r"-?[0-9]+(\.[0-9]+)?([eE][-+]?[0-9]+)?")


def load(name):
    try:
        return json.load(open(f"{root}/{name}", encoding="utf-8"))
    except (OSError, ValueError) as error:
        faults.append(f"{name}: {error}")
        return {}


def number(text):
    return text == "n/a" or bool(NUMBER.fullmatch(text))


def described(name, about, columns):
    for column in columns:
        if not isinstance(about.get(column), dict) or not about[column].get("Description"):
            faults.append(f"{name}: column {column} is not described")


def table(name):
    rows = [line.split("\t") for line in open(f"{root}/{name}", encoding="utf-8", newline="").read().split("\n")]
    if rows.pop() != [""]:
        faults.append(f"{name}: the last line has no end")
    if len(set(rows[0])) != len(rows[0]) or any(len(row) != len(rows[0]) or "" in row for row in rows):
        faults.append(f"{name}: header repeated, rows of another length or empty cells")
    return rows[0], [dict(zip(rows[0], row)) for row in rows[1:]]


def compressed(name, about):
    raw = open(f"{root}/{name}", "rb").read()
    if raw[:2] != b"\x1f\x8b" or raw[4:8] != b"\0\0\0\0":
        faults.append(f"{name}: no gzip, or its header holds a time")
    columns = about.get("Columns", [])
    rows = [line.split("\t") for line in gzip.decompress(raw).decode("utf-8").split("\n")[:-1]]
    if not columns or len(set(columns)) != len(columns) or any(len(row) != len(columns) or "" in row for row in rows):
        faults.append(f"{name}: rows do not fit Columns")
    if rows and rows[0][0] == (columns or [""])[0]:
        faults.append(f"{name}: a header")
    described(name, about, columns)
    return columns, rows


def physio(name, about):
    for key, kinds in (("SamplingFrequency", (int, float)), ("StartTime", (int, float)), ("Columns", list)):
        if not isinstance(about.get(key), kinds) or isinstance(about.get(key), bool):
            faults.append(f"{name}: {key} is missing")
    if isinstance(about.get("SamplingFrequency"), (int, float)) and not about["SamplingFrequency"] > 0:
        faults.append(f"{name}: SamplingFrequency is not above 0")
    if about.get("PhysioType") != "eyetrack":
        faults.append(f"{name}: PhysioType is not eyetrack")
    if about.get("RecordedEye") not in ("left", "right", "cyclopean"):
        faults.append(f"{name}: RecordedEye")
    if not isinstance(about.get("SampleCoordinateSystem"), str):
        faults.append(f"{name}: SampleCoordinateSystem is missing")
    columns, rows = compressed(name, about)
    if columns[:3] != ["timestamp", "x_coordinate", "y_coordinate"]:
        faults.append(f"{name}: the first columns are {columns[:3]}")
    if "pupil_size" in columns and not re.search("area|diameter", about["pupil_size"]["Description"]):
        faults.append(f"{name}: pupil_size is neither area nor diameter")
    for column in ("x_coordinate", "y_coordinate"):
        if not about.get(column, {}).get("Units"):
            faults.append(f"{name}: {column} has no Units")
    if any(not number(cell) for row in rows for cell in row):
        faults.append(f"{name}: a cell is no number")
    return rows


def events(name, about, names):
    sidecar = name.replace("physioevents.tsv.gz", "physio.json")
    if name.replace("physioevents", "physio") not in names or sidecar not in names:
        faults.append(f"{name}: there is no recording of that name")
        return
    columns, rows = compressed(name, about)
    if columns[:1] != ["onset"] or about.get("OnsetSource") not in load(sidecar).get("Columns", []):
        faults.append(f"{name}: onset is not first, or OnsetSource is no column of the recording")
    if any(not number(row[0]) or not number(row[1]) or float(row[1]) < 0 for row in rows):
        faults.append(f"{name}: onset or duration is no number")


names = {os.path.relpath(os.path.join(folder, file), root) for folder, _, files in os.walk(root) for file in files}
for name in sorted(names):
    if not BEH.fullmatch(name) and not OTHER.fullmatch(name):
        faults.append(f"{name}: no name of BIDS")
about = load("dataset_description.json")
if not about.get("Name") or about.get("BIDSVersion") != "1.11.1" or about.get("DatasetType") != "raw":
    faults.append("dataset_description.json: Name, BIDSVersion or DatasetType")
if "README.md" not in names or not os.path.getsize(f"{root}/README.md"):
    faults.append("README.md is missing or empty")
header, people = table("participants.tsv")
subjects = {name.split("/")[0] for name in names if "/" in name}
if header[0] != "participant_id" or {p["participant_id"] for p in people} != subjects or len(people) != len(subjects):
    faults.append("participants.tsv: participant_id is not first, or lists others than the folders")
described("participants.tsv", load("participants.json"), header[1:])
gaze = {}
for name in sorted(names):
    kind = BEH.fullmatch(name)
    if name.endswith("_sessions.tsv"):
        header, rows = table(name)
        folders = {n.split("/")[1] for n in names if n.startswith(name.split("/")[0] + "/ses-")}
        if header[0] != "session_id" or not folders <= {r["session_id"] for r in rows}:
            faults.append(f"{name}: session_id is not first, or a session is missing")
        described(name, load(name[:-4] + ".json"), header[1:])
    elif kind and name.endswith(".tsv"):
        header, rows = table(name)
        described(name, load(f"task-{kind[3]}_{kind[6]}.json"), header)
        if kind[6] == "events":
            if header[:2] != ["onset", "duration"] or any(not number(r["onset"]) or not number(r["duration"]) for r in rows):
                faults.append(f"{name}: onset and duration are not first, or no numbers")
            onsets = [float(r["onset"]) for r in rows]
            if onsets != sorted(onsets):
                faults.append(f"{name}: not in order of onset")
    elif kind and name.endswith(".gz"):
        sidecar = name[:-7] + ".json"
        if sidecar not in names:
            faults.append(f"{name}: no JSON file beside it")
        elif kind[8] == "physio":
            gaze[name] = physio(name, load(sidecar))
        else:
            events(name, load(sidecar), names)

# Nothing lost, every bit kept.
if len(sys.argv) > 2:
    db = sqlite3.connect(f"file:{sys.argv[2]}?mode=ro", uri=True)
    stored = {}
    for segment, eye, *row in db.execute("SELECT segment_id, eye, device_ns, x_deg, y_deg, pupil_mm, host_ns, valid, "
                                         "confidence, trial_id FROM gaze ORDER BY id"):
        stored.setdefault((segment, eye), []).append(row)
    # A rate can be measured where the usual step is between 0.1 and 99 ms; recordings without are not BIDS.
    wanted = []
    for rows in stored.values():
        steps = sorted(b[0] - a[0] for a, b in zip(rows, rows[1:]))
        if steps and 1e5 < steps[len(steps) // 2] < 99e6:
            wanted.append(rows)

    def same(text, value):
        if value is None:
            return text == "n/a"
        return struct.pack("d", float(text)) == struct.pack("d", value) if isinstance(value, float) else text == str(value)

    def same_row(texts, row):
        host = texts[4].replace(".", "")
        return str(int(host)) == str(row[4]) and all(same(t, v) for i, (t, v) in enumerate(zip(texts, row)) if i != 4)

    def same_rows(rows, want):
        return len(rows) == len(want) and all(same_row(r, w) for r, w in zip(rows, want))

    left = list(gaze.values())
    for want in wanted:
        match = next((i for i, rows in enumerate(left) if same_rows(rows, want)), None)
        if match is None:
            faults.append(f"gaze: {len(want)} stored samples are in no recording")
        else:
            left.pop(match)
    if left:
        faults.append(f"gaze: {len(left)} recordings are not in the study file")
    for table_name, key, kind in (("choice", "answer", "choice"), ("rating", "answer", "rating"),
                                  ("response", "answer", "response"), ("exposure", "trial_type", "exposure"),
                                  ("adjust_step", "trial_type", "adjust_step"),
                                  ("staircase_step", "answer", "staircase_step")):
        written = sum(1 for n in names if n.endswith("_beh.tsv" if key == "answer" else "_events.tsv")
                      for row in table(n)[1] if row[key] == kind)
        count = db.execute(f"SELECT count(*) FROM {table_name}").fetchone()[0]
        if written != count:
            faults.append(f"{table_name}: {written} rows of {count}")
    codes = {r[0] for r in db.execute("SELECT code FROM participant WHERE id IN (SELECT participant_id FROM session)")}
    plain = {re.sub("[\t\r\n]", " ", c) for c in codes}
    if {p["participant_code"] for p in people} != plain:
        faults.append("participants differ")
    if db.execute("SELECT kind FROM participant").fetchone()[0] == "simulated" and not (
            "SIMULATED" in about.get("Name", "") and all("task-SIMULATED" in n for n in names if "/beh/" in n)):
        faults.append("simulated data is not branded")
if len(sys.argv) > 3:
    found = {}
    for name in names:
        if name.endswith("_physioevents.tsv.gz"):
            eye = load(name.replace("physioevents.tsv.gz", "physio.json"))["RecordedEye"].replace("cyclopean", "both")
            for onset, duration, kind, x, y, *size, cut, trial in compressed(name, load(name[:-7] + ".json"))[1]:
                found[trial, eye, kind, onset] = (1000 * float(duration), float(x), float(y), float(cut),
                                                    *(0 if v == "n/a" else float(v) for v in size))
    for row in csv.DictReader(open(sys.argv[3])):
        event = found.pop((row["trial"], row["eye"], row["kind"], row["start_ns"]), None)
        want = [float(row[key] or 0) for key in ("duration_ms", "x_deg", "y_deg", "cut", "amplitude_deg", "peak_deg_s")]
        if not event or any(not math.isclose(a, b, rel_tol=1e-5, abs_tol=1e-9) for a, b in zip(event, want)):
            faults.append(f"event {row}: exported as {event}")
    if any(trial != "n/a" for trial, *_ in found):
        faults.append(f"{len(found)} events that gaze --events does not have")
print("\n".join(map(str, faults[:20])))
sys.exit(bool(faults))
