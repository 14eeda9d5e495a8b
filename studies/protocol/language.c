#include "studies/protocol/language.h"

#include <string.h>

#define WORDS(...)                                                                                             \
    (const char *const[])                                                                                      \
    {                                                                                                          \
        __VA_ARGS__, 0                                                                                         \
    }
#define NO_YES WORDS("no", "yes")

static const struct language_key protocol_keys[] = {
    {"fovstudy", LANGUAGE_INTEGER, true, 1, 1, .about = "Version of this language.", .example = "fovstudy: 1"},
    {"name", LANGUAGE_NAME, true, .about = "Name of the study, as the store keeps it.",
     .example = "name: calibration"},
    {"title", LANGUAGE_TEXT, true, .about = "Title of the study, for the report.",
     .example = "title: Calibration of time-warped foveated rendering"},
    {"seed", LANGUAGE_INTEGER, true, 0, 9223372036854775807.0,
     .about = "With the bytes of this file and the participant's number it fixes every trial.",
     .example = "seed: 20210802"},
    {"participants", LANGUAGE_INTEGER, false, 1, 100000, .fallback = "20",
     .about = "How many people are planned; `fovstudy check` says what so many can show.",
     .example = "participants: 22"},
    {"sessions", LANGUAGE_WORD, false, .words = WORDS("one", "several"), .fallback = "one",
     .about =
         "Whether a participant may come again, with the same order; else only with --again, which is logged.",
     .example = "sessions: one"},
    {"scenes", LANGUAGE_LIST, true, 1, 16, .of = "the scene",
     .about = "The scenes: names, or mappings that say what is shown while nobody binds the name.",
     .example = "scenes: [atrium, {name: bistro, stand_in: atrium, labels: {type: realistic}}]"},
    {"options", LANGUAGE_TABLE, true, 1, 16, .of = "the option",
     .about = "What is compared, by names of your own.",
     .example = "options: {foveated: {mode: time_warped, epsilon: 0.1}, regular: {mode: regular}}"},
    {"reference", LANGUAGE_NAME, true, .about = "The option that image errors are measured against.",
     .example = "reference: regular"},
    {"settings", LANGUAGE_MAP, false, .of = "settings", .about = "For every block that does not set its own.",
     .example = "settings: {camera: path, question: prefer}"},
    {"questions", LANGUAGE_TABLE, false, 1, 16, .of = "the question",
     .about = "What participants are asked, by names of your own; adjustments alone need none.",
     .example = "questions: {prefer: {text: \"Which one do you prefer, A or B?\"}}"},
    {"instructions", LANGUAGE_TEXT, true, .about = "Shown once, before everything.",
     .example = "instructions: You will look around in scenes and judge them."},
    {"consent", LANGUAGE_MAP, true, .of = "consent",
     .about = "What the participant agrees to before any trial.",
     .example = "consent: {version: \"1\", text: Do you agree to take part?}"},
    {"participant", LANGUAGE_LIST, false, 0, 16, .of = "the attribute",
     .about = "What is asked about each participant. Never names or birth dates.",
     .example = "participant: [{name: age, type: integer, min: 18, max: 99, unit: years}]"},
    {"exclude", LANGUAGE_LIST, false, 0, 16, .of = "the exclusion",
     .about = "Rules that take data out of the analysis, fixed before the first participant.",
     .example = "exclude: [{rule: unseen_option}, {rule: gaze_loss, above: 0.2}]"},
    {"analysis", LANGUAGE_LIST, false, 0, 16, .of = "the analysis",
     .about = "What is to be computed, fixed before the first participant.",
     .example = "analysis: [{method: binomial, of: choice, per: cell}]"},
    {"blocks", LANGUAGE_LIST, true, 1, 16, .of = "the block", .about = "The blocks of trials, in their order.",
     .example = "blocks: [{name: main, kind: toggle, options: [foveated, regular]}]"},
    {0},
};

