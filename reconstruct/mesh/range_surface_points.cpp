// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/point_spacing.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/mesh/range_surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr int kRim = 6;             // corners of a disc
constexpr double kCover = 1.5;      // radius over the sampling distance: neighbours' discs overlap
constexpr double kScatter = 1.6;    // mean over nearest distance of points scattered at random
constexpr float kRimWeight = 0.1F;  // discs fade outwards, so that they blend

/// A fan of triangles about a point, across its normal.
class DiscMaker {
 public:
  DiscMaker(const PosedCloud& scan, const SightLines& sight) : cloud_(scan.cloud), sight_(sight) {}

  void add(std::size_t point, float radius, RangeSurface& surface) const {
    const Eigen::Vector3f& toward = sight_.toward[point];
    Eigen::Vector3f normal = cloud_.normals[point];
    if (normal.dot(toward) < 0) normal = -normal;
    SightVertex corner{.point = cloud_.points[point], .toward = toward};
    corner.cosine = std::clamp(normal.dot(toward), 0.05F, 1.0F);
    corner.weight = corner.cosine * sigma_weight(cloud_, point);
    const auto centre = static_cast<std::uint32_t>(surface.vertices.size());
    surface.vertices.push_back(corner);
    corner.weight *= kRimWeight;
    const Eigen::Vector3f u = normal.unitOrthogonal();
    const Eigen::Vector3f v = normal.cross(u);
    for (int k = 0; k < kRim; ++k) {
      const float angle = 2 * static_cast<float>(M_PI) * static_cast<float>(k) / kRim;
      corner.point = cloud_.points[point] + radius * (std::cos(angle) * u + std::sin(angle) * v);
      surface.vertices.push_back(corner);
      const auto rim = static_cast<std::uint32_t>(k);
      surface.triangles.push_back({centre, centre + 1 + rim, centre + 1 + (rim + 1) % kRim});
    }
  }

 private:
  const PointCloud& cloud_;
  const SightLines& sight_;
};

}  // namespace

RangeSurface surface_of_points(const PosedCloud& scan, const SightLines& sight) {
  const PointCloud& cloud = scan.cloud;
  RangeSurface surface;
  const SamplingDistance sampling = sampling_distance(cloud);
  surface.step = std::max(kScatter * sampling.nearest, sampling.across);
  if (surface.step <= 0) {
    surface.skipped_points = cloud.size();
    return surface;
  }
  const double usual = std::max(1e-12, quantile(sight.distance, 0.5));
  const DiscMaker discs(scan, sight);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool usable = !sight.toward[i].isZero() && cloud.normals[i].allFinite() &&
                        cloud.normals[i].squaredNorm() > 0.5F;
    if (!usable) {
      ++surface.skipped_points;
      continue;
    }
    const double radius = kCover * surface.step * static_cast<double>(sight.distance[i]) / usual;
    discs.add(i, static_cast<float>(radius), surface);
  }
  return surface;
}

}  // namespace facula
