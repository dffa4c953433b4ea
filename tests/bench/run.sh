#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh [OUT.json] [ARGUMENT...]: sets up, builds, runs every benchmark five times and writes all
# results with medians and the machine's data to OUT.json (build/release/bench.json by default).
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
out=$(realpath -m "${1:-$root/build/release/bench.json}")
shift $(($# > 0 ? 1 : 0))
cd "$root"
apps/setup.sh
cmake --preset release
cmake --build --preset release --target benchmarks
tests/bench/run_programs.sh build/release/bin "$out" \
  --benchmark_repetitions=5 --benchmark_report_aggregates_only=true "$@"
echo "written: $out"
