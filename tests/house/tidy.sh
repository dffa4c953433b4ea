#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs clang-tidy over every file of BUILD/compile_commands.json that lies below ROOT, on all cores.
# A file that was clean is not looked at again until it, a header of the project that it includes, its
# compile command or the configuration changes. The memory of that lies with the user's caches, so that
# another checkout gains by it too; what was not asked for in 30 days is forgotten.
# Usage: tidy.sh ROOT BUILD
set -euo pipefail
root=$(realpath "$1")
build=$(realpath "$2")
memory=${XDG_CACHE_HOME:-$HOME/.cache}/facula/tidy
mkdir -p "$build/tidy" "$memory"
find "$memory" -type f -mtime +30 -delete

# Checks pass over system headers, where clang's own headers are there to build what tells them so.
here=$(dirname "$(realpath "$0")")
major=$(clang-tidy --version | sed -nE 's/.*version ([0-9]+).*/\1/p' | head -n 1)
plugin=$build/tidy/own_declarations.so
if ! ${CXX:-g++} -std=c++17 -O1 -fPIC -shared -fno-rtti -isystem "/usr/lib/llvm-$major/include" \
  "$here/own_declarations.cpp" -o "$plugin"; then
  echo "expected libclang-$major-dev and llvm-$major-dev; checks read the system's headers whole, at" \
    "twice the time"
  plugin=
fi

# One key for what all files share.
shared=$( (clang-tidy --version; find "$root" -maxdepth 2 -name .clang-tidy | sort | xargs cat) | sha256sum)

# What every file of the project includes from it, straight: "file<tab>header", from the root.
(cd "$root" && find . -name build -prune -o \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
  xargs -0 -r grep -H -o -E '^#include <facula/[^>]+>' |
  sed -E 's|^\./([^:]+):#include <facula/(.*)>$|\1\t\2|') >"$build/tidy/includes"

# Itself and all headers of the project that a file includes, straight or through others.
closure() {
  awk -F '\t' -v start="$1" '
    { list[$1] = list[$1] " " $2 }
    END {
      todo[n = 1] = start
      known[start] = 1
      for (i = 1; i <= n; ++i) {
        count = split(list[todo[i]], headers, " ")
        for (k = 1; k <= count; ++k) if (!known[headers[k]]++) todo[++n] = headers[k]
      }
      for (file in known) print file
    }' "$TIDY_BUILD/tidy/includes" | sort
}

# "command <tab> file" for every entry below the root.
entries() {
  sed -nE 's/^ *"command": "(.*)",$/\1/p; s/^ *"file": "(.*)",?$/\1/p' \
    "$build/compile_commands.json" | paste - - |
    awk -F '\t' -v root="$root/" -v build="$build/" \
      'index($2, root) == 1 && index($2, build) != 1 && !seen[$2]++'
}

check() {
  local command=$1 file=$2 key
  key=$( (echo "$TIDY_SHARED ${command//"$TIDY_ROOT"/}"; cd "$TIDY_ROOT"
          closure "${file#"$TIDY_ROOT"/}" | xargs -r -d '\n' cat 2>/dev/null) |
         sha256sum | cut -c 1-40)
  [[ ! -e $TIDY_MEMORY/$key ]] || { touch "$TIDY_MEMORY/$key"; return 0; }
  local options=()
  [[ -z $TIDY_PLUGIN ]] || options=("--load=$TIDY_PLUGIN")
  # The analyzer cannot follow the storage of CGAL's exact numbers (Mpzf).
  [[ $file != *_cgal.cpp ]] || options+=(--checks=-clang-analyzer-cplusplus.NewDelete)
  if output=$(clang-tidy "${options[@]}" -p "$TIDY_BUILD" --quiet "$file" 2>&1); then
    touch "$TIDY_MEMORY/$key"
  else
    grep -E 'error:|warning:|note:' <<<"$output" || echo "$output"
    return 1
  fi
}
export -f check closure
export TIDY_SHARED=$shared TIDY_BUILD=$build TIDY_ROOT=$root TIDY_MEMORY=$memory TIDY_PLUGIN=$plugin

[[ -n $(entries) ]] || { echo "$build/compile_commands.json lists no file of $root"; exit 1; }
entries | tr '\t\n' '\0\0' |
  xargs -0 -r -n 2 -P "$(nproc)" bash -c 'check "$1" "$2"' check