static const struct language_key scene_keys[] = {
    {"name", LANGUAGE_NAME, true, .about = "Bound with --scene NAME=FILE, else a built-in scene's name.",
     .example = "name: bistro"},
    {"stand_in", LANGUAGE_TEXT, false, .about = "What is shown where the name is not bound: a built-in scene.",
     .example = "stand_in: town:triangles=1000000"},
    {"labels", LANGUAGE_TABLE, false, 0, 4,
     .about = "Further members of the factors of each trial in this scene.",
     .example = "labels: {scene_type: realistic}"},
    {0},
};

static const struct language_key option_keys[] = {
    {"mode", LANGUAGE_NAME, true,
     .about = "One that `fovstudy modes` lists; its parameters may follow by name.",
     .example = "mode: time_warped"},
    {"playback", LANGUAGE_WORD, false, .words = WORDS("live", "prerendered"), .fallback = "live",
     .about =
         "prerendered: its frames along the camera path are rendered before the trial and played at the "
         "refresh rate, for options too slow to be live. Only where the time is known (view_s of sequential, "
         "rate and task blocks) and where the gaze changes nothing (foveate: target, or no foveation).",
     .example = "playback: prerendered"},
    {0},
};

static const struct language_key settings_keys[] = {
    {"camera", LANGUAGE_WORD, false, .words = WORDS("path", "still"), .fallback = "path",
     .about = "Fly the scene's path, or stay at its start.", .example = "camera: path"},
    {"path_start_s", LANGUAGE_SECONDS, false, 0, 3600, .fallback = "0",
     .about = "Where on its path the camera begins: another flight through the same scene.",
     .example = "path_start_s: 20"},
    {"fixation", LANGUAGE_WORD, false, .words = WORDS("free", "cross", "moving"), .fallback = "free",
     .about =
         "free: look where you like; cross: one in the image's middle; moving: a sphere that moves along a "
         "straight path drawn for the trial, at the scene's depth.",
     .example = "fixation: cross"},
    {"foveate", LANGUAGE_WORD, false, .words = WORDS("gaze", "target"), .fallback = "gaze",
     .about = "What the fovea follows: the gaze, or the cross or sphere.", .example = "foveate: target"},
    {"advance", LANGUAGE_WORD, false, .words = WORDS("key", "auto"), .fallback = "key",
     .about = "key: the participant begins each trial; auto: it begins after rest_s.",
     .example = "advance: key"},
    {"pace", LANGUAGE_WORD, false, .words = WORDS("refuse", "common"), .fallback = "refuse",
     .about = "Where an option cannot hold the refresh rate: refuse the block, or show all its options at the "
              "largest whole part of the refresh rate that all hold (90: 45, 30, 22.5 Hz ...).",
     .example = "pace: common"},
    {"fade", LANGUAGE_MAP, false, .of = "fade",
     .about = "The way from the last full image of one option to the first full image of the other.",
     .example = "fade: {to_gray_s: 0.125, gray_s: 0.25, from_gray_s: 0.125}"},
    {"view_s", LANGUAGE_SECONDS, false, 0, 3600, .fallback = "0",
     .about = "How long each option is shown; 0: until the participant asks for the question.",
     .example = "view_s: 8"},
    {"gap_s", LANGUAGE_SECONDS, false, 0, 60, .fallback = "1",
     .about = "Gray with a marker in its middle between the two of a sequential trial.", .example = "gap_s: 1"},
    {"min_exposure_s", LANGUAGE_SECONDS, false, 0, 60, .fallback = "0",
     .about = "How long each option must have been shown, fades not counted, before a choice is taken.",
     .example = "min_exposure_s: 1"},
    {"deadline_s", LANGUAGE_SECONDS, false, 0, 3600, .fallback = "0",
     .about = "Longest time for an answer; then the trial is invalid and comes again at the end. 0: none.",
     .example = "deadline_s: 30"},
    {"confirm_s", LANGUAGE_SECONDS, false, 0, 60, .fallback = "0.5",
     .about = "How long \"answer stored\" stays.", .example = "confirm_s: 0.5"},
    {"rest_s", LANGUAGE_SECONDS, false, 0, 3600, .fallback = "0", .about = "Gray between trials, at least.",
     .example = "rest_s: 0.5"},
    {"question", LANGUAGE_NAMES, false, 1, 4,
     .about = "What is asked; of rate trials several, one after the other.",
     .example = "question: [artefacts, sure]"},
    {"ratings", LANGUAGE_NAMES, false, 0, 4,
     .about = "Questions with a scale asked of both options, after the choice between them.",
     .example = "ratings: quality"},
    {"spheres", LANGUAGE_LIST, false, 2, 2, .items = LANGUAGE_INTEGER, .item_min = 1, .item_max = 64,
     .about = "Coloured spheres along the flight: as many as drawn for the trial between these two.",
     .example = "spheres: [4, 9]"},
    {"count", LANGUAGE_NAME, false, .about = "The question with a count that asks for their number.",
     .example = "count: spheres_seen"},
    {0},
};

