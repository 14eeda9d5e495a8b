-- The study file: one SQLite database per study. This file is also its data dictionary.
--
-- Times ending in _ns are integer nanoseconds since the origin of the row's segment (segment.mono_origin_ns on that
-- segment's clock); _us are microseconds, _s seconds. Columns ending in _at are ISO 8601 UTC text. Angles are
-- degrees in the head's frame, per eye: x = atan2(x, -z), y = atan2(y, hypot(x, z)), right and up positive.
-- Truth values are 0 or 1. NULL always means "not known" or "does not apply", never zero. Columns said to be JSON
-- hold one JSON object. Seeds are unsigned 64-bit numbers, stored with the same bits as signed ones.
--
-- A change of anything below needs a new user_version and a step in migrate.c.

PRAGMA application_id = 1180062548; -- the bytes "FVST"
PRAGMA user_version = 1;

-- A protocol file, as it was read.
CREATE TABLE protocol (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL CHECK (name <> ''),
    sha256 TEXT NOT NULL UNIQUE CHECK (length(sha256) = 64 AND NOT sha256 GLOB '*[^0-9a-f]*'), -- of text
    text TEXT NOT NULL -- the whole file
) STRICT;

-- A person, or a simulated observer. No name and no birth date.
CREATE TABLE participant (
    id INTEGER PRIMARY KEY,
    number INTEGER NOT NULL CHECK (number >= 1), -- decides the trial order; see the trigger below
    code TEXT NOT NULL UNIQUE CHECK (code <> ''),
    kind TEXT NOT NULL CHECK (kind IN ('person', 'simulated')),
    attributes TEXT NOT NULL CHECK (json_valid(attributes)) -- JSON: age in years, gender, VR experience, ...
) STRICT;
CREATE INDEX participant_number ON participant (number);

-- One participant sitting down once, possibly with interruptions.
CREATE TABLE session (
    id INTEGER PRIMARY KEY,
    protocol_id INTEGER NOT NULL REFERENCES protocol (id),
    participant_id INTEGER NOT NULL REFERENCES participant (id),
    seed INTEGER NOT NULL, -- with protocol and number it gives the trial order
    status TEXT NOT NULL CHECK (status IN ('running', 'complete', 'aborted')),
    started_at TEXT NOT NULL,
    ended_at TEXT,
    consent_at TEXT, -- NULL: no consent recorded
    consent_version TEXT CHECK ((consent_at IS NULL) = (consent_version IS NULL)),
    device TEXT,  -- GPU; NULL where nothing was rendered
    driver TEXT,  -- its driver and version
    display TEXT, -- as given to --display
    refresh_hz REAL CHECK (refresh_hz > 0),
    width_px INTEGER CHECK (width_px > 0),   -- per eye
    height_px INTEGER CHECK (height_px > 0), -- per eye
    fov_deg REAL CHECK (fov_deg > 0 AND fov_deg < 180), -- vertical, per eye
    settings TEXT NOT NULL CHECK (json_valid(settings)) -- JSON: everything else the session was started with
) STRICT;
CREATE INDEX session_participant ON session (participant_id);

-- One run of the program within a session; a resumed session has several.
CREATE TABLE segment (
    id INTEGER PRIMARY KEY,
    session_id INTEGER NOT NULL REFERENCES session (id),
    started_at TEXT NOT NULL,
    mono_origin_ns INTEGER NOT NULL, -- the clock's reading at the segment's time 0
    clock TEXT NOT NULL CHECK (clock IN ('monotonic', 'simulated')),
    boot_id TEXT, -- of the computer; the monotonic clock compares only within one
    app_version TEXT NOT NULL,
    reason TEXT NOT NULL -- 'start', 'resume' or a sentence
) STRICT;
CREATE INDEX segment_session ON segment (session_id);

-- A rendering mode with every parameter resolved, each distinct one once.
CREATE TABLE condition (
    id INTEGER PRIMARY KEY,
    mode TEXT NOT NULL CHECK (mode <> ''),
    parameters TEXT NOT NULL CHECK (json_valid(parameters)), -- JSON, in the order of the mode's table
    UNIQUE (mode, parameters)
) STRICT;

