// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/tilt_zero.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr int kRounds = 12;
constexpr double kSettled = 1e-4;      // step of the zero that ends the search [rad]
constexpr double kNudge = 0.005;       // for the change of the angles with the zero [rad]
constexpr std::size_t kLargest = 4;    // planes over which points are counted [1]
constexpr double kLeastEffect = 0.02;  // of the zero on the angles [rad/rad]

/// A pair of planes that should be square or parallel.
struct Pair {
  std::size_t a = 0;
  std::size_t b = 0;
  bool square = true;
  double weight = 1;  ///< points of the smaller plane [1]
};

PointCloud cloud_at(const PanTiltList& list, double zero) {
  return posed_cloud(list, zero).cloud;
}

std::vector<ExtractedPlane> planes_at(const PanTiltList& list,
                                      double zero,
                                      const TiltZeroOptions& options) {
  PointCloud cloud = cloud_at(list, zero);
  estimate_normals(cloud, {.num_threads = options.planes.num_threads});
  std::vector<ExtractedPlane> planes = extract_planes(cloud, options.planes);
  const double least = options.min_share * static_cast<double>(list.size());
  std::erase_if(planes, [least](const ExtractedPlane& plane) {
    return static_cast<double>(plane.indices.size()) < least;
  });
  return planes;
}

double share_on(const std::vector<ExtractedPlane>& planes, std::size_t points) {
  double count = 0;
  for (std::size_t i = 0; i < std::min(kLargest, planes.size()); ++i) {
    count += static_cast<double>(planes[i].indices.size());
  }
  return count / static_cast<double>(points);
}

std::vector<Pair> pairs_of(const std::vector<ExtractedPlane>& planes, double max_off) {
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < planes.size(); ++a) {
    for (std::size_t b = a + 1; b < planes.size(); ++b) {
      const double angle = angle_between(planes[a].fit.plane, planes[b].fit.plane);
      const bool square = std::numbers::pi / 2 - angle < max_off;
      if (!square && angle > max_off) continue;
      pairs.push_back({a, b, square, static_cast<double>(planes[b].indices.size())});
    }
  }
  return pairs;
}

/// Sine of what each pair is off, three numbers a pair: one for square, a vector for parallel.
std::vector<Eigen::Vector3d> misfits(const std::vector<Plane>& planes,
                                     const std::vector<Pair>& pairs) {
  std::vector<Eigen::Vector3d> result;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d& n = planes[pair.a].normal;
    const Eigen::Vector3d& m = planes[pair.b].normal;
    if (pair.square) {
      result.emplace_back(n.dot(m), 0, 0);
    } else {
      result.emplace_back(n.cross(m));
    }
  }
  return result;
}

/// The same planes' points, fitted again at another zero.
std::vector<Plane> fitted_at(const PanTiltList& list,
                             double zero,
                             const std::vector<ExtractedPlane>& planes) {
  const PointCloud cloud = cloud_at(list, zero);
  std::vector<Plane> fitted;
  for (const ExtractedPlane& plane : planes) {
    fitted.push_back(fit_plane(cloud, plane.indices).plane);
    // A normal that turned over with its distance would change its sign.
    if (fitted.back().normal.dot(plane.fit.plane.normal) < 0) {
      fitted.back() = {-fitted.back().normal, -fitted.back().distance};
    }
  }
  return fitted;
}

/// A step of least squares over the pairs.
struct Step {
  double change = 0;   ///< [rad]
  double effect = 0;   ///< weighted squares of the change per change of the zero
  double squares = 0;  ///< weighted squares of the misfits
  double weight = 0;
  std::size_t pairs = 0;
  double off() const { return weight > 0 ? std::sqrt(squares / weight) : 0; }
};

Step step_at(const PanTiltList& list,
             double zero,
             const std::vector<ExtractedPlane>& planes,
             const TiltZeroOptions& options) {
  const std::vector<Pair> pairs = pairs_of(planes, options.max_off_square);
  const auto now = misfits(fitted_at(list, zero, planes), pairs);
  const auto less = misfits(fitted_at(list, zero - kNudge, planes), pairs);
  const auto more = misfits(fitted_at(list, zero + kNudge, planes), pairs);
  Step step;
  double pull = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3d slope = (more[i] - less[i]) / (2 * kNudge);
    pull += pairs[i].weight * slope.dot(now[i]);
    step.effect += pairs[i].weight * slope.squaredNorm();
    step.squares += pairs[i].weight * now[i].squaredNorm();
    step.weight += pairs[i].weight;
  }
  step.pairs = pairs.size();
  if (step.effect > 0) step.change = std::clamp(-pull / step.effect, -0.1, 0.1);
  return step;
}

void require_effect(const Step& step) {
  require(step.pairs > 0,
          "expected planes that could be square or parallel, found none; scan a room with walls, "
          "or raise the inlier distance");
  require(std::sqrt(step.effect / step.weight) > kLeastEffect,
          "the angles of the planes found do not depend on the tilt's zero; scan a floor or a "
          "ceiling beside the walls");
}

double best_start(const PanTiltList& list, const TiltZeroOptions& options) {
  double best = 0;
  double most = share_on(planes_at(list, 0, options), list.size());
  for (double size = options.step; size <= options.largest; size += options.step) {
    for (const double zero : {-size, size}) {
      const double share = share_on(planes_at(list, zero, options), list.size());
      if (share <= most) continue;
      most = share;
      best = zero;
    }
  }
  return best;
}

}  // namespace

void TiltZeroOptions::check() const {
  require(largest > 0 && largest <= std::numbers::pi / 4,
          "largest is ",
          largest,
          " rad; give an angle above 0, at most pi/4");
  require(step > 0 && step <= largest,
          "step is ",
          step,
          " rad; give an angle above 0, at most largest");
  require(min_share >= 0 && min_share < 1, "min_share is ", min_share, "; give 0 to 1");
  require(max_off_square > 0 && max_off_square < std::numbers::pi / 4,
          "max_off_square is ",
          max_off_square,
          " rad; give an angle above 0, below pi/4");
  planes.check();
}

TiltZero find_tilt_zero(const PanTiltList& list, const TiltZeroOptions& options) {
  options.check();
  double zero = best_start(list, options);
  for (int round = 0; round < kRounds; ++round) {
    const Step step = step_at(list, zero, planes_at(list, zero, options), options);
    require_effect(step);
    // Half steps once it should have settled: planes that lose and win points may swing.
    const double change = round < kRounds / 2 ? step.change : step.change / 2;
    zero = std::clamp(zero + change, -options.largest, options.largest);
    if (std::abs(change) < kSettled) break;
  }
  const auto planes = planes_at(list, zero, options);
  const Step end = step_at(list, zero, planes, options);
  require_effect(end);
  const auto before = planes_at(list, 0, options);
  TiltZero result;
  result.tilt_zero = {zero, std::numeric_limits<double>::quiet_NaN()};
  if (end.pairs > 1) {
    const double freedom = static_cast<double>(end.pairs) - 1;
    result.tilt_zero.sigma = std::sqrt(end.squares / freedom / end.effect);
  }
  result.pairs = end.pairs;
  result.off_square_before = step_at(list, 0, before, options).off();
  result.off_square = end.off();
  result.on_planes_before = share_on(before, list.size());
  result.on_planes = share_on(planes, list.size());
  return result;
}

}  // namespace facula