static const struct language_key fade_keys[] = {
    {"to_gray_s", LANGUAGE_SECONDS, false, 0, 10, .fallback = "0.125", .about = "From the image to gray.",
     .example = "to_gray_s: 0.125"},
    {"gray_s", LANGUAGE_SECONDS, false, 0, 10, .fallback = "0.25",
     .about = "Gray; the option changes in its middle.", .example = "gray_s: 0.25"},
    {"from_gray_s", LANGUAGE_SECONDS, false, 0, 10, .fallback = "0.125", .about = "From gray to the image.",
     .example = "from_gray_s: 0.125"},
    {0},
};

static const struct language_key question_keys[] = {
    {"text", LANGUAGE_TEXT, true, .about = "As the participant reads it.",
     .example = "text: How good does it look?"},
    {"scale", LANGUAGE_LIST, false, 2, 2, .items = LANGUAGE_INTEGER, .item_min = -100, .item_max = 100,
     .about = "Makes it a rating: whole numbers from the first to the second.", .example = "scale: [1, 10]"},
    {"count", LANGUAGE_LIST, false, 2, 2, .items = LANGUAGE_INTEGER, .item_max = 1000,
     .about = "Makes it a count between the first and the second.", .example = "count: [0, 20]"},
    {"labels", LANGUAGE_LIST, false, 2, 2, .items = LANGUAGE_TEXT, .about = "What the ends of a scale mean.",
     .example = "labels: [strongly disagree, strongly agree]"},
    {"equal", LANGUAGE_WORD, false, .words = NO_YES, .fallback = "no",
     .about = "Whether \"equal\" is an answer to a choice.", .example = "equal: yes"},
    {"correct", LANGUAGE_WORD, false, .words = WORDS("none", "reference", "tested"), .fallback = "none",
     .about = "Which option is the right answer to a choice, where there is one.",
     .example = "correct: reference"},
    {0},
};

static const struct language_key consent_keys[] = {
    {"version", LANGUAGE_TEXT, true, .about = "Stored with the time of consent.", .example = "version: \"1\""},
    {"text", LANGUAGE_TEXT, true, .about = "As the participant reads it.", .example = "text: Do you agree?"},
    {0},
};

static const struct language_key attribute_keys[] = {
    {"name", LANGUAGE_NAME, true, .about = "Key in the participant's attributes.", .example = "name: age"},
    {"type", LANGUAGE_WORD, true, .words = WORDS("integer", "number", "text", "choice"), .about = "Its type.",
     .example = "type: integer"},
    {"required", LANGUAGE_WORD, false, .words = NO_YES, .fallback = "no", .about = "Whether it must be given.",
     .example = "required: yes"},
    {"unit", LANGUAGE_NAME, false, .about = "Unit of a number.", .example = "unit: years"},
    {"prompt", LANGUAGE_TEXT, false, .fallback = "the name", .about = "What the experimenter is asked.",
     .example = "prompt: Age in years"},
    {"min", LANGUAGE_NUMBER, false, -1e15, 1e15, .about = "Smallest number.", .example = "min: 18"},
    {"max", LANGUAGE_NUMBER, false, -1e15, 1e15, .about = "Largest number.", .example = "max: 99"},
    {"choices", LANGUAGE_LIST, false, 2, 16, .about = "Of a choice.", .example = "choices: [never, often]"},
    {0},
};