-- A planned trial. option_a and option_b are the slots as the participant had them, after counterbalancing.
CREATE TABLE trial (
    id INTEGER PRIMARY KEY,
    session_id INTEGER NOT NULL REFERENCES session (id),
    segment_id INTEGER REFERENCES segment (id), -- of its last attempt; origin of started_ns and ended_ns
    ordinal INTEGER NOT NULL CHECK (ordinal >= 1), -- place in the session's order
    block TEXT NOT NULL,
    kind TEXT NOT NULL CHECK (kind IN ('toggle', 'sequential', 'rate', 'adjust', 'staircase', 'task', 'practice',
                                       'catch', 'null')),
    scene TEXT NOT NULL,
    settings TEXT NOT NULL CHECK (json_valid(settings)), -- JSON: SSAO, TAA, moving objects, size
    factors TEXT NOT NULL CHECK (json_valid(factors)),   -- JSON: factor -> level
    option_a INTEGER REFERENCES condition (id),
    option_b INTEGER REFERENCES condition (id), -- NULL in trials of one option
    test_slot TEXT CHECK (test_slot IN ('a', 'b')), -- the slot holding the protocol's first option
    first_shown TEXT CHECK (first_shown IN ('a', 'b')),
    fixation TEXT,
    seed INTEGER NOT NULL,
    repeat_of INTEGER REFERENCES trial (id), -- the flagged trial that this one repeats
    status TEXT NOT NULL CHECK (status IN ('planned', 'running', 'done', 'skipped', 'invalid')),
    attempt INTEGER NOT NULL DEFAULT 0 CHECK (attempt >= 0), -- how often it was started
    started_ns INTEGER, -- of its last attempt
    ended_ns INTEGER,
    UNIQUE (session_id, ordinal)
) STRICT;
CREATE INDEX trial_option_a ON trial (option_a);
CREATE INDEX trial_option_b ON trial (option_b);

