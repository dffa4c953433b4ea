// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <vector>

namespace facula {

/// Turns whole pieces (triangles joined by vertices, already of one orientation each) so that their
/// area looks along `outward`, one direction per vertex of any length; where `outward` is empty, so
/// that they enclose a positive volume about their centroid.
void orient_mesh(TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& outward);

}  // namespace facula
