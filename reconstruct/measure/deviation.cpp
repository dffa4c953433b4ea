// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/measure/deviation.hpp>
#include <facula/reconstruct/measure/deviation_mesh_sign.hpp>
#include <facula/reconstruct/mesh/triangle_tree.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Counts {
  std::size_t too_far = 0;
  std::size_t not_finite = 0;
  std::size_t beyond_rim = 0;
};

/// Fills the values; `measure(point, counts)` gives one, or NaN and counts why.
template <typename Measure>
Deviations measured(const std::vector<Eigen::Vector3f>& points,
                    int num_threads,
                    const Measure& measure) {
  Deviations result;
  result.values.assign(points.size(), kNone);
  const auto map = [&](std::size_t begin, std::size_t end) {
    Counts part;
    for (std::size_t i = begin; i < end; ++i) {
      if (points[i].allFinite()) {
        result.values[i] = measure(points[i], part);
      } else {
        ++part.not_finite;
      }
    }
    return part;
  };
  const auto combine = [](const Counts& a, const Counts& b) {
    return Counts{a.too_far + b.too_far, a.not_finite + b.not_finite, a.beyond_rim + b.beyond_rim};
  };
  const Counts all = parallel_reduce(
      points.size(), Counts{}, map, combine, {.num_threads = num_threads, .chunk = 1024});
  result.too_far = all.too_far;
  result.not_finite = all.not_finite;
  result.beyond_rim = all.beyond_rim;
  return result;
}

/// The values that are numbers.
std::vector<double> numbers_of(const std::vector<double>& values) {
  std::vector<double> result;
  result.reserve(values.size());
  for (const double value : values) {
    if (std::isfinite(value)) result.push_back(value);
  }
  return result;
}

/// The nearest-rank quantile; puts the values into another order.
double quantile(std::vector<double>& values, double share) {
  const auto rank =
      static_cast<std::ptrdiff_t>(std::llround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

/// Whether any triangle is more than a line or a spot.
bool has_area(const TriangleMesh& mesh) {
  return std::any_of(
      mesh.triangles.begin(), mesh.triangles.end(), [&](const TriangleMesh::Triangle& face) {
        const Eigen::Vector3d a = mesh.vertices[face[0]].cast<double>();
        const Eigen::Vector3d b = mesh.vertices[face[1]].cast<double>() - a;
        const Eigen::Vector3d c = mesh.vertices[face[2]].cast<double>() - a;
        return b.cross(c).norm() > 1e-12 * std::max(b.squaredNorm(), c.squaredNorm());
      });
}

}  // namespace

void DeviationOptions::check() const {
  require(max_distance > 0, "expected a largest distance above 0 mm, got ", 1000 * max_distance);
}

Deviations deviations_from_mesh(const std::vector<Eigen::Vector3f>& points,
                                const TriangleMesh& mesh,
                                const DeviationOptions& options) {
  options.check();
  mesh.check();
  const TriangleTree tree(mesh);
  require(!tree.empty(), "the mesh has no triangle; deviations need a surface");
  require(has_area(mesh),
          "the ",
          mesh.triangles.size(),
          " triangles of the mesh have no area; deviations need a surface, so mesh it anew");
  const MeshSides sides(mesh);
  const double within = options.max_distance * options.max_distance;
  const auto measure = [&](const Eigen::Vector3f& point, Counts& counts) {
    const Eigen::Vector3d x = point.cast<double>();
    const TriangleTree::Nearest nearest = tree.nearest(x, within);
    if (!std::isfinite(nearest.squared_distance)) {
      ++counts.too_far;
      return kNone;
    }
    const MeshSides::Place place = sides.place(x, nearest.triangle);
    if (place.on_rim) ++counts.beyond_rim;
    return std::sqrt(nearest.squared_distance) * (place.in_front ? 1 : -1);
  };
  Deviations result = measured(points, options.num_threads, measure);
  result.has_sign = true;
  return result;
}

Deviations deviations_from_cloud(const std::vector<Eigen::Vector3f>& points,
                                 const PointCloud& reference,
                                 const DeviationOptions& options) {
  options.check();
  reference.check();
  const NearestNeighbours tree(reference.points, options.num_threads);
  require(tree.size() > 0, "the reference cloud has no finite point to measure from");
  const auto measure = [&](const Eigen::Vector3f& point, Counts& counts) {
    const std::size_t nearest = tree.nearest(point).index;
    const Eigen::Vector3d apart = point.cast<double>() - reference.points[nearest].cast<double>();
    const double distance = apart.norm();
    if (distance > options.max_distance) {
      ++counts.too_far;
      return kNone;
    }
    if (reference.normals.empty()) return distance;
    const Eigen::Vector3d normal = reference.normals[nearest].cast<double>();
    return normal.allFinite() && normal.squaredNorm() > 0.5 ? apart.dot(normal.normalized())
                                                            : kNone;
  };
  Deviations result = measured(points, options.num_threads, measure);
  result.has_sign = !reference.normals.empty();
  return result;
}

DeviationStatistics deviation_statistics(const std::vector<double>& values) {
  std::vector<double> numbers = numbers_of(values);
  DeviationStatistics result;
  result.count = numbers.size();
  if (numbers.empty()) return result;
  const double n = static_cast<double>(numbers.size());
  double squares = 0;
  for (const double value : numbers) {
    result.mean += value / n;
    squares += value * value;
  }
  result.rms = std::sqrt(squares / n);
  double spread = 0;
  for (const double value : numbers) spread += std::pow(value - result.mean, 2);
  if (numbers.size() > 1) result.standard_deviation = std::sqrt(spread / (n - 1));
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  result.least = *least;
  result.most = *most;
  result.median = quantile(numbers, 0.5);
  for (double& value : numbers) value = std::abs(value);
  result.median_absolute = quantile(numbers, 0.5);
  result.p95_absolute = quantile(numbers, 0.95);
  result.max_absolute = *std::max_element(numbers.begin(), numbers.end());
  return result;
}

double typical_reach(const std::vector<double>& values) {
  std::vector<double> sizes = numbers_of(values);
  if (sizes.empty()) return 0;
  for (double& size : sizes) size = std::abs(size);
  return std::min(quantile(sizes, 0.995), 5 * quantile(sizes, 0.6827));
}

DeviationBins bin_deviations(const std::vector<double>& values, std::size_t count) {
  require(count >= 1, "expected 1 bin or more, got ", count);
  std::vector<double> numbers = numbers_of(values);
  DeviationBins bins;
  bins.counts.assign(count, 0);
  if (numbers.empty()) return bins;
  bins.high = typical_reach(numbers);
  bins.low = *std::min_element(numbers.begin(), numbers.end()) < 0 ? -bins.high : 0;
  const double size = (bins.high - bins.low) / static_cast<double>(count);
  for (const double value : numbers) {
    if (value < bins.low) {
      ++bins.below;
    } else if (value > bins.high) {
      ++bins.above;
    } else {
      const double place = size > 0 ? (value - bins.low) / size : 0;
      ++bins.counts[std::min(static_cast<std::size_t>(place), count - 1)];
    }
  }
  return bins;
}

}  // namespace facula
