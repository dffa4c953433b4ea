#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fails when clang-format would change a C++ file below ROOT.
# Usage: format.sh ROOT
set -euo pipefail
cd "$1"
rooms=()
for room in acquire reconstruct map apps tests; do [[ -d $room ]] && rooms+=("$room"); done
find "${rooms[@]}" \( -name '*.hpp' -o -name '*.cpp' \) -not -path '*/node_modules/*' -print0 |
  xargs -0 -r -n 16 -P "$(nproc)" clang-format --dry-run -Werror
