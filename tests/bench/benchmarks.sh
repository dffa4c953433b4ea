#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# benchmarks.sh [FILE.md]: sets up, builds, and measures every table of BENCHMARKS.md (or FILE.md)
# anew. What stands between a line `<!-- measured: COMMAND -->` and the next `<!-- end -->` is replaced
# by what COMMAND prints, run from the root of the project; all other text stays. The file is replaced
# once every command has succeeded. FACULA_BENCH_ONLY=WORD measures only the commands that hold WORD.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
page=$(realpath "${1:-$root/BENCHMARKS.md}")
only=${FACULA_BENCH_ONLY:-}
[[ -r $page ]] || { echo "expected a page to measure anew, got '$page', which cannot be read" >&2; exit 2; }
cd "$root"
if [[ -z ${FACULA_BENCH_BUILT:-} ]]; then
  apps/setup.sh
  apps/setup.sh --peers
  cmake --preset release
  cmake --build --preset release
fi

fresh=$(mktemp "$page.XXXXXX")
trap 'rm -f "$fresh"' EXIT
section=   # the command whose table is being passed
measured=  # not empty: that table was made anew, and the old lines go
while IFS= read -r line || [[ -n $line ]]; do
  if [[ $line == '<!-- end -->' ]]; then
    [[ -n $section ]] || { echo "$page: an end without a beginning" >&2; exit 1; }
    section=
    measured=
  fi
  [[ -n $measured ]] || printf '%s\n' "$line" >>"$fresh"
  if [[ $line =~ ^'<!-- measured: '(.*)' -->'$ ]]; then
    [[ -z $section ]] || { echo "$page: a table begins before the end of '$section'" >&2; exit 1; }
    section=${BASH_REMATCH[1]}
    [[ $section == *"$only"* ]] || continue
    measured=yes
    echo "measuring: $section" >&2
    bash -c "set -euo pipefail; $section" </dev/null >>"$fresh"
  fi
done <"$page"
[[ -z $section ]] || { echo "$page: '$section' has no end" >&2; exit 1; }
chmod --reference="$page" "$fresh"
sync "$fresh"
mv "$fresh" "$page"
trap - EXIT
echo "written: $page" >&2
