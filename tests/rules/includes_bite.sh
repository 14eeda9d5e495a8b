#!/bin/sh
# The include rules find what they should: each line below, alone in a repository, must fail. Usage: includes_bite.sh DIR
rules=$1/includes.sh
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" && git init -q . || exit 2
try() { # path, include, expected status
  rm -rf ./*
  mkdir -p "$(dirname "$1")"
  echo "#include $2" >"$1"
  git add -A
  "$rules" "$work" >/dev/null
  [ $? -eq "$3" ] || { echo "$1 including $2: expected status $3"; exit 1; }
}
try renderer/gpu/a.c '"stimuli/scene.h"' 1
try renderer/passes/shade/a.c '"renderer/passes/cull/cull.h"' 1
try renderer/modes/regular/a.c '"renderer/modes/time_warped/x.h"' 1
try studies/engine/a.c '"studies/store/store.h"' 1
try studies/store/a.c '"studies/engine/plan.h"' 1
try analysis/stats/a.c '"analysis/image/error.h"' 1
try analysis/gaze/a.c '"studies/store/read.h"' 1
try analysis/gaze/a.c '"analysis/stats/moments.h"' 1
try app/session/a.c '"renderer/gpu/gpu.h"' 1
try app/session/a.c '<sqlite3.h>' 1
try app/fovbench/a.c '"analysis/stats/binomial.h"' 1
try app/session/a.c '"analysis/stats/power.h"' 1
try app/fovstudy/a.c '"analysis/stats/power.h"' 0
try app/fovstudy/a.c '"analysis/report/report.h"' 1
try app/fovbench/a.c '"analysis/stats/quantile.h"' 0
try renderer/passes/shade/shade.comp '"renderer/passes/cull/x.glsl"' 1
try elsewhere/a.c '"stimuli/scene.h"' 1
try renderer/passes/shade/a.c '"renderer/gpu/gpu.h"' 0
try studies/store/a.c '<sqlite3.h>' 0
try app/session/a.c '"renderer/renderer.h"' 0
