#!/bin/sh
# Whole sessions of a paper's study in a window, answered by synthetic keys as fast as they are taken: verification with
# its 12 decisions and 24 ratings, and regions (its ray tracers replaced by modes that are there, its flights shortened).
# usage: keys_test.sh FOVSTUDY SOURCE_DIR FOLDER verification|regions [all]; all: every trial of regions, else one scene of it.
# Exit 77 where Xvfb, xdotool or a Vulkan device is missing.
set -u
fovstudy=$1 source=$2 folder=$3 study=$4 extent=${5:-part}
screen=640x480
. "$(dirname "$0")/window.sh"

fail() {
    echo "keys test: $1"
    tail -20 "$folder/said" "$folder/events" 2>/dev/null
    exit 1
}

small=town:triangles=20000
protocol=$source/studies/protocols/$study.yaml
scenes=
case $study in
verification)
    for name in suntemple1 suntemple2 bistro rungholt1 rungholt2 lostempire; do
        scenes="$scenes --scene $name=$small"
    done
    ;;
regions)
    # The region's radii become the fovea's; 8 s of flight a quarter of a second.
    sed -e 's/mode: ray_traced, inner_deg: \([0-9]*\), outer_deg: \([0-9]*\), p_min: [0-9.]*/mode: time_warped, fovea_deg: \1, periphery_deg: 30/' \
        -e 's/mode: ray_traced_full, playback: prerendered/mode: regular/' -e 's/view_s: 8/view_s: 0.25/' \
        -e 's/rest_s: 0.5/rest_s: 0/' -e 's/break_s: 60/break_s: 1/' "$protocol" >"$folder/regions.yaml"
    [ "$extent" = all ] || sed -i -e 's/scene: {scenes: all}/scene: {scenes: [sponza]}/' -e 's/repetitions: 2/repetitions: 1/' \
        "$folder/regions.yaml"
    protocol=$folder/regions.yaml
    for name in sponza tunnel_geom tunnel_maps rungholt; do
        scenes="$scenes --scene $name=$small"
    done
    ;;
esac

# shellcheck disable=SC2086
"$fovstudy" run "$protocol" --db "$folder/study.db" --participant k1 --display window --size 128x144 $scenes \
    --gaze mouse --no-preflight --events "$folder/events" 2>"$folder/said" &
program=$!
tries=0
until [ "$(xdotool search --name '^fovstudy$' 2>/dev/null | wc -l)" -ge 1 ] || [ $tries -gt 120 ]; do
    tries=$((tries + 1))
    kill -0 $program 2>/dev/null || fail "the program ended before its window came"
    sleep 0.5
done
xdotool mousemove 64 72
key() { xdotool key --delay 0 "$@" 2>/dev/null; }
tries=0
# Whatever is on the screen, one of these is the next thing to do; what does not fit is not taken.
while kill -0 $program 2>/dev/null; do
    tries=$((tries + 1))
    [ $tries -gt 4000 ] && fail "the session did not come to its end"
    key y Return space
    sleep 0.15
    key Left 2 Return
    sleep 0.1
done
wait $program
status=$?
program=
[ $status = 0 ] || fail "exit status $status"

expect() {
    got=$(sqlite3 "$folder/study.db" "$1")
    [ "$got" = "$2" ] || fail "$1 gave '$got', not '$2'"
}
expect "PRAGMA integrity_check" ok
expect "SELECT status FROM session" complete
expect "SELECT count(*) FROM trial WHERE status <> 'done'" 0
case $study in
verification)
    expect "SELECT count(*) FROM choice" 12
    expect "SELECT count(*), count(DISTINCT trial_id), sum(subject = 'a') FROM rating" "24|12|12"
    expect "SELECT count(*) FROM rating AS r JOIN trial AS t ON t.id = r.trial_id WHERE r.condition_id <>
            CASE r.subject WHEN 'a' THEN t.option_a ELSE t.option_b END" 0
    expect "SELECT count(DISTINCT json_extract(factors, '\$.test')) FROM trial" 6
    ;;
regions)
    trials=$([ "$extent" = all ] && echo 96 || echo 12)
    expect "SELECT count(*) FROM trial WHERE kind = 'rate'" "$trials"
    expect "SELECT count(*) FROM trial WHERE kind = 'practice'" 6
    expect "SELECT count(*) FROM rating" $((2 * (trials + 6)))
    expect "SELECT group_concat(DISTINCT fixation) FROM (SELECT fixation FROM trial ORDER BY fixation)" "cross,free,moving"
    expect "SELECT count(*) FROM frame AS f JOIN trial AS t ON t.id = f.trial_id WHERE f.phase = 'stimulus' AND
            f.fovea_source <> CASE t.fixation WHEN 'free' THEN 'gaze' ELSE 'target' END AND f.fovea_source <> 'lost'" 0
    ;;
esac
echo "keys test: a whole session of $study"
