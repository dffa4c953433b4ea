#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# register_peers.sh BIN_FOLDER BUN_CONF [ROUNDS]: our pair registration and Open3D's
# (apps/setup.sh --peers) on pairs of bunny scans, in turn on the same cores; prints a table in Markdown
# with the medians over all rounds: from the loaded points (normals, covariances and search trees
# included), the loop alone, and how far off the published pose it ends.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
speed=$1/register_speed
conf=$2
rounds=${3:-5}
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
"$speed" write "$conf" "$folder/pairs"
for _ in $(seq "$rounds"); do
  "$speed" time "$conf" 2 >>"$folder/lines"
  OMP_NUM_THREADS=${OMP_NUM_THREADS:-$(nproc)} \
    /usr/bin/python3 "$here/register_peers.py" "$folder/pairs" 2 >>"$folder/lines"
done
printf '| pair | method | total | loop | off |\n'
printf -- '|---|---|---|---|---|\n'
sort -k2,2 -k1,1 -s "$folder/lines" | LC_ALL=C awk '
  function middle(values, n,   i, j, v) {
    for (i = 2; i <= n; ++i) {
      v = values[i]
      for (j = i - 1; j > 0 && values[j] > v; --j) values[j + 1] = values[j]
      values[j + 1] = v
    }
    return values[int((n + 1) / 2)]
  }
  function flush() {
    if (n) printf "| %s | %s | %.1f ms | %.1f ms | %.4f°, %.4f mm |\n", pair, who,
                  middle(total, n), middle(loop, n), degrees, millimetres
    n = 0
  }
  $1 != who || $2 != pair { flush(); who = $1; pair = $2 }
  { ++n; total[n] = $3 + 0; loop[n] = $4 + 0; degrees = $5; millimetres = $6 }
  END { flush() }'
