#!/bin/sh
# Who may include whom (the house, README "How it is built"). Reads every tracked C, C++ and shader file; prints each
# include that breaks a rule and fails if there is one. Usage: includes.sh SOURCE_DIR
cd "$1" || exit 2
git ls-files '*.c' '*.h' '*.cpp' '*.comp' '*.vert' '*.frag' '*.glsl' | grep -v '^tests/' |
  xargs grep -Hn '^#include' | awk -F: '
function room(path) {
    if (path ~ /^renderer\/(passes|modes)\/[a-z_]+\//) { split(path, p, "/"); return p[1] "/" p[2] "/" p[3] }
    if (path ~ /^renderer\/(gpu|shared|scene)\//) { split(path, p, "/"); return p[1] "/" p[2] }
    if (path ~ /^(studies|analysis|app)\/[a-z]+\//) { split(path, p, "/"); return p[1] "/" p[2] }
    split(path, p, "/"); return p[1]
}
function starts(path, list,    n, a, i) {
    n = split(list, a, " ")
    for (i = 1; i <= n; i++) if (index(path, a[i]) == 1) return 1
    return 0
}
BEGIN {
    pass = "renderer/gpu/ renderer/shared/ renderer/scene/ renderer/frame.h stimuli/"
    may["stimuli"] = "stimuli/"
    may["renderer/gpu"] = "renderer/gpu/"
    may["renderer/shared"] = "renderer/shared/"
    may["renderer/scene"] = "renderer/scene/ renderer/gpu/ renderer/shared/ stimuli/"
    may["renderer"] = "renderer/ stimuli/"
    may["studies/protocol"] = "studies/protocol/ studies/engine/"
    may["studies/engine"] = "studies/protocol/ studies/engine/"
    may["studies/store"] = "studies/store/ studies/protocol/ stimuli/viewing.h"
    may["analysis/gaze"] = "analysis/gaze/"
    may["analysis/stats"] = "analysis/stats/"
    may["analysis/image"] = "analysis/image/"
    may["analysis/tools"] = may["analysis/report"] = "analysis/ studies/store/ studies/engine/"
    app = "app/ stimuli/ studies/ renderer/renderer.h renderer/frame.h renderer/mode.h renderer/settings.h analysis/image/ analysis/stats/quantile.h"
    # outside libraries: who may name them
    only["vulkan/"] = "app/display/window.c"
    only["volk.h"] = "renderer/gpu/"
    only["GLFW/"] = "app/"
    only["hidapi"] = "app/gaze/ app/response/"
    only["sqlite3.h"] = "studies/store/"
    only["tiny_gltf.h"] = "stimuli/gltf.cpp"
    only["glm/"] = "stimuli/geometry.cpp"
    only["meshoptimizer.h"] = "stimuli/"
    only["stb"] = "stimuli/ app/"
    only["libfyaml.h"] = "studies/protocol/"
    only["lz4.h"] = "app/session/"
    only["zlib.h"] = "analysis/tools/"
    only["Rmath.h"] = "analysis/stats/"
}
{
    file = $1; r = room(file)
    if ($3 ~ /<.*>/) {
        name = $3; sub(/.*</, "", name); sub(/>.*/, "", name)
        for (lib in only) if (index(name, lib) == 1 && !starts(file, only[lib])) {
            print file ":" $2 ": only " only[lib] " may include <" name ">"; bad = 1
        }
        next
    }
    name = $3; sub(/[^"]*"/, "", name); sub(/".*/, "", name)
    if (name !~ /\//) next # made by the build, beside the file
    if (r == "app/fovstudy") allowed = app " analysis/stats/" # check says what a plan can show
    else if (r ~ /^app/) allowed = app
    else if (r ~ /^renderer\/passes\//) allowed = pass " " r "/"
    else if (r ~ /^renderer\/modes\//) allowed = pass " renderer/mode.h renderer/modes/room.h renderer/modes/deferred.h renderer/passes/ " r "/"
    else if (file == "renderer/modes/room.h") allowed = pass " renderer/mode.h renderer/settings.h"
    else if (r in may) allowed = may[r]
    else { print file ": no rule for this room"; bad = 1; next }
    if (!starts(name, allowed)) { print file ":" $2 ": " r " may not include \"" name "\""; bad = 1 }
}
END { exit bad }'
