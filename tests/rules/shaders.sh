#!/bin/sh
# Every shader in the tree was compiled, in every variant, and is valid. Usage: shaders.sh SOURCE_DIR BUILD_DIR
cd "$1" || exit 2
bad=0
for shader in $(git ls-files '*.comp' '*.vert' '*.frag'); do
  folder=$(dirname "$shader")
  found=$(ls "$2/$folder/$(basename "$shader")"*.spv 2>/dev/null)
  [ -n "$found" ] || { echo "$shader: not compiled"; bad=1; }
  for spv in $found; do
    spirv-val --target-env vulkan1.3 --scalar-block-layout "$spv" || { echo "$spv: not valid"; bad=1; }
  done
done
exit $bad
