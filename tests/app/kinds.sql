-- What a finished study of kinds.yaml holds, whoever answered: each line is a rule and how many rows break it.
.mode list
PRAGMA integrity_check;
SELECT 'rows that refer to nothing', count(*) FROM pragma_foreign_key_check;
SELECT 'sessions that did not end', count(*) FROM session WHERE status <> 'complete';
SELECT 'plans that are not told', count(*) FROM session WHERE settings -> '$.planned' IS NOT
    '[{"method":"binomial","of":"choice","per":"cell"},{"method":"mean","of":"reaction","per":"-"}]';
SELECT 'log rows lost', count(*) FROM event WHERE kind LIKE 'log_%';
SELECT 'trials left', count(*) FROM trial WHERE status NOT IN ('done', 'skipped', 'invalid');
SELECT 'trials without a time', count(*) FROM trial WHERE status = 'done' AND NOT (started_ns < ended_ns AND attempt > 0);

-- A missed deadline brings the trial again, but for staircases, whose next trial takes its place.
CREATE TEMP VIEW again AS SELECT t.*, (SELECT count(*) FROM trial r WHERE r.repeat_of = t.id) AS repeats FROM trial t;
SELECT 'repetitions', count(*) FROM again WHERE repeats <> (status = 'invalid' AND kind <> 'staircase');
SELECT 'copies that differ', count(*) FROM trial r JOIN trial t ON t.id = r.repeat_of
WHERE r.ordinal <= t.ordinal OR r.block <> t.block OR r.kind <> t.kind OR r.scene <> t.scene OR r.seed <> t.seed
   OR r.settings <> t.settings OR r.factors <> t.factors OR r.test_slot <> t.test_slot OR r.first_shown <> t.first_shown
   OR r.option_a <> t.option_a OR r.option_b IS NOT t.option_b;
SELECT 'invalid trials with an answer', count(*) FROM trial t WHERE status = 'invalid'
AND (EXISTS (SELECT 1 FROM choice WHERE trial_id = t.id) OR EXISTS (SELECT 1 FROM rating WHERE trial_id = t.id)
  OR EXISTS (SELECT 1 FROM response WHERE trial_id = t.id));
SELECT 'skipped, but not of an ended staircase', count(*) FROM trial WHERE status = 'skipped' AND block <> 'stairs';
SELECT 'answers to skipped trials', count(*) FROM trial t JOIN choice c ON c.trial_id = t.id WHERE status = 'skipped';

-- How many answers each block's trials have.
CREATE TEMP TABLE wanted (block, kinds, choices, ratings, responses);
INSERT INTO wanted VALUES ('training', 'practice', 1, 0, 0), ('pairs', 'toggle catch null', 1, 4, 0),
  ('sequence', 'sequential catch null', 1, 2, 1), ('timed', 'rate', 0, 2, 0), ('untimed', 'rate', 0, 1, 0),
  ('setting', 'adjust', 0, 2, 1), ('stairs', 'staircase', 1, 0, 0), ('unequal', 'staircase', 1, 0, 0),
  ('visible', 'staircase', 0, 1, 0), ('counting', 'task', 0, 0, 1);
SELECT 'numbers of answers', count(*) FROM trial t LEFT JOIN wanted w ON w.block = t.block WHERE t.status = 'done'
AND NOT (instr(w.kinds, t.kind) AND choices = (SELECT count(*) FROM choice WHERE trial_id = t.id)
     AND ratings = (SELECT count(*) FROM rating WHERE trial_id = t.id)
     AND responses = (SELECT count(*) FROM response WHERE trial_id = t.id));

-- Choices.
CREATE TEMP VIEW chosen AS SELECT c.*, t.block, t.kind, t.test_slot, t.settings FROM choice c JOIN trial t ON t.id = trial_id;
SELECT 'equal where it is no answer', count(*) FROM chosen WHERE chosen = 'equal' AND block NOT IN ('sequence', 'unequal');
SELECT 'verdicts', count(*) FROM chosen WHERE (correct IS NOT NULL) <> (kind IN ('catch', 'staircase'));
SELECT 'wrong verdicts', count(*) FROM chosen WHERE correct <> (chosen <> test_slot AND chosen <> 'equal');
SELECT 'answers after their deadline', count(*) FROM chosen WHERE reaction_ns > 1e9 * (settings ->> 'deadline_s');
SELECT 'choices before both were seen for long enough', count(*) FROM chosen c JOIN (SELECT 'a' AS slot UNION SELECT 'b')
WHERE block IN ('pairs', 'stairs') AND coalesce((SELECT sum(full_end_ns - full_start_ns) FROM exposure e
  WHERE e.trial_id = c.trial_id AND e.option = slot), 0) < 1e9 * (settings ->> 'min_exposure_s') - 1;

