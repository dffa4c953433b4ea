#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# map_mpi.sh [SCANS_PER_ROOM]: measures facula-map-mpi on 1 to 4 ranks of one thread each, on scans of a
# simulated room, set 16 times side by side, and prints the tables of docs/map_mpi.md with what they
# predict for 10 000 scans on 64 ranks. Takes some minutes and 3 GB in the temporary folder.
set -euo pipefail
stations=(-1500,-300,1100 1400,-700,1300 -900,900,1200 1200,900,1000)
stations=("${stations[@]:0:${1:-4}}")
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
cmake --build --preset release --target facula facula-map-mpi >/dev/null
export PATH=$root/build/release/bin:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

for i in "${!stations[@]}"; do
  read -r -a position <<<"${stations[$i]//,/ }"
  facula simulate data/scenes/furnished_room.toml --rig data/rigs/head_fs1500.toml --step-deg 1 \
    --position-mm "${position[@]}" --out "capture$i" >/dev/null
  facula extract "capture$i" --out "s$i.pcd" >/dev/null
  rm -r "capture$i"
done

# A building of 4 x 4 such rooms, 9 m apart along x and 7 m along y.
for room in {0..15}; do
  for i in "${!stations[@]}"; do
    grep -a -m 1 '^VIEWPOINT' "s$i.pcd" | awk -v room="$room" -v i="$i" '{
      printf "[[scan]]\nname = \"room %d, scan %d\"\nfile = \"s%d.pcd\"\n", room, i, i
      printf "translation_mm = [%.6f, %.6f, %.6f]\n", \
        1000 * ($2 + 9 * (room % 4)), 1000 * ($3 + 7 * int(room / 4)), 1000 * $4
      printf "quaternion_xyzw = [%s, %s, %s, %s]\n", $6 + 0, $7 + 0, $8 + 0, $5 + 0
    }'
  done
done | sed -E '/^quaternion/s/([[ ])(-?[0-9]+)([],])/\1\2.0\3/g' >poses.toml

python3 "$root/tests/bench/map_mpi.py" poses.toml
