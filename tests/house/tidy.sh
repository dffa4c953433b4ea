#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs clang-tidy over every file of BUILD/compile_commands.json that lies below ROOT, on all cores.
# A file that was clean is not looked at again until it, a header of the project, its compile
# command or the configuration changes; the memory of that is BUILD/tidy.
# Usage: tidy.sh ROOT BUILD
set -euo pipefail
root=$(realpath "$1")
build=$(realpath "$2")
mkdir -p "$build/tidy"

# One key for what all files share.
shared=$( (clang-tidy --version; cat "$root/.clang-tidy"
           find "$root" -name '*.hpp' -not -path "$root/build/*" | sort | xargs -r cat) | sha256sum)

# "command <tab> file" for every entry below the root.
entries() {
  sed -nE 's/^ *"command": "(.*)",$/\1/p; s/^ *"file": "(.*)",?$/\1/p' \
    "$build/compile_commands.json" | paste - - |
    awk -F '\t' -v root="$root/" -v build="$build/" \
      'index($2, root) == 1 && index($2, build) != 1 && !seen[$2]++'
}

check() {
  local command=$1 file=$2 key
  key=$( (echo "$TIDY_SHARED $command"; cat "$file") | sha256sum | cut -c 1-40)
  [[ -e $TIDY_BUILD/tidy/$key ]] && return 0
  if output=$(clang-tidy -p "$TIDY_BUILD" --quiet "$file" 2>&1); then
    touch "$TIDY_BUILD/tidy/$key"
  else
    grep -E 'error:|warning:|note:' <<<"$output" || echo "$output"
    return 1
  fi
}
export -f check
export TIDY_SHARED=$shared TIDY_BUILD=$build

[[ -n $(entries) ]] || { echo "$build/compile_commands.json lists no file of $root"; exit 1; }
entries | tr '\t\n' '\0\0' |
  xargs -0 -r -n 2 -P "$(nproc)" bash -c 'check "$1" "$2"' check
