#!/bin/sh
# The windowed program driven by synthetic keys: studies/protocols/short.yaml from consent to stored answers.
# usage: window_test.sh FOVSTUDY SOURCE_DIR FOLDER [SHOTS]; SHOTS: a folder for a picture of each screen.
# Exit 77 where Xvfb, xdotool or a Vulkan device is missing.
set -u
fovstudy=$1 source=$2 folder=$3 shots=${4:-}
screen=1280x720
. "$(dirname "$0")/window.sh"

fail() {
    echo "window test: $1"
    cat "$folder/said" "$folder/events" 2>/dev/null
    exit 1
}
alive() { kill -0 $program 2>/dev/null || fail "the program ended early"; }
shot() { [ -n "$shots" ] && sleep 1 && import -window root "$shots/$1.png"; }
key() { xdotool key "$1"; }
events() { grep -c "$1" "$folder/events" 2>/dev/null; }
# press KEY until there are N events like PATTERN
press_until() {
    tries=0
    until [ "$(events "$3")" -ge "$2" ]; do
        tries=$((tries + 1))
        [ $tries -gt 120 ] && fail "no event $3 after many $1"
        alive
        key "$1"
        sleep 0.5
    done
}

# Small eyes, for a software driver on a busy machine; large ones for the pictures.
size=320x360 middle="160 180"
[ -n "$shots" ] && size=640x720 middle="320 360"
"$fovstudy" run "$source/studies/protocols/short.yaml" --db "$folder/study.db" --participant w1 --display window --no-preflight \
    --size $size --scene atrium=town:triangles=20000 --gaze mouse --events "$folder/events" 2>"$folder/said" &
program=$!
: >"$folder/events"
xdotool mousemove $middle # the middle of the left eye
tries=0
until [ "$(xdotool search --name '^fovstudy$' 2>/dev/null | wc -l)" -ge 1 ] || [ $tries -gt 120 ]; do
    tries=$((tries + 1))
    sleep 0.5
done
sleep 2
alive
[ "$(xdotool search --name '^fovstudy$' | wc -l)" -ge 1 ] || fail "the window is not called fovstudy"
shot consent
key Return # Enter does not consent
sleep 0.5
consents=$(sqlite3 "$folder/study.db" "SELECT count(*) FROM session WHERE consent_at IS NOT NULL" 2>/dev/null)
[ "${consents:-0}" = 0 ] || fail "Enter gave consent" # a study file that is not there yet holds none
key y
shot instructions
key Return
shot ready
press_until Return 1 '"event":"trial"'
key 2 # too early: not both were seen
sleep 0.3
shot look_at_both
press_until space 1 '"event":"toggle".*"ignored":false'
if [ -n "$shots" ]; then
    key p
    shot pause
    key Return
    sleep 1
    key Escape
    shot abort
    key n
    sleep 1
fi
shot stimulus
press_until 1 1 '"event":"answer"'
press_until space 2 '"event":"toggle".*"trial":2.*"ignored":false' # A, B and A again
press_until Right 2 '"event":"answer"'
press_until Return 3 '"event":"trial"'
sleep 1
tries=0
until [ "$(events '"table":"rating"')" -ge 1 ]; do
    tries=$((tries + 1))
    [ $tries -gt 60 ] && fail "no rating was taken"
    alive
    key Return # asks for the question
    sleep 0.5
    key 6
    key Right
    [ $tries = 1 ] && shot question
    key Return
    sleep 0.5
done
shot thanks
wait $program
status=$?
program=
[ $status = 0 ] || fail "exit status $status"
[ -s "$folder/said" ] && fail "it said something"

expect() {
    got=$(sqlite3 "$folder/study.db" "$1")
    [ "$got" = "$2" ] || fail "$1 gave '$got', not '$2'"
}
expect "PRAGMA integrity_check" ok
expect "SELECT kind FROM participant" person
expect "SELECT status, display, width_px, height_px, consent_version FROM session" "complete|window|${size%x*}|${size#*x}|1"
expect "SELECT clock FROM segment WHERE boot_id IS NOT NULL" monotonic
expect "SELECT group_concat(chosen) FROM choice" "a,b"
expect "SELECT value FROM rating" 7.0
expect "SELECT group_concat(status) FROM trial" "done,done,done"
expect "SELECT count(*) >= 1 FROM event WHERE kind = 'choice_early'" 1
expect "SELECT count(*) FROM choice WHERE (SELECT count(DISTINCT option) FROM exposure e WHERE e.trial_id = choice.trial_id AND
        full_start_ns < answered_ns) <> 2" 0
expect "SELECT count(*) > 5 AND min(number) = 0 AND max(number) = count(*) - 1 FROM frame" 1
expect "SELECT count(*) FROM frame WHERE present_ns < start_ns" 0
# the cursor stood in the middle of the left eye
expect "SELECT count(*) > 5 AND max(abs(x_deg)) < 0.5 AND max(abs(y_deg)) < 0.5 FROM gaze WHERE valid" 1

# Another participant ends at the consent screen: asked once, then aborted, nothing of the first one touched.
"$fovstudy" run "$source/studies/protocols/short.yaml" --db "$folder/study.db" --participant w2 --display window --no-preflight \
    --size 320x360 --scene atrium=town:triangles=20000 --gaze mouse 2>"$folder/said" &
program=$!
sleep 2
tries=0
while kill -0 $program 2>/dev/null; do
    tries=$((tries + 1))
    [ $tries -gt 60 ] && fail "Escape and Y did not end the session"
    key Escape
    sleep 0.3
    key y
    sleep 0.3
done
wait $program
status=$?
program=
[ $status = 1 ] || fail "exit status $status after the participant ended the session"
expect "SELECT group_concat(status) FROM session" "complete,aborted"
expect "SELECT count(*) FROM choice" 2
echo "window test: consent to stored answers"
