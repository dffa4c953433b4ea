// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/mesh/mesh_color.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

Eigen::Vector3d color_of(const PointCloud& cloud, std::size_t point) {
  if (!cloud.colors.empty()) {
    const Color& c = cloud.colors[point];
    return {double(c[0]), double(c[1]), double(c[2])};
  }
  const float grey = cloud.intensity[point];
  return Eigen::Vector3d::Constant(std::isfinite(grey) ? 255 * std::clamp(grey, 0.0F, 1.0F) : 0);
}

}  // namespace

void color_mesh(TriangleMesh& mesh, const PointCloud& all, int num_threads) {
  all.check();
  require(!all.colors.empty() || !all.intensity.empty(),
          "the points have neither colour nor intensity; a mesh of them has no colour");
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all.points[i].allFinite()) finite.push_back(i);
  }
  require(!finite.empty(), "there is no point to take a colour from");
  const PointCloud cloud = selected(all, finite);
  const NearestNeighbours tree(cloud.points);
  mesh.colors.assign(mesh.vertices.size(), Color{});
  const auto color = [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (!mesh.vertices[v].allFinite()) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double weights = 0;
      for (const auto& near : tree.nearest(mesh.vertices[v], 4)) {
        const double weight = 1 / (double(near.squared_distance) + 1e-12);
        sum += weight * color_of(cloud, near.index);
        weights += weight;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double mean = sum[static_cast<int>(k)] / weights;
        mesh.colors[v][k] = static_cast<std::uint8_t>(std::lround(std::clamp(mean, 0.0, 255.0)));
      }
    }
  };
  parallel_for(mesh.vertices.size(), color, {num_threads, 1024});
}

}  // namespace facula
