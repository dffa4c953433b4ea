// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/flatness_uncertainty.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace facula {
namespace {

constexpr double kLeastCosine = 0.087;  // as plane fits: no ray is more grazing than 85 degrees

/// A point as the trials see it.
struct Site {
  Eigen::Vector3d row;   // (1, u, v) on the reference plane
  double deviation = 0;  // [m]
  double sigma = 0;      // along the normal [m]
};

double sigma_along_normal(const PointCloud& cloud, std::size_t i, const Eigen::Vector3d& normal) {
  if (cloud.sensor_origin.empty()) return cloud.sigma[i];
  const Eigen::Vector3d ray =
      (cloud.points[i] - cloud.sensor_origin[i]).cast<double>().normalized();
  return cloud.sigma[i] * std::max(kLeastCosine, std::abs(ray.dot(normal)));
}

std::vector<Site> sites_of(const PointCloud& cloud,
                           const std::vector<std::size_t>& indices,
                           const Flatness& flatness,
                           double other_sigma) {
  const Eigen::Vector3d& normal = flatness.reference.normal;
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  std::vector<Site> sites;
  sites.reserve(indices.size());
  for (const std::size_t i : indices) {
    if (!cloud.points[i].allFinite()) continue;
    const Eigen::Vector3d d = cloud.points[i].cast<double>() - flatness.centroid;
    const bool own = !cloud.sigma.empty() && is_known_sigma(cloud.sigma[i]);
    require(own || other_sigma > 0,
            "expected the noise of every point, got none for number ",
            i,
            "; give a sigma above 0 for points without their own");
    sites.push_back({{1, d.dot(u), d.dot(v)},
                     d.dot(normal),
                     own ? sigma_along_normal(cloud, i, normal) : other_sigma});
  }
  require(sites.size() >= 3, "flatness needs at least 3 points, the cloud has ", sites.size());
  return sites;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double length() const { return high - low; }
};

/// FLTt of the surface with noise once more, and of the noise alone.
struct Trial {
  double total = 0;
  double floor = 0;
};

Trial run_trial(const std::vector<Site>& sites, const Eigen::Matrix3d& inverse, Random random) {
  std::vector<double> noise(sites.size());
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < sites.size(); ++i) {
    noise[i] = sites[i].sigma * random.normal();
    right += noise[i] * sites[i].row;
  }
  const Eigen::Vector3d shift = inverse * right;  // how the reference plane follows the noise
  Range total;
  Range floor;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const double moved = noise[i] - shift.dot(sites[i].row);
    total.add(sites[i].deviation + moved);
    floor.add(moved);
  }
  return {total.length(), floor.length()};
}

FlatnessUncertainty summary_of(const std::vector<Trial>& trials, double measured) {
  FlatnessUncertainty result;
  const double n = static_cast<double>(trials.size());
  double mean = 0;
  std::vector<double> floors;
  for (const Trial& trial : trials) {
    mean += trial.total / n;
    result.floor_mean += trial.floor / n;
    floors.push_back(trial.floor);
  }
  for (const Trial& trial : trials) result.total_sigma += std::pow(trial.total - mean, 2) / (n - 1);
  result.total_sigma = std::sqrt(result.total_sigma);
  result.total_growth = mean - measured;
  std::sort(floors.begin(), floors.end());
  result.floor_p95 = floors[static_cast<std::size_t>(std::lround(0.95 * (n - 1)))];
  return result;
}

}  // namespace

void FlatnessUncertaintyOptions::check() const {
  require(
      sigma >= 0 && std::isfinite(sigma), "expected a sigma of 0 mm or more, got ", 1000 * sigma);
  require(trials >= 20 && trials <= 100000, "expected 20 to 100000 trials, got ", trials);
}

FlatnessUncertainty flatness_uncertainty(const PointCloud& cloud,
                                         const std::vector<std::size_t>& indices,
                                         const Flatness& flatness,
                                         const FlatnessUncertaintyOptions& options) {
  options.check();
  const std::vector<Site> sites = sites_of(cloud, indices, flatness, options.sigma);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double squares = 0;
  for (const Site& site : sites) {
    information += site.row * site.row.transpose();
    squares += site.sigma * site.sigma;
  }
  const Eigen::Matrix3d inverse = information.inverse();
  std::vector<Trial> trials(static_cast<std::size_t>(options.trials));
  parallel_for(trials.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t t = begin; t < end; ++t) {
                   trials[t] = run_trial(sites, inverse, Random(options.seed, t));
                 }
               },
               {.num_threads = options.num_threads, .chunk = 1});
  FlatnessUncertainty result = summary_of(trials, flatness.total);
  result.sigma_points = std::sqrt(squares / static_cast<double>(sites.size()));
  return result;
}

}  // namespace facula
