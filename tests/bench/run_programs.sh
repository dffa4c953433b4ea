#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run_programs.sh BIN_FOLDER OUT.json [ARGUMENT...]: runs the benchmarks that BIN_FOLDER/benchmarks.txt
# names and joins what they measured into one JSON file. Arguments go to each program (Google
# Benchmark's options).
set -euo pipefail
bin=$1
out=$2
shift 2
parts=$(mktemp -d)
trap 'rm -rf "$parts"' EXIT

cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1 | tr -d '"\\')
{
  printf '{\n"machine": {"cpu": "%s", "cores": %s, "kernel": "%s", "date": "%s"},\n"programs": [\n' \
    "$cpu" "$(nproc)" "$(uname -sr)" "$(date -u +%Y-%m-%dT%H:%M:%SZ)"
  separator=
  while IFS= read -r name; do
    "$bin/$name" </dev/null --benchmark_out="$parts/$name.json" --benchmark_out_format=json "$@" >&2
    printf '%s{"program": "%s", "result":\n' "$separator" "$name"
    cat "$parts/$name.json"
    printf '}'
    separator=$',\n'
  done <"$bin/benchmarks.txt"
  printf '\n]\n}\n'
} >"$parts/all.json"
# A benchmark that gave up says so in its entry and still exits with 0; absent data may be absent.
if grep '"error_message"' "$parts/all.json" | grep -v 'is absent'; then
  echo "a benchmark failed, see above" >&2
  exit 1
fi
mv "$parts/all.json" "$out"
