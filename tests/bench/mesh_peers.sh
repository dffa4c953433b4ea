#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# mesh_peers.sh BIN_FOLDER SET [ROUNDS]: the ten bunny scans of SET (range/stanford-bunny) meshed by us
# and by Open3D (apps/setup.sh --peers) from the same 362 272 points with the same normals, one after
# the other; prints a table in Markdown: times are medians, distances in mm to the published mesh and
# back.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
bin=$1
set_folder=$2
rounds=${3:-3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '| method | time | triangles | median | p95 | back median | back p95 | verdict |\n'
printf -- '|---|---|---|---|---|---|---|---|\n'
"$bin/mesh_bunny" "$set_folder" "$rounds" "$work/points.ply"
if /usr/bin/python3 -c 'import open3d' 2>/dev/null; then
  seconds=$(/usr/bin/python3 "$here/mesh_peers.py" "$work/points.ply" "$work/peer.ply" "$rounds" | tail -n 1)
  "$bin/mesh_bunny" "$set_folder" --judge 'Open3D 0.16 Poisson, depth 8' "$seconds" "$work/peer.ply"
else
  echo 'Open3D is absent: apps/setup.sh --peers installs it' >&2
fi
