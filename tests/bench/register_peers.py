#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""register_peers.py SCANS ROUNDS: times Open3D's registration on pairs of scans.

SCANS is a folder that register_speed wrote: of every pair source.ply, target.ply, start.txt and
published.txt (4 x 4 matrices). Prints, per pair, method and round, a line as register_speed does:
who, pair, total [ms], loop [ms], off the published pose [deg], [mm].
"""
import copy
import pathlib
import sys
import time

import numpy as np
import open3d as o3d

REGISTRATION = o3d.pipelines.registration
MAX_DISTANCE = 0.02  # m; the start leaves points up to 20 mm off
CRITERIA = REGISTRATION.ICPConvergenceCriteria(max_iteration=100)  # 30 is its default
NEIGHBOURS = o3d.geometry.KDTreeSearchParamKNN(20)


def generalized(source, target, start):
    return REGISTRATION.registration_generalized_icp(
        source, target, MAX_DISTANCE, start,
        REGISTRATION.TransformationEstimationForGeneralizedICP(), CRITERIA)


def point_to_plane(source, target, start):
    return REGISTRATION.registration_icp(
        source, target, MAX_DISTANCE, start,
        REGISTRATION.TransformationEstimationPointToPlane(), CRITERIA)


def off(found, published):
    turn = np.linalg.inv(published[:3, :3]) @ found[:3, :3]
    skew = [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    degrees = np.degrees(np.arctan2(np.linalg.norm(skew), np.trace(turn) - 1))
    return degrees, 1000 * np.linalg.norm(found[:3, 3] - published[:3, 3])


def measure(name, prepare, register, pair):
    source, target, start, published = pair
    source, target = copy.deepcopy(source), copy.deepcopy(target)
    begin = time.perf_counter()
    prepare(source, target)
    ready = time.perf_counter()
    result = register(source, target, start)
    end = time.perf_counter()
    degrees, millimetres = off(result.transformation, published)
    return f"{1e3 * (end - begin):.2f} {1e3 * (end - ready):.2f} {degrees:.4f} {millimetres:.4f}"


def covariances(source, target):
    source.estimate_covariances(NEIGHBOURS)
    target.estimate_covariances(NEIGHBOURS)


def normals(source, target):
    target.estimate_normals(NEIGHBOURS)


def main():
    folder, rounds = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    for pair_folder in sorted(p for p in folder.iterdir() if p.is_dir()):
        pair = (o3d.io.read_point_cloud(str(pair_folder / "source.ply")),
                o3d.io.read_point_cloud(str(pair_folder / "target.ply")),
                np.loadtxt(pair_folder / "start.txt"),
                np.loadtxt(pair_folder / "published.txt"))
        for _ in range(rounds):
            for name, prepare, register in (
                    ("open3d_gicp_as_called", lambda s, t: None, generalized),
                    ("open3d_gicp", covariances, generalized),
                    ("open3d_point_to_plane", normals, point_to_plane)):
                print(name, pair_folder.name, measure(name, prepare, register, pair), flush=True)


if __name__ == "__main__":
    main()