static const struct language_key analysis_keys[] = {
    {"method", LANGUAGE_WORD, true, .words = WORDS("binomial", "paired_t", "unpaired_t", "mean", "anova"),
     .about = "The test or estimate.", .example = "method: binomial"},
    {"of", LANGUAGE_WORD, true,
     .words = WORDS("choice", "rating", "toggles", "reaction", "adjusted", "threshold"),
     .about = "What is analysed.", .example = "of: choice"},
    {"per", LANGUAGE_WORD, false, .words = WORDS("cell", "factor", "order", "scene", "study"),
     .about = "Split by.", .example = "per: cell"},
    {"margin", LANGUAGE_NUMBER, false, 0, 0.5,
     .about =
         "Of a binomial test of choices: how far from one half, as a share of choices and neither 0 nor "
         "0.5, a preference may lie and the options still count as equal; two one-sided tests say whether it "
         "does.",
     .example = "margin: 0.15"},
    {0},
};

static const struct language_key exclusion_keys[] = {
    {"rule", LANGUAGE_WORD, true,
     .words = WORDS("unseen_option", "gaze_loss", "gaze_gap_ms", "late_frames", "reaction", "failed_catch",
                    "fallback"),
     .about =
         "unseen_option: an option was seen for less than `below` seconds outside fades; gaze_loss: share of "
         "gaze samples without a direction; gaze_gap_ms: longest stretch without one; late_frames: share of "
         "stimulus frames; reaction: seconds to the answer; failed_catch: share of catch trials missed; "
         "fallback: what was rendered was not what was asked.",
     .example = "rule: gaze_loss"},
    {"of", LANGUAGE_WORD, false, .words = WORDS("trial", "rating_pair", "person"), .fallback = "trial",
     .about = "What is taken out: the trial, a rating and its pair, or the person.", .example = "of: trial"},
    {"above", LANGUAGE_NUMBER, false, 0, 1e9,
     .fallback = "gaze_loss 0.2, gaze_gap_ms 500, late_frames 0.01, else 0",
     .about = "The rule holds above this.", .example = "above: 0.2"},
    {"below", LANGUAGE_NUMBER, false, 0, 1e9, .fallback = "unseen_option 1, reaction 0.2",
     .about = "The rule holds below this: of unseen_option and reaction.", .example = "below: 0.2"},
    {"share", LANGUAGE_NUMBER, false, 0, 1, .fallback = "0.5",
     .about = "Of a person: goes out where the rule holds in more than this share of the trials.",
     .example = "share: 0.25"},
    {"set", LANGUAGE_WORD, false, .words = WORDS("planned", "stricter"), .fallback = "planned",
     .about = "stricter: only for the report's table of what would change.", .example = "set: stricter"},
    {0},
};

