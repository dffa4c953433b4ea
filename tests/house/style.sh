#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fails when a file below ROOT is too long, has too long a function, or lacks its SPDX line or its
# `#pragma once`. Highway's *-inl.hpp are included once per instruction set and toggle a macro instead.
# Usage: style.sh ROOT
set -euo pipefail
cd "$1"
most_lines=400
most_function_lines=60
rooms=()
for room in acquire reconstruct map apps tests; do [[ -d $room ]] && rooms+=("$room"); done
complaints=0

complain() {
  echo "$*"
  complaints=$((complaints + 1))
}

sources() {
  find "${rooms[@]}" -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.sh' -o -name '*.cmake' \
    -o -name CMakeLists.txt -o -name '*.js' -o -name '*.css' -o -name '*.html' \) \
    -not -path '*/node_modules/*'
  [[ -f CMakeLists.txt ]] && echo CMakeLists.txt
}

check_file() {
  local file=$1 lines
  lines=$(wc -l <"$file")
  [[ $lines -le $most_lines ]] || complain "$file: $lines lines, at most $most_lines"
  # The second line counts too: a script starts with #!, a page with its document type.
  [[ $(head -n 2 "$file") == *SPDX-License-Identifier:* ]] ||
    complain "$file: no SPDX line at the top"
  local guard='#pragma once'
  [[ $file != *-inl.hpp ]] || guard='defined(HWY_TARGET_TOGGLE)'
  [[ $file != *.hpp ]] || grep -q -F "$guard" "$file" || complain "$file: no $guard"
}

check_functions() {
  local path line end name
  while IFS=$'\t' read -r path line end name; do
    [[ $((end - line + 1)) -le $most_function_lines ]] ||
      complain "$path:$line: $name has $((end - line + 1)) lines, at most $most_function_lines"
  done < <(ctags -R --languages=C++ --kinds-C++=f --fields=+ne --map-C++=+.hpp -f - "${rooms[@]}" |
             awk -F '\t' '{
               line = 0; end = 0
               for (i = 4; i <= NF; ++i) {
                 if ($i ~ /^line:/) line = substr($i, 6)
                 if ($i ~ /^end:/) end = substr($i, 5)
               }
               if (end > 0) print $2 "\t" line "\t" end "\t" $1
             }')
}

command -v ctags >/dev/null || { echo "universal-ctags is missing; run apps/setup.sh"; exit 1; }
while IFS= read -r file; do check_file "$file"; done < <(sources)
check_functions
[[ $complaints -eq 0 ]] || { echo "$complaints complaints"; exit 1; }
