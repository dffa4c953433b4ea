// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/measure/surface_noise.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

constexpr std::size_t kSample = 16000;  // evens out what a line scanner samples unevenly [1]
constexpr std::size_t kPlaces = 2000;   // enough for a median to a few per cent [1]
constexpr int kNeighbours = 12;         // few: a wider patch takes a bend for noise [1]
constexpr double kReach = 0.3;          // of the step from stripe to stripe [1]
constexpr double kThickest = 0.35;      // patch that passes for a surface [1]

std::vector<Eigen::Vector3f> draw_sample(const PointCloud& cloud) {
  std::vector<Eigen::Vector3f> sample;
  std::copy_if(cloud.points.begin(),
               cloud.points.end(),
               std::back_inserter(sample),
               [](const Eigen::Vector3f& p) { return p.allFinite(); });
  Random random(1);
  const std::size_t count = std::min(kSample, sample.size());
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(sample[i], sample[i + random.below(sample.size() - i)]);
  }
  sample.resize(count);
  return sample;
}

/// The neighbours about their own plane.
struct Patch {
  double noise = 0;      ///< standard deviation, n - 3 degrees of freedom [m]
  double breadth = 0;    ///< standard deviation along the patch's narrower side [m]
  double thickness = 1;  ///< that across the patch over its breadth [1]
};

Patch patch_of(const std::vector<Eigen::Vector3f>& points,
               const std::vector<NearestNeighbours::Neighbour>& neighbours) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const auto& n : neighbours) centroid += points[n.index].cast<double>();
  centroid /= static_cast<double>(neighbours.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& n : neighbours) {
    const Eigen::Vector3d d = points[n.index].cast<double>() - centroid;
    scatter += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d spread = solver.eigenvalues().cwiseMax(0);
  const double freedom = static_cast<double>(neighbours.size()) - 3;
  return {std::sqrt(spread(0) / freedom),
          std::sqrt(spread(1) / static_cast<double>(neighbours.size())),
          spread(1) > 0 ? std::sqrt(spread(0) / spread(1)) : 1};
}

/// Median over some of the points.
Patch usual_patch(const std::vector<Eigen::Vector3f>& points,
                  const NearestNeighbours& tree,
                  int neighbours) {
  const std::size_t places = std::min(kPlaces, points.size());
  std::vector<double> noise(places);
  std::vector<double> breadth(places);
  std::vector<double> thickness(places);
  const auto measure = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Patch patch = patch_of(points, tree.nearest(points[i], neighbours));
      noise[i] = patch.noise;
      breadth[i] = patch.breadth;
      thickness[i] = patch.thickness;
    }
  };
  parallel_for(places, measure, {.num_threads = 0, .chunk = 64});
  return {median(noise), median(breadth), median(thickness)};
}

}  // namespace

double surface_noise(const PointCloud& cloud) {
  const std::vector<Eigen::Vector3f> sample = draw_sample(cloud);
  if (sample.size() < kNeighbours) return 0;
  const NearestNeighbours tree(sample);
  const double across = sampling_distance(cloud).across;
  // Points of one stripe lie in the laser's plane whatever the noise, so a patch must reach the
  // next stripes. Where the noise is wider than the patch, wider patches show the surface; a cloud
  // that fills space shows none at any width.
  for (int n = kNeighbours; n == kNeighbours || n < static_cast<int>(sample.size() / 8); n *= 4) {
    const Patch patch = usual_patch(sample, tree, n);
    if (patch.breadth > kReach * across && patch.thickness < kThickest) return patch.noise;
  }
  return 0;
}

}  // namespace facula
