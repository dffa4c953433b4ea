// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <vector>

#include <Eigen/Core>

namespace facula {

/// The box [0, a] x [0, b] x [0, c] of 12 triangles: bottom, top, front (y = 0), back, left, right.
TriangleMesh box_mesh(float a, float b, float c);

/// Unit normals of the mesh's vertices, from its triangles by area.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh);

}  // namespace facula
