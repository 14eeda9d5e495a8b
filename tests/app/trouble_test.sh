#!/bin/sh
# A session meets a full disk, events without room, a locked database, and a study file that goes away: it says so,
# waits, tells no answer that is not stored, and goes on by itself when it can.
# usage: trouble_test.sh FOVSTUDY FOLDER
set -u
fovstudy=$1 folder=$2
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder" || exit 1
program=
trap '[ -z "$program" ] || kill -9 $program 2>/dev/null' EXIT
trap '' XFSZ # a write beyond the limit fails as on a full disk

blocks=$(for i in 1 2 3 4 5 6 7 8; do
    echo "{name: b$i, kind: toggle, options: [foveated, regular], repetitions: 512},"
done)
echo "{fovstudy: 1, name: long, seed: 1, title: t, scenes: [atrium], options: {foveated: {mode: time_warped},
regular: {mode: regular}}, reference: regular, settings: {advance: auto, question: prefer}, questions: {prefer: {text:
Which}}, instructions: i, consent: {version: '1', text: c}, blocks: [$blocks]}" >long.yaml
echo 'atrium,0.03,time_warped' >errors.csv

fail() {
    echo "trouble test, $name: $1"
    cat "$name.err"
    exit 1
}
lines() { wc -l <"$name.jsonl"; }
answers() { grep -ac '"event":"answer"' "$name.jsonl"; }
# until CONDITION..., for at most fifteen seconds
until_true() {
    tries=0
    until eval "$1"; do
        tries=$((tries + 1))
        [ $tries -gt 300 ] && fail "never: $1"
        sleep 0.05
    done
}
# start NAME [OPTIONS]: a session of many trials in the background
start() {
    name=$1
    shift
    "$fovstudy" run long.yaml --db "$name.db" --participant p --display none --gaze sim \
        --observer sim:errors=errors.csv --events "$name.jsonl" "$@" 2>"$name.err" &
    program=$!
    until_true '[ -s $name.jsonl ] && [ $(lines) -gt 40 ]'
}
says() { until_true "grep -q 'please wait: .*$1' $name.err"; }
stands_still() {
    sleep 0.3
    before=$(lines)
    sleep 1
    [ "$(lines)" = "$before" ] || fail "it went on"
    kill -0 $program || fail "it ended"
}
goes_on() {
    until_true "grep -q 'the session goes on' $name.err"
    before=$(answers)
    until_true "[ \$(answers) -gt $before ]"
}
ask() { sqlite3 "$name.db" "$1"; }
# stop EVENTS: at least so many of kind store_trouble
stop() {
    kill -9 $program
    wait $program 2>/dev/null
    program=
    [ "$(ask 'PRAGMA integrity_check')" = ok ] || fail "damaged"
    [ "$(ask 'SELECT count(*) FROM choice')" -ge "$(answers)" ] || fail "answers were lost"
    [ -z "$(ask "SELECT detail FROM event WHERE kind LIKE 'log_%'")" ] || fail "rows were dropped"
    [ "$(ask "SELECT count(*) FROM event WHERE kind = 'store_trouble'")" -ge "$1" ] || fail "no event row"
    lines_ok=$(sed 's/^{"seq":\([0-9]*\),.*}$/\1/' "$name.jsonl" | grep -av '^[^0-9]' | awk '$0 != NR { print NR ": " $0; exit }')
    [ -z "$lines_ok" ] || fail "event line $lines_ok"
}

start full
prlimit --pid $program --fsize=4096:unlimited
says '' # by the study file or the events, whichever meets the limit first
stands_still
prlimit --pid $program --fsize=unlimited:unlimited
goes_on
stop 1

# Only the events find no room, in a file larger than the study: the answer is stored, and told when it can be.
{
    printf '{"seq":1,"pad":"'
    head -c 20000000 /dev/zero | tr '\0' x
    printf '"}\n{"seq":2,"event":"gap"}\n'
} >room.jsonl # an earlier session's
start room
prlimit --pid $program --fsize=$(($(stat -c %s room.jsonl) + 2000)):unlimited
says 'events file cannot be written'
stands_still
prlimit --pid $program --fsize=unlimited:unlimited
goes_on
stop 1

start lock
sqlite3 lock.db '.timeout 20000' 'BEGIN IMMEDIATE' '.shell sleep 4' COMMIT &
other=$!
says locked
stands_still
wait $other
goes_on
stop 1

# A reader is in nobody's way.
start read
sqlite3 read.db BEGIN 'SELECT count(*) FROM trial' '.shell sleep 2' >/dev/null &
other=$!
sleep 0.5
before=$(answers)
wait $other
[ "$(answers)" -gt "$before" ] || fail "a reader stopped it"
[ -s read.err ] && fail "it complained"
stop 0

# Known within a second; put back, the session goes on.
start gone
mv gone.db away.db
sleep 1
grep -q 'please wait: .*gone.db: the file was removed or replaced' gone.err || fail "not known"
stands_still
mv away.db gone.db
goes_on
stop 1

# Another file in its place is not written to.
start other
sum=$(sha256sum <errors.csv)
cp errors.csv new
mv other.db kept.db
mv new other.db
says 'removed or replaced'
stands_still
[ "$(sha256sum <other.db)" = "$sum" ] || fail "the other file was written to"
mv kept.db other.db
goes_on
stop 1

# A file that is deleted is kept in a copy, and the session goes on in that.
start deleted
before=$(answers)
rm deleted.db
says 'all it held is in .*deleted.db.rescued1'
stands_still
[ "$(sqlite3 deleted.db.rescued1 'SELECT count(*) FROM choice')" -ge "$(answers)" ] || fail "the copy lacks answers"
[ -e deleted.db ] && fail "a file was made in its place"
mv deleted.db.rescued1 deleted.db
goes_on
stop 1

# Patience ends, and the session can be resumed.
start ends --patience 0.5
mv ends.db away.db
wait $program
[ $? = 1 ] || fail "status $?"
grep -q '^fovstudy: gave up after .*removed or replaced' ends.err || fail "nothing was said"
mv away.db ends.db
before=$(answers)
"$fovstudy" resume --db ends.db --events ends.jsonl 2>>ends.err &
program=$!
until_true "[ \$(answers) -gt $before ]"
stop 0
echo "a session waits out a full disk, a locked database and a file that goes away"
