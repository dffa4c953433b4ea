#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""map_mpi.py POSES: runs facula-map-mpi on 1 to 4 ranks in the current folder and prints its figures, the
constants of the cost model in docs/map_mpi.md and what they predict, as tables in Markdown."""
import json
import math
import subprocess
import sys

REPEATS = 3
RESOLUTIONS_MM = (50, 20)
ROOMS = 16
PHASES = ("reading_s", "casting_s", "applying_s", "exchanging_s", "waiting_s", "writing_s")

# What the machine of the prediction is taken to have.
RANKS = 64
SCANS = 10000
BYTES_PER_SECOND = 1.25e9 / 16  # a link of 10 Gbit/s shared by the 16 ranks of a machine
LATENCY_S = 20e-6  # of one message
DISK_BYTES_PER_SECOND = 1e9  # for all ranks together


def run(poses, ranks, resolution):
    command = ["mpirun", "--oversubscribe", "--allow-run-as-root", "-n", str(ranks), "facula-map-mpi", poses,
               "--resolution-mm", str(resolution), "--threads", "1", "--out", "map", "--overwrite", "--json", "-"]
    answer = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if answer.returncode != 0:
        sys.exit(f"facula-map-mpi failed:\n{answer.stderr}")
    return json.loads(answer.stdout)


def best_run(poses, ranks, resolution):
    """The least time that each phase took in several runs; the machine has other work at times."""
    runs = [run(poses, ranks, resolution) for _ in range(REPEATS)]
    return runs[0] | {phase: min(figures[phase] for figures in runs) for phase in PHASES}


def row(values):
    print("| " + " | ".join(values) + " |")


def print_runs(resolution, runs):
    print(f"\nCells of {resolution} mm, {runs[1]['scans']} scans of {runs[1]['rays'] // runs[1]['scans']} rays:\n")
    row(["ranks", "reading", "casting", "applying", "exchanging", "waiting", "writing", "bytes a scan",
         "of them sent", "largest share", "peak memory"])
    row(["---"] * 11)
    for ranks, figures in runs.items():
        row([str(ranks)] + [f"{figures[phase]:.2f} s" for phase in PHASES] +
            [f"{figures['packed_bytes_per_scan']:.0f}", f"{figures['exchanged_bytes_per_scan']:.0f}",
             f"{figures['map_memory_mib']:.1f} MiB", f"{figures['peak_memory_mib']:.0f} MiB"])


def constants(figures):
    """Of one rank: per scan, per byte and per brick."""
    scans = figures["scans"]
    return {"rays": figures["rays"] / scans,
            "read": figures["reading_s"] / scans,
            "cast": figures["casting_s"] / scans,
            "bytes": figures["packed_bytes_per_scan"],
            "apply": figures["applying_s"] / scans,
            "bricks": figures["bricks"] / ROOMS,
            "scans_per_room": scans / ROOMS,
            "brick_bytes": figures["map_memory_mib"] * 2**20 / figures["bricks"],
            "write": figures["writing_s"] / figures["bricks"],
            "file_bytes": figures["file_bytes"] / ROOMS,
            "blocks": figures["blocks"] / ROOMS,
            "base_mib": figures["peak_memory_mib"] - figures["map_memory_mib"]}


def print_constants(by_resolution):
    print("\nConstants (one rank, one thread):\n")
    row(["constant"] + [f"{resolution} mm" for resolution in by_resolution])
    row(["---"] * (1 + len(by_resolution)))
    for name, key, factor, decimals in (
            ("reading a ray, ns", "read", 1e9, 0), ("casting a ray, ns", "cast", 1e9, 0),
            ("packed bytes a ray", "bytes", 1, 2), ("applying a packed byte, ns", "apply", 1e9, 2),
            ("memory of a brick in the map, bytes", "brick_bytes", 1, 0),
            ("writing a brick, us", "write", 1e6, 1), ("bricks a room", "bricks", 1, 0),
            ("files a room", "blocks", 1, 1), ("bytes of files a room", "file_bytes", 1, 0),
            ("process without its share, MiB", "base_mib", 1, 0)):
        values = []
        for c in by_resolution.values():
            divisor = c["rays"] if name.endswith(("a ray", "a ray, ns")) else 1
            divisor = c["bytes"] if "packed byte," in name else divisor
            values.append(f"{factor * c[key] / divisor:.{decimals}f}")
        row([name] + values)


def prediction(c):
    rounds = math.ceil(SCANS / RANKS)
    rooms = SCANS / c["scans_per_room"]
    sent = c["bytes"] * (RANKS - 1) / RANKS
    write = max(c["write"] * c["bricks"] * rooms / RANKS, c["file_bytes"] * rooms / DISK_BYTES_PER_SECOND)
    times = {"reading": rounds * c["read"], "casting": rounds * c["cast"],
             "exchanging": rounds * (sent / BYTES_PER_SECOND + RANKS * LATENCY_S),
             "applying": SCANS * c["apply"] / RANKS, "writing": write}
    return {**{f"{name}, s": f"{value:.1f}" for name, value in times.items()},
            "all, s": f"{sum(times.values()):.0f}",
            "one process, one thread, s": f"{SCANS * (c['read'] + c['cast'] + c['apply']):.0f}",
            "bytes sent by a rank": f"{rounds * sent:.3g}",
            "bytes sent by all": f"{SCANS * sent:.3g}",
            "map in all, GiB": f"{c['bricks'] * rooms * c['brick_bytes'] / 2**30:.2f}",
            "share of a rank, MiB": f"{c['bricks'] * rooms * c['brick_bytes'] / RANKS / 2**20:.0f}",
            "memory of a rank, MiB":
                f"{c['bricks'] * rooms * c['brick_bytes'] / RANKS / 2**20 + c['base_mib']:.0f}",
            "files": f"{c['blocks'] * rooms:.0f}",
            "bytes of files": f"{c['file_bytes'] * rooms:.3g}"}


def print_prediction(by_resolution):
    print(f"\nPredicted for {SCANS} scans on {RANKS} ranks:\n")
    predicted = [prediction(c) for c in by_resolution.values()]
    row([""] + [f"{resolution} mm" for resolution in by_resolution])
    row(["---"] * (1 + len(by_resolution)))
    for name in predicted[0]:
        row([name] + [p[name] for p in predicted])


def main():
    by_resolution = {}
    for resolution in RESOLUTIONS_MM:
        runs = {ranks: best_run(sys.argv[1], ranks, resolution) for ranks in (1, 2, 3, 4)}
        print_runs(resolution, runs)
        by_resolution[resolution] = constants(runs[1])
    print_constants(by_resolution)
    print_prediction(by_resolution)


if __name__ == "__main__":
    main()
