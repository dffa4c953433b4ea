#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Shows that a house test can fail: on a small clean tree it passes, and with one bad file added it
# fails and names what is wrong.
# Usage: catches_violations.sh layering|style|format|tidy
set -euo pipefail
here=$(dirname "$(realpath "$0")")
check=$1
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0
spdx='// SPDX-License-Identifier: GPL-3.0-or-later'

write() {  # write FILE LINE...
  mkdir -p "$tree/$(dirname "$1")"
  printf '%s\n' "${@:2}" >"$tree/$1"
}

clean_tree() {
  rm -rf "${tree:?}"/*
  cp "$here/../../.clang-format" "$here/../../.clang-tidy" "$tree"
  write acquire/core/point.hpp "$spdx" '#pragma once' '#include <Eigen/Core>'
  write acquire/core/point.cpp "$spdx" '#include <facula/acquire/core/point.hpp>'
  write acquire/core/CMakeLists.txt '# SPDX-License-Identifier: X' 'facula_add_room(core point.cpp)'
  write reconstruct/fit_pcl.cpp "$spdx" '#include <facula/acquire/core/point.hpp>' '' \
    '#include <pcl/point_types.h>'
  write reconstruct/CMakeLists.txt '# SPDX-License-Identifier: X' 'facula_add_room(x fit_pcl.cpp)'
  write map/grid.hpp "$spdx" '#pragma once'
  write tests/map/grid_test.cpp "$spdx" '#include <facula/map/grid.hpp>'
  write tests/map/CMakeLists.txt '# SPDX-License-Identifier: X' 'facula_add_test(map/grid LIBS x)'
}

run() {
  "$here/$check.sh" "$tree" "$tree/build" >"$tree/.output" 2>&1
}

expect_clean() {
  run && return
  echo "the clean tree was refused:"
  cat "$tree/.output"
  failures=$((failures + 1))
}

# expect_complaint TEXT: the check must fail and its output must hold the text.
expect_complaint() {
  if run; then
    echo "not noticed: $1"
    failures=$((failures + 1))
  elif ! grep -qF "$1" "$tree/.output"; then
    echo "noticed without saying '$1':"
    cat "$tree/.output"
    failures=$((failures + 1))
  fi
  clean_tree
}

lines() {  # lines COUNT TEXT
  for ((i = 0; i < $1; ++i)); do echo "$2"; done
}

try_layering() {
  write acquire/core/point.cpp '#include <facula/map/grid.hpp>'
  expect_complaint 'the arrow runs up'
  write acquire/core/point.cpp '#include <opencv2/core.hpp>'
  expect_complaint 'acquire/core knows Eigen'
  write acquire/rig.hpp '#include <facula/reconstruct/fit.hpp>'
  expect_complaint 'acquire/rig.hpp (acquire) includes <facula/reconstruct/fit.hpp> (reconstruct)'
  write map/grid.hpp '#include <facula/acquire/rig.hpp>'
  expect_complaint 'map/grid.hpp (map)'
  write map/grid.hpp '#include <facula/acquire/core/none.hpp>'
  expect_complaint 'which is not there'
  write map/grid.hpp '#include "grid.hpp"'
  expect_complaint 'by quotes'
  write map/grid.hpp '#include <octomap/octomap.h>'
  expect_complaint 'only octomap_bridge.hpp may'
  write reconstruct/fit_pcl.cpp '#include <CGAL/Point_3.h>'
  expect_complaint 'only files named *_cgal.cpp may'
  mkdir -p "$tree/map/utils"
  expect_complaint 'map/utils/'
  write map/lonely.cpp ''
  expect_complaint 'map/lonely.cpp: no CMakeLists.txt lists it'
  write tests/map/lonely_test.cpp ''
  expect_complaint 'tests/map/lonely_test.cpp: no CMakeLists.txt lists it'
}

try_style() {
  write map/long.cpp "$spdx" "$(lines 400 '//')"
  expect_complaint 'map/long.cpp: 401 lines'
  write map/long.cpp "$spdx" 'int long_one() {' "$(lines 59 '  // a line')" '}'
  expect_complaint 'long_one has 61 lines'
  write map/grid.hpp '#pragma once'
  expect_complaint 'map/grid.hpp: no SPDX line'
  write map/grid.hpp "$spdx"
  expect_complaint 'map/grid.hpp: no #pragma once'
}

try_format() {
  write map/grid.hpp "$spdx" '#pragma once' 'int  f( int x );'
  expect_complaint 'map/grid.hpp:3'
}

compile_commands() {
  mkdir -p "$tree/build"
  printf '[\n{\n  "directory": "%s",\n  "command": "g++ -c %s",\n  "file": "%s"\n}\n]\n' \
    "$tree" "$tree/map/count.cpp" "$tree/map/count.cpp" >"$tree/build/compile_commands.json"
}

try_tidy() {
  write map/count.cpp "$spdx" 'int CountThem(int number) { return number; }'
  compile_commands
  expect_complaint 'readability-identifier-naming'
  expect_complaint 'compile_commands.json'
}

clean_tree
if [[ $check == tidy ]]; then
  write map/count.cpp "$spdx" 'int count_them(int number) { return number; }'
  compile_commands
fi
expect_clean
"try_$check"
[[ $failures -eq 0 ]]
