#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh_peers.py POINTS.ply MESH.ply ROUNDS: Open3D's screened Poisson reconstruction at depth 8.

POINTS.ply holds oriented points as mesh_bunny wrote them. Writes the mesh and prints the median time
of the reconstruction alone [s].
"""
import statistics
import sys
import time

import open3d as o3d

cloud = o3d.io.read_point_cloud(sys.argv[1])
if not cloud.has_normals():
    sys.exit(f"{sys.argv[1]} holds no normals")
times = []
for _ in range(int(sys.argv[3])):
    begin = time.perf_counter()
    mesh, density = o3d.geometry.TriangleMesh.create_from_point_cloud_poisson(
        cloud, depth=8, n_threads=2)
    times.append(time.perf_counter() - begin)
o3d.io.write_triangle_mesh(sys.argv[2], mesh)
print(f"{statistics.median(times):.3f}")
