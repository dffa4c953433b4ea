// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/largest_piece.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/pcl_bridge.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include <pcl/console/print.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>
#include <pcl/search/kdtree.h>

namespace facula {
namespace {

using Indices = std::vector<std::size_t>;

constexpr std::size_t kSample = 12000;  // points among which RANSAC counts [1]
constexpr int kRefinements = 12;
constexpr int kFailures = 4;  // candidates too small before the search ends

/// PCL prints when it finds nothing; a library does not print.
class QuietPcl {
 public:
  QuietPcl() : level_(pcl::console::getVerbosityLevel()) {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  ~QuietPcl() { pcl::console::setVerbosityLevel(level_); }
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;

 private:
  pcl::console::VERBOSITY_LEVEL level_;
};

/// Up to kSample of the pool, drawn without putting back (Fisher and Yates), about their centroid.
pcl::PointCloud<pcl::PointXYZ>::Ptr draw_sample(const PointCloud& cloud,
                                                Indices pool,
                                                Random& random,
                                                Eigen::Vector3f& centre) {
  const std::size_t count = std::min(kSample, pool.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(pool[i], pool[i + random.below(pool.size() - i)]);
    sum += cloud.points[pool[i]].cast<double>();
  }
  centre = (sum / static_cast<double>(count)).cast<float>();
  PointCloud sample;
  for (std::size_t i = 0; i < count; ++i) sample.points.push_back(cloud.points[pool[i]] - centre);
  return to_pcl(sample);
}

/// Samples are drawn within this of each other: three points of one surface, not of three.
double sampling_radius(const pcl::PointCloud<pcl::PointXYZ>& sample, double inlier_distance) {
  double squares = 0;
  for (const auto& p : sample) squares += p.getVector3fMap().squaredNorm();
  const double spread = std::sqrt(squares / static_cast<double>(sample.size()));
  return std::max(0.3 * spread, 10 * inlier_distance);
}

std::optional<Plane> ransac_plane(const PointCloud& cloud,
                                  const Indices& pool,
                                  const PlaneExtractionOptions& options,
                                  Random& random) {
  Eigen::Vector3f centre;
  const auto sample = draw_sample(cloud, pool, random, centre);
  using Model = pcl::SampleConsensusModelPlane<pcl::PointXYZ>;
  const Model::Ptr model(new Model(sample));
  const pcl::search::KdTree<pcl::PointXYZ>::Ptr search(new pcl::search::KdTree<pcl::PointXYZ>);
  search->setInputCloud(sample);
  model->setSamplesMaxDist(sampling_radius(*sample, options.inlier_distance), search);
  pcl::RandomSampleConsensus<pcl::PointXYZ> ransac(model, options.inlier_distance);
  ransac.setMaxIterations(options.iterations);
  ransac.setProbability(0.9999);
  if (!ransac.computeModel()) return {};
  Eigen::VectorXf c;
  ransac.getModelCoefficients(c);
  const double length = c.head<3>().cast<double>().norm();
  if (c.size() != 4 || !(length > 0)) return {};
  const Eigen::Vector3d normal = c.head<3>().cast<double>() / length;
  return Plane{normal, normal.dot(centre.cast<double>()) - double(c(3)) / length};
}

/// Points of the pool within `reach` of the plane whose normals agree with it.
Indices points_near(const PointCloud& cloud,
                    const Indices& pool,
                    const Plane& plane,
                    double reach,
                    double max_normal_angle) {
  const double min_cosine = std::cos(max_normal_angle);
  Indices near;
  for (const std::size_t i : pool) {
    if (std::abs(plane.signed_distance(cloud.points[i].cast<double>())) > reach) continue;
    if (!cloud.normals.empty()) {
      const Eigen::Vector3d n = cloud.normals[i].cast<double>();
      if (std::abs(n.dot(plane.normal)) < min_cosine) continue;
    }
    near.push_back(i);
  }
  return near;
}

/// Gathers, keeps the largest piece and fits in turn until the plane takes in no more points.
std::optional<ExtractedPlane> refine(const PointCloud& cloud,
                                     const Indices& pool,
                                     Plane plane,
                                     const PlaneExtractionOptions& options) {
  std::optional<ExtractedPlane> best;
  for (int round = 0; round < kRefinements; ++round) {
    const Indices near =
        points_near(cloud, pool, plane, options.inlier_distance, options.max_normal_angle);
    if (near.size() < 3) return best;
    const double cell = connecting_cell(cloud, near, 2 * options.inlier_distance);
    Indices piece = largest_piece(cloud, near, plane, cell);
    if (piece.size() < 3 || (best && piece.size() <= best->indices.size())) return best;
    PlaneFit fit;
    try {
      fit = fit_plane(selected(cloud, piece));
    } catch (const Error&) {
      return best;  // a piece on one line
    }
    plane = fit.plane;
    best = ExtractedPlane{fit, std::move(piece)};
  }
  return best;
}

void remove_from(Indices& pool, const Indices& gone) {
  Indices kept;
  kept.reserve(pool.size());
  std::set_difference(
      pool.begin(), pool.end(), gone.begin(), gone.end(), std::back_inserter(kept));
  pool = std::move(kept);
}

/// Takes the plane's noisy fringe out of the pool as well, or it would be found as thin ghosts.
void remove_plane(const PointCloud& cloud,
                  Indices& pool,
                  const ExtractedPlane& plane,
                  const PlaneExtractionOptions& options) {
  remove_from(pool, plane.indices);
  Indices fringe = points_near(
      cloud, pool, plane.fit.plane, 2 * options.inlier_distance, options.max_normal_angle);
  const double reach = plane.fit.extent / 2;
  std::erase_if(fringe, [&](std::size_t i) {
    return (cloud.points[i].cast<double>() - plane.fit.centroid).norm() > reach;
  });
  remove_from(pool, fringe);
}

}  // namespace

void PlaneExtractionOptions::check() const {
  require(inlier_distance > 0 && std::isfinite(inlier_distance),
          "inlier_distance is ",
          inlier_distance,
          " m; give a length above 0");
  require(min_points >= 3, "min_points is ", min_points, "; a plane needs at least 3");
  require(max_planes >= 1, "max_planes is ", max_planes, "; give at least 1");
  require(iterations >= 1, "iterations is ", iterations, "; give at least 1");
  require(max_normal_angle > 0 && max_normal_angle <= std::numbers::pi / 2,
          "max_normal_angle is ",
          max_normal_angle,
          " rad; give an angle above 0, at most pi/2");
}

std::vector<ExtractedPlane> extract_planes(const PointCloud& cloud,
                                           const PlaneExtractionOptions& options) {
  options.check();
  cloud.check();
  const QuietPcl quiet;
  Indices pool;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].allFinite()) pool.push_back(i);
  }
  Random random(options.seed);
  std::vector<ExtractedPlane> planes;
  int failures = 0;
  while (planes.size() < static_cast<std::size_t>(options.max_planes) && failures < kFailures &&
         pool.size() >= options.min_points) {
    const auto candidate = ransac_plane(cloud, pool, options, random);
    auto plane = candidate ? refine(cloud, pool, *candidate, options) : std::nullopt;
    if (!plane) {
      ++failures;
    } else if (plane->indices.size() < options.min_points) {
      ++failures;
      remove_from(pool, plane->indices);
    } else {
      remove_plane(cloud, pool, *plane, options);
      planes.push_back(std::move(*plane));
    }
  }
  std::stable_sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) {
    return a.indices.size() > b.indices.size();
  });
  return planes;
}

}  // namespace facula
