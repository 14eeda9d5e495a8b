#!/bin/sh
# clang-format decides the layout. Usage: format.sh SOURCE_DIR
cd "$1" || exit 2
git ls-files '*.c' '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
