// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>

namespace facula {

/// Gives every vertex the mean colour of the (up to) four nearest points, weighted by inverse
/// squared distance: their colours, else their intensity as grey, which is the brightness of the
/// stripe in the frames. Throws Error when the cloud has neither.
void color_mesh(TriangleMesh& mesh, const PointCloud& cloud, int num_threads = 0);

}  // namespace facula
