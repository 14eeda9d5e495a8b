#!/bin/sh
# ./run without apt prints the list of packages and stops with 1; with a word it does not know, it says what there is
# and stops with 2. Usage: run_usage.sh SOURCE_DIR
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
for tool in bash dirname env; do
  ln -s "$(command -v $tool)" "$work/$tool"
done
PATH=$work "$1/run" test >"$work/out" 2>"$work/err"
status=$?
[ $status -eq 1 ] || { echo "without apt: status $status, not 1"; exit 1; }
for package in cmake glslc libvulkan-dev mesa-vulkan-drivers r-mathlib; do
  grep -qx "  $package" "$work/err" || { echo "without apt: $package is not in the list"; exit 1; }
done
[ ! -s "$work/out" ] || { echo "without apt: standard output is not empty"; exit 1; }
"$1/run" frobnicate >"$work/out" 2>"$work/err"
status=$?
[ $status -eq 2 ] && grep -q './run demo' "$work/err" || { echo "unknown word: status $status"; exit 1; }