static const struct language_key block_keys[] = {
    {"name", LANGUAGE_NAME, true, .about = "Name of the block.", .example = "name: decisions"},
    {"kind", LANGUAGE_WORD, true, .words = WORDS("toggle", "sequential", "rate", "adjust", "staircase", "task"),
     .about =
         "toggle: switch freely, choose; sequential: one after the other, compare; rate: one option, rate it; "
         "adjust: switch freely, set parameters; staircase: each answer decides the next trial's parameter; "
         "task: one option, something to do.",
     .example = "kind: toggle"},
    {"role", LANGUAGE_WORD, false, .words = WORDS("main", "practice"), .fallback = "main",
     .about = "practice: trials that no analysis counts.", .example = "role: practice"},
    {"options", LANGUAGE_LIST, true, 1, 2,
     .about =
         "The option under test and the one it is compared with. A rate block of two rates one of them, drawn.",
     .example = "options: [foveated, regular]"},
    {"scenes", LANGUAGE_NAMES, false, 1, 16, .fallback = "every scene of the study",
     .about = "Scenes of this block.", .example = "scenes: [atrium]"},
    {"scene_use", LANGUAGE_WORD, false, .words = WORDS("alternate", "random"),
     .fallback = "random of rate, else alternate",
     .about = "alternate: each cell's scene changes from participant to participant; random: one drawn for the "
              "block.",
     .example = "scene_use: alternate"},
    {"complement_of", LANGUAGE_NAME, false,
     .about = "An earlier rate block: the same scene, the other of its two options.",
     .example = "complement_of: rating_before"},
    {"factors", LANGUAGE_TABLE, false, 1, 6, .of = "the factor",
     .about = "What the trials run through, full factorial.",
     .example = "factors: {epsilon: [0.2, 0.1], scene: {scenes: all}}"},
    {"trials", LANGUAGE_LIST, false, 1, 512, .of = "the level",
     .about = "Instead of factors: the trials, one by one.",
     .example = "trials: [{name: one, scene: town}, {name: two, settings: {ssao: on}}]"},
    {"repetitions", LANGUAGE_INTEGER, false, 1, 512, .fallback = "1", .about = "How often each cell comes.",
     .example = "repetitions: 2"},
    {"order", LANGUAGE_WORD, false, .words = WORDS("random", "fixed", "block_random", "latin"),
     .fallback = "random",
     .about =
         "random: one shuffle; fixed: as listed; block_random: a shuffle for each repetition; latin: Latin "
         "squares balanced for first-order carry-over (Williams 1949).",
     .example = "order: latin"},
    {"null", LANGUAGE_INTEGER, false, 0, 64, .fallback = "0",
     .about = "Trials among the others whose two options are both the reference.", .example = "null: 2"},
    {"catch", LANGUAGE_MAP, false, .of = "catch",
     .about = "Trials among the others with an obvious difference.",
     .example = "catch: {count: 2, option: blurred}"},
    {"adjust", LANGUAGE_TABLE, false, 1, 4, .of = "the adjustment",
     .about = "Of an adjust block: parameters of the option under test that the participant sets.",
     .example = "adjust: {epsilon: {start: [0.05, 0.5], step: 0.01}}"},
    {"staircase", LANGUAGE_MAP, false, .of = "the staircase",
     .about =
         "Of a staircase block: the parameter and how answers choose its level. Each cell is one staircase; "
         "they take turns at random.",
     .example = "staircase: {parameter: epsilon, method: 1up2down, larger: easier, level: {min: 0.01, max: 1}, "
                "start: 0.5, steps: [0.1, 0.05], trials: 40}"},
    {"break_every", LANGUAGE_INTEGER, false, 1, 512, .about = "A break after so many trials.",
     .example = "break_every: 24"},
    {"break_s", LANGUAGE_SECONDS, false, 0, 3600, .fallback = "0", .about = "Least length of a break.",
     .example = "break_s: 60"},
    {"settings", LANGUAGE_MAP, false, .of = "settings", .about = "For this block.",
     .example = "settings: {question: quality, view_s: 8}"},
    {"instructions", LANGUAGE_TEXT, false, .about = "Shown before the block.",
     .example = "instructions: Rate how good the scene looks."},
    {0},
};

