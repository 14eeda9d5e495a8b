"""What an exported dataset says of exclusions, against the study file, read here by the words of schema.sql: a row is
out by an exclusion of its participant, its session or its trial, but one of a trial whose rule ends in ':rating_pair'
takes out ratings alone. Then the answers that are left are counted as anybody would who filters the tables, and must be
those that fovstats counts. Prints each breach; fails if there is one.
Usage: export_excluded.py DIR STUDY.db CHOICES.json RATINGS.json"""
import csv, glob, json, sqlite3, sys

root, study = sys.argv[1:3]
faults = []
db = sqlite3.connect(f"file:{study}?mode=ro", uri=True)
person_of = dict(db.execute("SELECT id, participant_id FROM session"))
code_of = dict(db.execute("SELECT id, code FROM participant"))
id_of = {code: i for i, code in code_of.items()}
exclusions = db.execute("SELECT trial_id, session_id, participant_id, rule, rule_set FROM exclusion ORDER BY id").fetchall()


def verdict(person, session, trial, rating):
    rules = []
    for x_trial, x_session, x_person, rule, rule_set in exclusions:
        of_trial = trial is not None and x_trial == trial and (rating or not rule.endswith(":rating_pair"))
        if of_trial or (session is not None and x_session == session) or x_person == person:
            rules.append((rule, rule_set))
    return {"excluded": str(int(any(s != "stricter" for _, s in rules))),
            "excluded_stricter": str(int(any(s == "stricter" for _, s in rules))),
            "excluded_rules": "; ".join(f"{r} ({s})" for r, s in rules)}


def number(text):
    return int(text) if text not in ("", "n/a", None) else None


def check(where, row, rating):
    want = verdict(id_of[row["participant_id"]], number(row.get("session_id")), number(row.get("trial_id")), rating)
    for column, value in want.items():
        got = row.get(column)
        if (got or "") != value:
            faults.append(f"{where} {row}: {column} is {got!r}, not {value!r}")


def table(name):
    return list(csv.DictReader(open(glob.glob(f"{root}/psych-ds/data/*_description-{name}_data.csv")[0], newline="")))


TABLES = ("participants", "sessions", "trials", "choices", "ratings", "responses", "adjustments", "staircases",
          "exposures", "events")
rows = {name: table(name) for name in TABLES}
for name in TABLES:
    if not rows[name]:
        faults.append(f"{name}: the test's study has no row of it")
    for row in rows[name]:
        check(name, row, name == "ratings")

# BIDS: the same of every line; a subject's code and a session's number stand in tables of their own.
codes = {r["participant_id"]: r for r in csv.DictReader(open(f"{root}/bids/participants.tsv"), delimiter="\t")}
for subject, row in codes.items():
    check("participants.tsv", {k: v.replace("n/a", "") for k, v in row.items()} | {"participant_id": row["participant_code"]}, False)
lines = 0
for subject in codes:
    for session in csv.DictReader(open(f"{root}/bids/{subject}/{subject}_sessions.tsv"), delimiter="\t"):
        key = {"participant_id": codes[subject]["participant_code"], "session_id": session["study_session_id"]}
        check("sessions.tsv", {k: v.replace("n/a", "") for k, v in session.items()} | key, False)
        for file in glob.glob(f"{root}/bids/{subject}/{session['session_id']}/beh/*_events.tsv") + glob.glob(
                f"{root}/bids/{subject}/{session['session_id']}/beh/*_beh.tsv"):
            for row in csv.DictReader(open(file), delimiter="\t"):
                lines += 1
                check(file, {k: v.replace("n/a", "") for k, v in row.items()} | key, row.get("answer") == "rating")
counted = sum(len(rows[n]) for n in TABLES if n not in ("participants", "sessions", "events"))
if lines != counted:
    faults.append(f"BIDS has {lines} lines, Psych-DS {counted} rows")

# Choices that are left, cell by cell, are those that the tool counts.
cells = {}
for row in rows["choices"]:
    if row["excluded"] == "0" and row["trial_status"] == "done" and row["trial_kind"] in ("toggle", "sequential"):
        cell = cells.setdefault((row["block"], row["factors"].replace(" ", "")), [0, 0])
        cell[0] += row["chosen"] == "test"
        cell[1] += row["chosen"] in ("test", "reference")
tool = json.load(open(sys.argv[3]))
said = {(c["block"], json.dumps(c["factors"], separators=(",", ":"))): [c["k"], c["n"]] for c in tool["cells"]}
if cells != said or not cells:
    faults.append(f"choices: filtered {cells}, fovstats {said}")

# So are the people with a rating of both options, and their mean difference.
pairs = {}
for row in rows["ratings"]:
    order = json.loads(row["factors"] or "{}").get("order")
    if row["excluded"] == "0" and row["trial_status"] == "done" and order and row["trial_kind"] == "rate":
        pairs.setdefault(row["participant_id"], {})[order] = float(row["rating"]), row["condition_id"]
groups = {}
for pair in pairs.values():
    if len(pair) == 2:
        groups.setdefault((pair["first"][1], pair["second"][1]), []).append(pair["second"][0] - pair["first"][0])
want = sorted((len(g), round(sum(g) / len(g), 9)) for g in groups.values())
said = sorted((g["n"], round(g["second_mean"] - g["first_mean"], 9)) for q in json.load(open(sys.argv[4]))["questions"]
              for g in q["groups"])
if want != said or not want:
    faults.append(f"ratings: filtered {want}, fovstats {said}")
print("\n".join(map(str, faults[:20])))
sys.exit(bool(faults))
