#!/bin/sh
# Runs every reference script of this folder anew in a folder of its own, and compares what it writes with the stored
# CSV, field by field: prints each field that differs (20 a file) and each file's largest relative difference. Stored files are not
# changed. A script whose interpreter or package is missing is named and counted as not run.
# Usage: rerun.sh [NAME...]   (names without ending; all by default)
# Exit: 0 nothing differs by more than 1e-9, 1 something does or a script failed, 2 nothing could be run.
set -u
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT
[ $# -gt 0 ] || set -- $(cd "$here" && ls *.R *.py | sed 's/\.[A-Za-z]*$//' | sort -u)
worst=0 ran=0 missing=0
for name; do
  [ -f "$here/$name.R" ] && script=$name.R with=Rscript || { script=$name.py with=python3; }
  [ -f "$here/$script" ] || { echo "$name: there is no script of that name"; worst=1; continue; }
  command -v "$with" >/dev/null || { echo "$script: not run, $with is not installed"; missing=$((missing + 1)); continue; }
  cp "$here/$script" "$here/$name.csv" "$folder/"
  mv "$folder/$name.csv" "$folder/$name.stored"
  if ! (cd "$folder" && "$with" "$script" >messages 2>&1); then
    if grep -q 'there is no package called\|No module named' "$folder/messages"; then
      echo "$script: not run, $(grep -o 'there is no package called.*\|No module named.*' "$folder/messages" | head -n 1)"
      missing=$((missing + 1))
    else
      echo "$script: failed: $(tail -n 1 "$folder/messages")"
      worst=1
    fi
    continue
  fi
  ran=$((ran + 1))
  awk -v name="$name" '
    function number(text) { return text ~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/ }
    FNR == NR { old[FNR] = $0; old_lines = FNR; next }
    { lines = FNR
      if ($0 == old[FNR]) { same++; next }
      count = split($0, a, /[, ]/); was = split(old[FNR], b, /[, ]/)
      for (i = 1; i <= (count > was ? count : was); i++) {
        if (a[i] "" == b[i] "") continue
        d = 1
        if (number(a[i]) && number(b[i])) {
          d = a[i] - b[i]; if (d < 0) d = -d
          scale = b[i] < 0 ? -b[i] : b[i] + 0; if (scale > 0) d /= scale
        }
        fields++
        if (d > most) most = d
        if (fields <= 20) printf "  %s.csv:%d field %d: stored %s, now %s (%.2g)\n", name, FNR, i, b[i], a[i], d
      } }
    END { if (lines != old_lines) { printf "  %s.csv: stored %d lines, now %d\n", name, old_lines, lines; most = 1 }
      printf "%s: %d lines, %d fields differ, the largest relative difference is %.2g\n", name, lines, fields, most
      exit most > 1e-9 }' "$folder/$name.stored" "$folder/$name.csv" || worst=1
done
echo "$ran scripts run, $missing not run"
[ "$ran" -gt 0 ] || exit 2
exit $worst
