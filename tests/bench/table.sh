#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# table.sh PROGRAM [ARGUMENT...]: runs a program of Google Benchmark five times and prints the medians
# as a table in Markdown: wall clock, processor time, and the counters that every benchmark adds.
set -euo pipefail
program=$1
shift
"$program" --benchmark_repetitions=5 --benchmark_report_aggregates_only=true \
  --benchmark_format=csv "$@" 2>/dev/null | awk -F , '
  function plain(text) { gsub(/^"|"$/, "", text); return text }
  function length_of_time(value) {
    if (value >= 1000) return sprintf("%.3g s", value / 1000)
    if (value >= 1) return sprintf("%.3g ms", value)
    return sprintf("%.3g us", value * 1000)
  }
  /^name,/ {
    columns = NF
    for (i = 1; i <= NF; ++i) column[i] = plain($i)
    print "| benchmark | wall clock | processor time | counted |\n|---|---|---|---|"
    next
  }
  plain($1) ~ /_median$/ {
    name = plain($1)
    sub(/_median$/, "", name)
    gsub(/\/(process_time|real_time|iterations:[0-9]+|repeats:[0-9]+)/, "", name)
    unit = plain($5) == "ns" ? 1e-6 : plain($5) == "us" ? 1e-3 : plain($5) == "s" ? 1000 : 1
    counted = ""
    for (i = 8; i <= columns; ++i) {
      if (column[i] ~ /error_(occurred|message)/ || plain($i) == "") continue
      counted = counted (counted == "" ? "" : ", ") column[i] sprintf(" %.4g", plain($i))
    }
    printf "| %s | %s | %s | %s |\n", name, length_of_time($3 * unit), length_of_time($4 * unit), counted
  }'