static const struct language_key factor_keys[] = {
    {"parameter", LANGUAGE_NAME, false, .fallback = "the factor's name",
     .about = "The levels are values of this parameter.", .example = "parameter: fovea_deg"},
    {"option", LANGUAGE_NAME, false, .fallback = "the option under test", .about = "Whose parameter it is.",
     .example = "option: foveated"},
    {"options", LANGUAGE_LIST, false, 1, 16, .about = "Instead: these options take the tested one's place.",
     .example = "options: [small, medium, large]"},
    {"scenes", LANGUAGE_LIST, false, 1, 16, .words = WORDS("all"), .about = "Instead: these scenes, or all.",
     .example = "scenes: all"},
    {"setting", LANGUAGE_NAME, false, .about = "Instead: the levels are values of this setting.",
     .example = "setting: ssao"},
    {"levels", LANGUAGE_VARIANT, false, 1, 16, .of = "the level",
     .about = "A list of values, or names of your own with what each changes.",
     .example = "levels: {low: {settings: {ssao: off}}, high: {settings: {ssao: on}}}"},
    {"between", LANGUAGE_WORD, false, .words = NO_YES, .fallback = "no",
     .about =
         "yes: each participant gets one level, in turn; the same in all blocks with a factor of this name.",
     .example = "between: yes"},
    {0},
};

static const struct language_key level_keys[] = {
    {"name", LANGUAGE_NAME, false, .fallback = "its place",
     .about = "Of a listed trial: `trial` in its factors.", .example = "name: one"},
    {"labels", LANGUAGE_TABLE, false, 0, 4, .about = "Of a listed trial: further members of its factors.",
     .example = "labels: {test: IV}"},
    {"role", LANGUAGE_WORD, false, .words = WORDS("main", "practice", "catch", "null"),
     .fallback = "the block's",
     .about = "Of a listed trial: null shows the reference twice; catch has an obvious difference.",
     .example = "role: null"},
    {"scene", LANGUAGE_NAME, false, .about = "The scene.", .example = "scene: town"},
    {"option", LANGUAGE_NAME, false, .about = "Takes the tested option's place.", .example = "option: mixed"},
    {"options", LANGUAGE_LIST, false, 2, 2, .about = "Takes both places.",
     .example = "options: [foveated, mixed]"},
    {"parameters", LANGUAGE_TABLE, false, 1, 4, .of = "parameters",
     .about = "Parameters of the options shown, by option; `tested` and `reference` name the places.",
     .example = "parameters: {foveated: {epsilon: 0.3}}"},
    {"settings", LANGUAGE_MAP, false, .of = "settings", .about = "Settings that differ.",
     .example = "settings: {ssao: on}"},
    {0},
};

static const struct language_key catch_keys[] = {
    {"count", LANGUAGE_INTEGER, true, 1, 64, .about = "How many.", .example = "count: 2"},
    {"option", LANGUAGE_NAME, true, .about = "The obviously different option, in the tested one's place.",
     .example = "option: blurred"},
    {"parameters", LANGUAGE_TABLE, false, 1, 4, .of = "parameters",
     .about = "Its parameters that differ, by option.", .example = "parameters: {blurred: {epsilon: 0}}"},
    {0},
};

static const struct language_key adjust_keys[] = {
    {"start", LANGUAGE_LIST, true, 2, 2, .items = LANGUAGE_NUMBER, .item_min = -1e15, .item_max = 1e15,
     .about = "The first value is drawn between these two.", .example = "start: [0.05, 0.5]"},
    {"step", LANGUAGE_NUMBER, true, 1e-9, 1e9, .about = "Change by one key press.", .example = "step: 0.01"},
    {"min", LANGUAGE_NUMBER, false, -1e15, 1e15, .fallback = "the parameter's", .about = "Lower end.",
     .example = "min: 0"},
    {"max", LANGUAGE_NUMBER, false, -1e15, 1e15, .fallback = "the parameter's", .about = "Upper end.",
     .example = "max: 1"},
    {0},
};

