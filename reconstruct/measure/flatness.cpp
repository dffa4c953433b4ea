// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/measure/flatness.hpp>
#include <facula/reconstruct/measure/principal_frame.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace facula {
namespace {

/// Finite points as doubles and where they stand in the cloud.
struct Samples {
  std::vector<Eigen::Vector3d> x;
  std::vector<std::size_t> index;
};

Samples samples_of(const PointCloud& cloud, const std::vector<std::size_t>& indices) {
  cloud.check();
  Samples samples;
  samples.x.reserve(indices.size());
  samples.index.reserve(indices.size());
  for (const std::size_t i : indices) {
    require(i < cloud.size(), "expected points of a cloud of ", cloud.size(), ", got number ", i);
    if (!cloud.points[i].allFinite()) continue;
    samples.x.emplace_back(cloud.points[i].cast<double>());
    samples.index.push_back(i);
  }
  require(samples.x.size() >= 3,
          "flatness needs at least 3 points that are finite, the cloud has ",
          samples.x.size());
  return samples;
}

/// Deviations over a stretch of the points.
struct Deviations {
  double most = -std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  std::size_t most_at = 0;
  std::size_t least_at = 0;
  double squares = 0;
};

Deviations joined(const Deviations& a, const Deviations& b) {
  Deviations result = a;
  if (b.most > a.most) {
    result.most = b.most;
    result.most_at = b.most_at;
  }
  if (b.least < a.least) {
    result.least = b.least;
    result.least_at = b.least_at;
  }
  result.squares += b.squares;
  return result;
}

Deviations deviations_of(const Samples& samples, const Flatness& flatness, int num_threads) {
  const auto map = [&](std::size_t begin, std::size_t end) {
    Deviations part;
    for (std::size_t i = begin; i < end; ++i) {
      const double d = flatness.reference.normal.dot(samples.x[i] - flatness.centroid);
      if (d > part.most) {
        part.most = d;
        part.most_at = i;
      }
      if (d < part.least) {
        part.least = d;
        part.least_at = i;
      }
      part.squares += d * d;
    }
    return part;
  };
  return parallel_reduce(
      samples.x.size(), Deviations{}, map, joined, {.num_threads = num_threads, .chunk = 16384});
}

/// Peaks are what stands out of the material, on the side the scanner saw.
bool faces_away(const PointCloud& cloud, const Samples& samples, const Flatness& flatness) {
  if (cloud.sensor_origin.empty()) return flatness.reference.distance < 0;
  double seen = 0;
  for (const std::size_t i : samples.index) {
    const Eigen::Vector3f to_sensor = cloud.sensor_origin[i] - cloud.points[i];
    if (to_sensor.allFinite()) seen += flatness.reference.normal.dot(to_sensor.cast<double>());
  }
  return seen < 0;
}

MinimumZone zone_of(const Samples& samples, const Plane& reference, int num_threads) {
  Width width = width_of(samples.x, {.num_threads = num_threads});
  MinimumZone zone;
  zone.total = width.width;
  zone.plane = {width.direction, (width.low + width.high) / 2};
  if (width.direction.dot(reference.normal) < 0) {
    zone.plane = {-zone.plane.normal, -zone.plane.distance};
    std::swap(width.low_points, width.high_points);
  }
  for (const auto i : width.low_points) zone.low_contacts.push_back(samples.index[i]);
  for (const auto i : width.high_points) zone.high_contacts.push_back(samples.index[i]);
  return zone;
}

}  // namespace

Flatness measure_flatness(const PointCloud& cloud,
                          const std::vector<std::size_t>& indices,
                          const FlatnessOptions& options) {
  const Samples samples = samples_of(cloud, indices);
  const PrincipalFrame frame = principal_frame(samples.x, options.num_threads);
  require(frame.mean_squares(1) > 1e-12 * frame.mean_squares(0),
          "the ",
          samples.x.size(),
          " points lie on one line or in one spot, so they have no plane; add points beside it");
  Flatness flatness;
  flatness.points = samples.x.size();
  flatness.centroid = frame.origin;
  flatness.reference.normal = frame.axes.row(2).transpose();
  flatness.reference.distance = flatness.reference.normal.dot(frame.origin);
  if (faces_away(cloud, samples, flatness)) {
    flatness.reference = {-flatness.reference.normal, -flatness.reference.distance};
  }
  const Deviations all = deviations_of(samples, flatness, options.num_threads);
  flatness.peak = all.most;
  flatness.valley = 0 - all.least;  // never minus zero
  flatness.total = all.most - all.least;
  flatness.root_mean_square = std::sqrt(all.squares / static_cast<double>(flatness.points));
  flatness.peak_point = samples.index[all.most_at];
  flatness.valley_point = samples.index[all.least_at];
  if (options.minimum_zone) {
    flatness.minimum_zone = zone_of(samples, flatness.reference, options.num_threads);
  }
  return flatness;
}

Flatness measure_flatness(const PointCloud& cloud, const FlatnessOptions& options) {
  std::vector<std::size_t> all(cloud.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return measure_flatness(cloud, all, options);
}

}  // namespace facula