-- Ratings.
SELECT 'ratings beyond their scale', count(*) FROM rating WHERE value NOT BETWEEN scale_min AND scale_max OR value <> round(value);
SELECT 'subjects', count(*) FROM rating r JOIN trial t ON t.id = trial_id
WHERE (subject = 'scene') <> (t.block IN ('timed', 'untimed', 'visible'));
SELECT 'conditions of subjects', count(*) FROM rating r JOIN trial t ON t.id = trial_id
WHERE NOT (t.kind = 'adjust' AND subject = t.test_slot) AND condition_id IS NOT
  CASE subject WHEN 'a' THEN option_a WHEN 'b' THEN option_b ELSE iif(t.kind = 'rate', option_a, NULL) END;
SELECT 'adjusted options rated as others', count(*) FROM rating r JOIN trial t ON t.id = trial_id
JOIN condition c ON c.id = condition_id WHERE t.kind = 'adjust' AND subject = t.test_slot
AND abs((c.parameters ->> 'epsilon') - (SELECT value FROM response s WHERE s.trial_id = t.id)) > 1e-8;

-- Other answers.
SELECT 'counts and what was there', count(*) FROM response r JOIN trial t ON t.id = trial_id
WHERE iif(t.kind = 'adjust', expected IS NOT NULL OR question <> 'epsilon',
          expected IS NOT (t.settings ->> 'spheres') OR question <> 'number' OR value <> round(value));
SELECT 'adjustments that are not their last step', count(*) FROM response r WHERE question = 'epsilon' AND value <>
  (SELECT value FROM adjust_step s WHERE s.trial_id = r.trial_id ORDER BY id DESC LIMIT 1);
SELECT 'steps of another size', count(*) FROM (SELECT value - lag(value) OVER (PARTITION BY trial_id, segment_id ORDER BY id)
  AS step, value FROM adjust_step) WHERE abs(abs(step) - 0.05) > 1e-9 AND value NOT IN (0.0, 1.0) AND value - step NOT IN (0.0, 1.0);

-- Staircases: what was shown is what was answered about.
CREATE TEMP VIEW step AS SELECT s.*, t.block, t.test_slot, c.parameters ->> 'epsilon' AS shown FROM staircase_step s
JOIN trial t ON t.id = s.trial_id JOIN condition c ON c.id = CASE test_slot WHEN 'a' THEN option_a ELSE option_b END;
SELECT 'levels', count(*) FROM step WHERE typeof(shown) <> 'real' OR level <> shown;
SELECT 'steps', count(*) FROM trial t WHERE kind = 'staircase'
AND (status = 'done') <> (SELECT count(*) FROM staircase_step WHERE trial_id = t.id);
SELECT 'outcomes', count(*) FROM step s LEFT JOIN choice c ON c.trial_id = s.trial_id LEFT JOIN rating r ON r.trial_id = s.trial_id
WHERE outcome IS NOT CASE s.block WHEN 'stairs' THEN correct WHEN 'visible' THEN r.value - r.scale_min
  ELSE iif(chosen = 'equal', 1, 2 * correct) END;

-- Time.
SELECT 'trials before the one before', count(*) FROM trial a JOIN trial b ON b.session_id = a.session_id AND b.ordinal > a.ordinal
WHERE b.started_ns < a.ended_ns AND a.segment_id = b.segment_id AND a.status <> 'skipped' AND b.status <> 'skipped';
SELECT 'breaks', count(*) FROM trial b JOIN trial a ON a.session_id = b.session_id AND a.ordinal = b.ordinal - 1
WHERE a.block = 'pairs' AND b.block = 'pairs' AND b.ordinal = 4 AND a.segment_id = b.segment_id
AND a.attempt = 1 AND b.attempt = 1 AND b.started_ns - a.ended_ns < 10000000000;
SELECT 'timed looks', count(*) FROM exposure e JOIN trial t ON t.id = trial_id WHERE t.status = 'done' AND e.attempt = t.attempt
AND t.kind IN ('sequential', 'rate', 'task') AND t.block <> 'untimed'
AND abs(full_end_ns - full_start_ns - 1e9 * (t.settings ->> 'view_s')) > 101e6;
