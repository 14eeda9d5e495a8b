# Sourced by tests that drive the windowed program: a screen of its own in $folder, which is emptied. Exit 77 where Xvfb,
# xdotool or a Vulkan device is missing. Wants: fovstudy, folder, screen (WIDTHxHEIGHT). Sets: DISPLAY, server; the trap
# ends the server and $program.
# shellcheck shell=sh
for tool in Xvfb xdotool sqlite3; do
    command -v $tool >/dev/null || { echo "no $tool"; exit 77; }
done
"$fovstudy" devices >/dev/null 2>&1 || { echo "no Vulkan device"; exit 77; }

rm -rf "$folder"
mkdir -p "$folder"
Xvfb -displayfd 3 -screen 0 "${screen}x24" -nolisten tcp -noreset 3>"$folder/display" 2>/dev/null &
server=$!
program=
trap 'kill $program $server 2>/dev/null' EXIT
tries=0
until [ -s "$folder/display" ]; do
    tries=$((tries + 1))
    [ $tries -gt 100 ] && { echo "Xvfb did not start"; exit 1; }
    sleep 0.1
done
DISPLAY=:$(cat "$folder/display")
export DISPLAY