static const struct language_key staircase_keys[] = {
    {"parameter", LANGUAGE_NAME, true, .about = "A number among the parameters of the option under test.",
     .example = "parameter: epsilon"},
    {"method", LANGUAGE_WORD, true, .words = WORDS("1up2down", "weighted", "quest_plus"),
     .about =
         "1up2down (Levitt 1971): harder after two right answers in a row, easier after a wrong one; settles "
         "at "
         "70.7 % right. weighted (Kaernbach 1991): harder by a step after a right answer, easier by step x "
         "target / "
         "(1 - target) after a wrong one. quest_plus (Watson 2017): the level expected to tell most about the "
         "model; its estimate is the posterior mean of the threshold. The estimate of 1up2down and weighted is "
         "the "
         "mean level at reversals (geometric with log spacing): with n steps the first n - 1 reversals are "
         "left "
         "out, and one more where those that remain are odd in number; there is none before two remain.",
     .example = "method: quest_plus"},
    {"larger", LANGUAGE_WORD, true, .words = WORDS("easier", "harder"),
     .about = "Whether larger levels make the right answer easier or harder to find.",
     .example = "larger: easier"},
    {"level", LANGUAGE_MAP, true, .of = "the grid",
     .about =
         "Levels that may be shown. An up-down step that would leave them ends at min or max; where it is "
         "there "
         "already the level stays, which is no reversal. So an estimate near an end says little: widen it.",
     .example = "level: {min: 0.01, max: 1, count: 25, spacing: log}"},
    {"trials", LANGUAGE_INTEGER, true, 1, 512, .about = "Most trials of one staircase.",
     .example = "trials: 40"},
    {"reversals", LANGUAGE_INTEGER, false, 1, 200,
     .about = "Of up-down: stop after so many, of every step size. A reversal is a step in the other direction "
              "than the "
              "last; its level is the one that was shown when the answer turned it.",
     .example = "reversals: 12"},
    {"start", LANGUAGE_NUMBER, false, -1e9, 1e9, .about = "Of up-down: the first level.",
     .example = "start: 0.5"},
    {"steps", LANGUAGE_LIST, false, 1, 16, .items = LANGUAGE_NUMBER, .item_max = 1e9,
     .about = "Of up-down: the first until the first reversal, the second until the second and so on, the last "
              "from then "
              "on; with log spacing factors (the weight of weighted is then an exponent).",
     .example = "steps: [0.1, 0.05, 0.02]"},
    {"target", LANGUAGE_NUMBER, false, 0, 1, .about = "Of weighted: the share of right answers to settle at.",
     .example = "target: 0.75"},
    {"model", LANGUAGE_MAP, false, .of = "the model",
     .about = "Of quest_plus: the psychometric functions it weighs.",
     .example =
         "model: {family: logistic, threshold: {min: 0.01, max: 1, count: 25, spacing: log}, slope: {min: 1, "
         "max: 10, count: 10}, guess: {min: 0.5, max: 0.5}, lapse: {min: 0, max: 0.06, count: 4}}"},
    {0},
};

static const struct language_key model_keys[] = {
    {"family", LANGUAGE_WORD, true, .words = WORDS("logistic", "weibull", "normal", "gumbel"),
     .about = "Shape of the psychometric function.", .example = "family: logistic"},
    {"threshold", LANGUAGE_MAP, true, .of = "the grid", .about = "Thresholds, in the level's unit.",
     .example = "threshold: {min: 0.01, max: 1, count: 25, spacing: log}"},
    {"slope", LANGUAGE_MAP, true, .of = "the grid",
     .about = "Slopes k in F(k (x - threshold)), x the level, or its natural logarithm where the levels have "
              "'spacing: "
              "log' or the family is weibull. fovstats thresholds prints the slope of the curve itself, which "
              "for the "
              "logistic is k / 4 between its asymptotes.",
     .example = "slope: {min: 1, max: 10, count: 10}"},
    {"guess", LANGUAGE_MAP, false, .of = "the grid",
     .about = "Shares of right answers by guessing; 0.5 of two options. Not with more outcomes than two.",
     .example = "guess: {min: 0.5, max: 0.5}"},
    {"lapse", LANGUAGE_MAP, false, .of = "the grid", .fallback = "0", .about = "Shares of lapses.",
     .example = "lapse: {min: 0, max: 0.06, count: 4}"},
    {0},
};

