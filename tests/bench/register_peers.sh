#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# register_peers.sh BUN_CONF [ROUNDS]: Facula's pair registration beside Open3D's on pairs of bunny
# scans, from the loaded points (normals, covariances and search trees included) and the loop alone,
# in turn on the same cores. Prints medians over all rounds. Needs build/release and Debian's
# python3-open3d.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
conf=$1
rounds=${2:-5}
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
speed=$root/build/release/bin/register_speed
"$speed" write "$conf" "$folder/pairs"
for _ in $(seq "$rounds"); do
  "$speed" time "$conf" 2 >>"$folder/lines"
  OMP_NUM_THREADS=${OMP_NUM_THREADS:-$(nproc)} \
    /usr/bin/python3 "$root/tests/bench/register_peers.py" "$folder/pairs" 2 >>"$folder/lines"
done
printf '%-24s %-16s %10s %10s %10s %10s\n' who pair total_ms loop_ms off_deg off_mm
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
    if (n) printf "%-24s %-16s %10.1f %10.1f %10.4f %10.4f\n", who, pair, middle(total, n),
                  middle(loop, n), degrees, millimetres
    n = 0
  }
  $1 != who || $2 != pair { flush(); who = $1; pair = $2 }
  { ++n; total[n] = $3 + 0; loop[n] = $4 + 0; degrees = $5; millimetres = $6 }
  END { flush() }'