-- The answer to a two-alternative question; a trial has at most one.
CREATE TABLE choice (
    id INTEGER PRIMARY KEY,
    trial_id INTEGER NOT NULL UNIQUE REFERENCES trial (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    chosen TEXT NOT NULL CHECK (chosen IN ('a', 'b', 'equal')), -- a slot, not a condition
    correct INTEGER CHECK (correct IN (0, 1)), -- NULL for a preference
    reaction_ns INTEGER CHECK (reaction_ns >= 0), -- from the moment an answer was allowed
    answered_ns INTEGER NOT NULL,
    toggles INTEGER NOT NULL CHECK (toggles >= 0) -- switches of option before the answer
) STRICT;

-- A rating of something on a scale, within a trial or of the session.
CREATE TABLE rating (
    id INTEGER PRIMARY KEY,
    trial_id INTEGER REFERENCES trial (id),
    session_id INTEGER REFERENCES session (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    question TEXT NOT NULL,
    subject TEXT NOT NULL CHECK (subject IN ('a', 'b', 'scene')),
    condition_id INTEGER REFERENCES condition (id), -- what was on screen while it was rated
    value REAL NOT NULL,
    scale_min REAL NOT NULL,
    scale_max REAL NOT NULL,
    answered_ns INTEGER NOT NULL,
    CHECK ((trial_id IS NULL) <> (session_id IS NULL)),
    CHECK (scale_min < scale_max AND value BETWEEN scale_min AND scale_max),
    UNIQUE (trial_id, question, subject)
) STRICT;
CREATE INDEX rating_session ON rating (session_id) WHERE session_id IS NOT NULL;

-- Any other answer: a count, a final adjustment.
CREATE TABLE response (
    id INTEGER PRIMARY KEY,
    trial_id INTEGER NOT NULL REFERENCES trial (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    question TEXT NOT NULL,
    value REAL NOT NULL,
    expected REAL, -- the right answer, where there is one
    answered_ns INTEGER NOT NULL,
    device TEXT, -- what it was entered with
    UNIQUE (trial_id, question)
) STRICT;

-- A step of the method of adjustment.
CREATE TABLE adjust_step (
    id INTEGER PRIMARY KEY,
    trial_id INTEGER NOT NULL REFERENCES trial (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    at_ns INTEGER NOT NULL,
    parameter TEXT NOT NULL,
    value REAL NOT NULL -- after the step, in the parameter's unit
) STRICT;
CREATE INDEX adjust_step_trial ON adjust_step (trial_id);

-- A step of an adaptive staircase: the level shown and what came of it.
CREATE TABLE staircase_step (
    id INTEGER PRIMARY KEY,
    trial_id INTEGER NOT NULL REFERENCES trial (id),
    level REAL NOT NULL,
    outcome INTEGER NOT NULL CHECK (outcome >= 0), -- 0 wrong, 1 right; QUEST+ may have more
    reversal INTEGER NOT NULL CHECK (reversal IN (0, 1)),
    estimate REAL -- of the threshold, after the step
) STRICT;
CREATE INDEX staircase_step_trial ON staircase_step (trial_id);

-- A stretch of one option on screen.
CREATE TABLE exposure (
    id INTEGER PRIMARY KEY,
    trial_id INTEGER NOT NULL REFERENCES trial (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    attempt INTEGER NOT NULL CHECK (attempt >= 1),
    option TEXT NOT NULL CHECK (option IN ('a', 'b')),
    start_ns INTEGER NOT NULL,
    end_ns INTEGER NOT NULL,
    full_start_ns INTEGER, -- free of fade; NULL where it never was
    full_end_ns INTEGER,
    CHECK (start_ns <= end_ns),
    CHECK ((full_start_ns IS NULL) = (full_end_ns IS NULL)),
    CHECK (full_start_ns IS NULL OR (start_ns <= full_start_ns AND full_start_ns <= full_end_ns
                                     AND full_end_ns <= end_ns))
) STRICT;
CREATE INDEX exposure_trial ON exposure (trial_id);

-- A sample of the eye tracker. Every sample is kept, valid or not.
CREATE TABLE gaze (
    id INTEGER PRIMARY KEY,
    session_id INTEGER NOT NULL REFERENCES session (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    trial_id INTEGER REFERENCES trial (id), -- NULL between trials
    device_ns INTEGER NOT NULL, -- the tracker's own clock
    host_ns INTEGER NOT NULL,   -- when it arrived
    eye TEXT NOT NULL CHECK (eye IN ('left', 'right', 'both')),
    x_deg REAL, -- NULL where not valid
    y_deg REAL,
    pupil_mm REAL,
    valid INTEGER NOT NULL CHECK (valid IN (0, 1)),
    confidence REAL CHECK (confidence BETWEEN 0 AND 1)
) STRICT;
CREATE INDEX gaze_trial ON gaze (trial_id);

-- A point of an independent check of the eye tracker.
CREATE TABLE gaze_check (
    id INTEGER PRIMARY KEY,
    session_id INTEGER NOT NULL REFERENCES session (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    at_ns INTEGER NOT NULL,
    block TEXT NOT NULL,
    x_deg REAL NOT NULL, -- where the point was
    y_deg REAL NOT NULL,
    eye TEXT NOT NULL CHECK (eye IN ('left', 'right', 'both')),
    accuracy_deg REAL, -- mean distance from the point; NULL where no sample was valid
    rms_s2s_deg REAL,  -- root mean square from sample to sample
    sd_deg REAL,
    loss REAL NOT NULL CHECK (loss BETWEEN 0 AND 1), -- share of samples that were missing or not valid
    passed INTEGER NOT NULL CHECK (passed IN (0, 1))
) STRICT;
CREATE INDEX gaze_check_session ON gaze_check (session_id);

-- A frame that was shown, also gray ones.
CREATE TABLE frame (
    id INTEGER PRIMARY KEY,
    session_id INTEGER NOT NULL REFERENCES session (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    trial_id INTEGER REFERENCES trial (id), -- NULL between trials
    attempt INTEGER CHECK (attempt >= 1),
    number INTEGER NOT NULL, -- counts up by one per frame of a segment
    option TEXT CHECK (option IN ('a', 'b')),
    condition_id INTEGER REFERENCES condition (id), -- what was rendered; NULL for gray and text
    phase TEXT NOT NULL CHECK (phase IN ('stimulus', 'fade', 'question', 'rest')),
    fade_level REAL NOT NULL CHECK (fade_level BETWEEN 0 AND 1), -- 0 the image, 1 gray
    start_ns INTEGER NOT NULL, -- work on the frame began
    cpu_us REAL,
    gpu_us REAL,
    present_ns INTEGER, -- light leaves the display
    present_estimated INTEGER NOT NULL CHECK (present_estimated IN (0, 1)), -- 1: computed, not reported by the display
    late INTEGER CHECK (late IN (0, 1)), -- shown at least one refresh after its turn; NULL where the refresh rate is not known
    gaze_id INTEGER REFERENCES gaze (id), -- the sample the fovea followed
    gaze_age_us REAL, -- of that sample at start_ns
    fovea TEXT CHECK (fovea IS NULL OR json_valid(fovea)), -- JSON {"left":[x,y],"right":[x,y]}, degrees, as used
    fovea_source TEXT CHECK (fovea_source IN ('gaze', 'target', 'fixed', 'lost')),
    -- JSON of what was really rendered, where it differs from the condition
    effective TEXT CHECK (effective IS NULL OR json_valid(effective)),
    target_x_deg REAL, -- the fixation target
    target_y_deg REAL,
    -- JSON {"position":[x,y,z],"orientation":[x,y,z,w]}, metres, world
    head_pose TEXT CHECK (head_pose IS NULL OR json_valid(head_pose)),
    shaded_px INTEGER, -- pixels of both eyes shaded
    triangles INTEGER  -- both eyes, after culling
) STRICT;
CREATE INDEX frame_trial ON frame (trial_id);
CREATE INDEX frame_gaze ON frame (gaze_id) WHERE gaze_id IS NOT NULL;

-- The image error of one condition against another on a scene: what simulated observers answer from.
CREATE TABLE measured_error (
    condition_id INTEGER NOT NULL REFERENCES condition (id),
    reference_id INTEGER NOT NULL REFERENCES condition (id),
    scene TEXT NOT NULL,
    metric TEXT NOT NULL CHECK (metric <> ''),
    value REAL NOT NULL,
    PRIMARY KEY (condition_id, reference_id, scene, metric)
) STRICT, WITHOUT ROWID;

-- Anything else that happened.
CREATE TABLE event (
    id INTEGER PRIMARY KEY,
    session_id INTEGER NOT NULL REFERENCES session (id),
    segment_id INTEGER NOT NULL REFERENCES segment (id),
    trial_id INTEGER REFERENCES trial (id),
    at_ns INTEGER NOT NULL,
    kind TEXT NOT NULL CHECK (kind <> ''),
    detail TEXT -- words or JSON
) STRICT;
CREATE INDEX event_session ON event (session_id);
CREATE INDEX event_trial ON event (trial_id) WHERE trial_id IS NOT NULL;

-- A rule that takes a trial, a session or a participant out of the analysis.
CREATE TABLE exclusion (
    id INTEGER PRIMARY KEY,
    trial_id INTEGER REFERENCES trial (id),
    session_id INTEGER REFERENCES session (id),
    participant_id INTEGER REFERENCES participant (id),
    -- the protocol's word or 'manual'; one that ends in ':rating_pair' takes ratings out and leaves a choice alone
    rule TEXT NOT NULL CHECK (rule <> ''),
    rule_set TEXT NOT NULL CHECK (rule_set IN ('planned', 'stricter', 'late')),
    reason TEXT NOT NULL,
    "by" TEXT NOT NULL, -- program or person
    applied_at TEXT NOT NULL,
    CHECK ((trial_id IS NOT NULL) + (session_id IS NOT NULL) + (participant_id IS NOT NULL) = 1)
) STRICT;
CREATE INDEX exclusion_trial ON exclusion (trial_id) WHERE trial_id IS NOT NULL;
CREATE INDEX exclusion_participant ON exclusion (participant_id) WHERE participant_id IS NOT NULL;

-- Simulated and real people never share a file.
CREATE TRIGGER participant_one_kind BEFORE INSERT ON participant
WHEN EXISTS (SELECT 1 FROM participant WHERE kind <> NEW.kind)
BEGIN
    SELECT RAISE(ABORT, 'simulated observers and people never share a study file');
END;

-- A number has one holder, unless the earlier holder was excluded as a person.
CREATE TRIGGER participant_one_number BEFORE INSERT ON participant
WHEN EXISTS (SELECT 1 FROM participant AS p WHERE p.number = NEW.number
             AND NOT EXISTS (SELECT 1 FROM exclusion AS e WHERE e.participant_id = p.id))
BEGIN
    SELECT RAISE(ABORT, 'the participant number is taken');
END;