static const struct language_key grid_keys[] = {
    {"min", LANGUAGE_NUMBER, true, -1e9, 1e9, .about = "First value.", .example = "min: 0.01"},
    {"max", LANGUAGE_NUMBER, true, -1e9, 1e9, .about = "Last value.", .example = "max: 1"},
    {"count", LANGUAGE_INTEGER, false, 1, 10000, .fallback = "1",
     .about = "How many values, ends included; of up-down levels none.", .example = "count: 25"},
    {"spacing", LANGUAGE_WORD, false, .words = WORDS("linear", "log"), .fallback = "linear",
     .about = "Equal differences or equal ratios.", .example = "spacing: log"},
    {0},
};

const struct language_section language_protocol = {"the protocol", "A study.", protocol_keys, false,
                                                   LANGUAGE_NO_SHORT};
const struct language_section language_scene = {"the scene", "A scene with what stands in for it.", scene_keys,
                                                false, LANGUAGE_SHORT_NAME};
const struct language_section language_option = {"the option", "A mode with its parameters.", option_keys, true,
                                                 LANGUAGE_NO_SHORT};
const struct language_section language_settings = {
    "settings", "What cascades: of the study, a block, a factor's level or a trial; the innermost holds.",
    settings_keys, true, LANGUAGE_NO_SHORT};
const struct language_section language_fade = {"fade", "The gray fade at each switch.", fade_keys, false,
                                               LANGUAGE_NO_SHORT};
const struct language_section language_question = {
    "the question", "A choice between the two options, unless it has a scale or a count.", question_keys, false,
    LANGUAGE_NO_SHORT};
const struct language_section language_consent = {"consent", "What is agreed to.", consent_keys, false,
                                                  LANGUAGE_NO_SHORT};
const struct language_section language_attribute = {"the attribute", "Something about a participant.",
                                                    attribute_keys, false, LANGUAGE_NO_SHORT};
const struct language_section language_exclusion = {"the exclusion", "A rule that takes data out.",
                                                    exclusion_keys, false, LANGUAGE_NO_SHORT};
const struct language_section language_analysis = {"the analysis", "A planned computation.", analysis_keys,
                                                   false, LANGUAGE_NO_SHORT};
const struct language_section language_block = {"the block", "Trials of one kind.", block_keys, false,
                                                LANGUAGE_NO_SHORT};
const struct language_section language_factor = {
    "the factor", "A list of values of a parameter of the tested option, or one of these forms.", factor_keys,
    false, LANGUAGE_SHORT_VALUES};
const struct language_section language_level = {"the level", "What one level, or one listed trial, changes.",
                                                level_keys, false, LANGUAGE_NO_SHORT};
const struct language_section language_catch = {"catch", "Trials with an obvious difference.", catch_keys,
                                                false, LANGUAGE_NO_SHORT};
const struct language_section language_adjust = {"the adjustment", "A parameter that the participant sets.",
                                                 adjust_keys, false, LANGUAGE_NO_SHORT};
const struct language_section language_staircase = {"the staircase", "An adaptive method.", staircase_keys,
                                                    false, LANGUAGE_NO_SHORT};
const struct language_section language_model = {"the model", "What QUEST+ weighs.", model_keys, false,
                                                LANGUAGE_NO_SHORT};
const struct language_section language_grid = {"the grid", "Values from one end to the other.", grid_keys,
                                               false, LANGUAGE_NO_SHORT};

static const struct language_key no_keys[] = {{0}};
const struct language_section language_parameters = {"parameters", "Values of a mode's parameters, by name.",
                                                     no_keys, true, LANGUAGE_NO_SHORT};

const struct language_section *const language_sections[] = {
    &language_protocol, &language_scene,      &language_option,    &language_settings, &language_fade,
    &language_question, &language_consent,    &language_attribute, &language_block,    &language_factor,
    &language_level,    &language_parameters, &language_catch,     &language_adjust,   &language_staircase,
    &language_model,    &language_grid,       &language_exclusion, &language_analysis, 0,
};

const struct language_key *language_find(const struct language_section *section, const char *key)
{
    for (const struct language_key *each = section->keys; each->name; each++)
        if (strcmp(each->name, key) == 0)
            return each;
    return 0;
}
