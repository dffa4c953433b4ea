#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""table.py PROGRAM [ARGUMENT...]: runs a program of Google Benchmark five times and prints the medians
as a table in Markdown: wall clock, processor time, and the counters that every benchmark adds. Fails
when the program or one of its benchmarks does."""
import json
import re
import subprocess
import sys

UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
SETTINGS = re.compile(r"/(process_time|real_time|iterations:\d+|repeats:\d+)")
OWN_FIELDS = {"family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads",
              "iterations", "real_time", "cpu_time"}


def length_of_time(value, unit):
    seconds = value * UNITS[unit]
    for name in ("s", "ms"):
        if seconds >= UNITS[name]:
            return f"{seconds / UNITS[name]:.3g} {name}"
    return f"{seconds / UNITS['us']:.3g} us"


def row(run):
    counted = [f"{name} {value:.4g}" for name, value in run.items()
               if isinstance(value, (int, float)) and name not in OWN_FIELDS]
    times = [length_of_time(run[field], run["time_unit"]) for field in ("real_time", "cpu_time")]
    return f"| {SETTINGS.sub('', run['run_name'])} | {times[0]} | {times[1]} | {', '.join(counted)} |"


def main():
    command = sys.argv[1:] + ["--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true",
                              "--benchmark_format=json"]
    answer = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if answer.returncode != 0:
        sys.exit(f"{sys.argv[1]} failed:\n{answer.stderr}")
    runs = json.loads(answer.stdout)["benchmarks"]
    for run in runs:
        if run.get("error_occurred"):
            sys.exit(f"{sys.argv[1]}: {run['name']}: {run['error_message']}")
    print("| benchmark | wall clock | processor time | counted |\n|---|---|---|---|")
    for run in runs:
        if run.get("aggregate_name") == "median":
            print(row(run))


if __name__ == "__main__":
    main()
