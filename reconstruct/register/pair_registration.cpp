// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/reconstruct/register/pair_registration.hpp>
#include <facula/reconstruct/register/pair_system.hpp>
#include <facula/reconstruct/register/point_pairs.hpp>
#include <facula/reconstruct/register/pose_certainty.hpp>
#include <facula/reconstruct/register/undecided_directions.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

namespace facula {
namespace {

constexpr std::size_t kMinPairs = 12;
constexpr double kCellVoxels = 10;       // twice as far as neighbourhoods of normals reach [voxels]
constexpr double kSettledVoxels = 0.05;  // a level is done when points move less [voxels]

struct Step {
  Vector6 twist;      ///< about the pivot [m, rad]
  double motion = 0;  ///< of the overlap's points [m]
  double sigmas = 0;  ///< in standard deviations of the pose [1]
};

/// Gauss-Newton step within the motions that the shape decides (Zhang, Kaess and Singh 2016).
Step decided_step(const PairSystem& system) {
  Vector6 unit;
  unit << 1, 1, 1, Eigen::Vector3d::Constant(1 / system.radius);
  const Eigen::Matrix<double, 6, Eigen::Dynamic> basis =
      unit.asDiagonal() * decided_motions(system).decided;
  Step step;
  step.twist.setZero();
  if (basis.cols() == 0) return step;
  const Eigen::MatrixXd h = basis.transpose() * system.hessian * basis;
  const Eigen::VectorXd y = -h.ldlt().solve(basis.transpose() * system.gradient);
  step.twist = basis * y;
  step.motion = step.twist.head<3>().norm() + system.radius * step.twist.tail<3>().norm();
  step.sigmas = std::sqrt(std::max(0.0, y.dot(h * y))) / system.scale;
  return step;
}

double median_distance(const std::vector<PointPair>& pairs) {
  std::vector<double> distances;
  distances.reserve(pairs.size());
  for (const PointPair& pair : pairs) distances.push_back(pair.distance);
  return median(distances);
}

/// What changes from iteration to iteration.
class Alignment {
 public:
  Alignment(const ScanPyramid& source,
            const ScanPyramid& target,
            const RigidTransform& guess,
            const PairOptions& options)
      : source_(source), target_(target), options_(options), finest_(finder_of(0)) {
    result_.target_from_source = guess;
    last_level_ = std::max(source.levels.size(), target.levels.size()) - 1;
    const std::size_t coarsest =
        std::min(last_level_, static_cast<std::size_t>(options.coarsest_level));
    bound_ = options.max_distance > 0 ? options.max_distance : 4 * voxel(coarsest);
    for (std::size_t level = coarsest; level > 0; --level) {
      PairFinder finder = finder_of(level);
      settle(level, finder);
    }
    settle(0, finest_);
  }

  PairResult finished() {
    const std::vector<PointPair> pairs = finest_.find(result_.target_from_source, bound_);
    require_overlap(pairs);
    const PairSystem system = assemble(pairs, options_);
    describe_fit(pairs);
    describe_certainty(pairs, system);
    return result_;
  }

 private:
  const PyramidLevel& source_level(std::size_t level) const {
    return source_.levels[std::min(level, source_.levels.size() - 1)];
  }
  const PyramidLevel& target_level(std::size_t level) const {
    return target_.levels[std::min(level, target_.levels.size() - 1)];
  }
  double voxel(std::size_t level) const {
    return std::max(source_level(level).voxel, target_level(level).voxel);
  }
  double tightest(std::size_t level) const {
    if (level == 0 && options_.min_distance > 0) return options_.min_distance;
    return 2 * voxel(level);
  }

  PairFinder finder_of(std::size_t level) const {
    return {
        source_level(level), target_level(level), source_.oriented && target_.oriented, options_};
  }

  /// Iterates on one level until the pose no longer changes much for it.
  void settle(std::size_t level, PairFinder& finder) {
    bool settled = false;
    while (!settled && result_.iterations < options_.max_iterations) {
      const std::vector<PointPair> pairs = finder.find(result_.target_from_source, bound_);
      if (level > 0 && pairs.size() < kMinPairs) return;
      require_overlap(pairs);
      const PairSystem system = assemble(pairs, options_);
      const Step step = decided_step(system);
      result_.target_from_source =
          turn_about(system.pivot, step.twist) * result_.target_from_source;
      ++result_.iterations;
      const bool still = is_still(step, level);
      const double least = std::min(tightest(level), bound_);
      settled = still && bound_ <= least;
      bound_ = std::clamp(still ? bound_ / 2 : 3 * median_distance(pairs), least, bound_);
    }
    if (level == 0) result_.converged = settled;
  }

  bool is_still(const Step& step, std::size_t level) const {
    if (level > 0) return step.motion < kSettledVoxels * voxel(level);
    return step.sigmas < options_.significance ||
           (step.twist.head<3>().norm() < options_.translation_epsilon &&
            step.twist.tail<3>().norm() < options_.rotation_epsilon);
  }

  void require_overlap(const std::vector<PointPair>& pairs) const {
    require(pairs.size() >= kMinPairs,
            "only ",
            pairs.size(),
            " of ",
            source_level(0).cloud.size(),
            " points of scan '",
            source_.name,
            "' have a point of scan '",
            target_.name,
            "' within ",
            bound_,
            " m whose normal agrees; start nearer to the truth or raise max_distance");
  }

  void describe_fit(const std::vector<PointPair>& pairs) {
    double squares = 0;
    for (const PointPair& pair : pairs) squares += pair.plane_distance * pair.plane_distance;
    const double n = static_cast<double>(pairs.size());
    result_.inliers = pairs.size();
    result_.overlap = n / static_cast<double>(source_level(0).cloud.size());
    result_.inlier_rms = std::sqrt(squares / n);
  }

  void describe_certainty(const std::vector<PointPair>& pairs, const PairSystem& system) {
    const PoseCertainty certainty = pose_certainty(pairs, system, options_, kCellVoxels * voxel(0));
    result_.covariance = certainty.covariance;
    result_.information = certainty.information;
    result_.undecided = certainty.undecided;
  }

  const ScanPyramid& source_;
  const ScanPyramid& target_;
  const PairOptions& options_;
  PairFinder finest_;
  PairResult result_;
  std::size_t last_level_ = 0;
  double bound_ = 0;  // farthest correspondence [m]
};

}  // namespace

void PairOptions::check() const {
  const auto positive = [](double value, const char* name, const char* unit) {
    require(value > 0 && std::isfinite(value), name, " is ", value, unit, "; give a value above 0");
  };
  const auto not_negative = [](double value, const char* name) {
    require(value >= 0 && std::isfinite(value), name, " is ", value, "; give 0 or more");
  };
  not_negative(max_distance, "max_distance");
  not_negative(min_distance, "min_distance");
  not_negative(significance, "significance");
  positive(rotation_epsilon, "rotation_epsilon", " rad");
  positive(translation_epsilon, "translation_epsilon", " m");
  positive(max_normal_angle, "max_normal_angle", " rad");
  require(max_iterations >= 1, "max_iterations is ", max_iterations, "; give at least 1");
  require(coarsest_level >= 0, "coarsest_level is ", coarsest_level, "; give 0 or more");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

PairResult register_pair(const ScanPyramid& source,
                         const ScanPyramid& target,
                         const RigidTransform& target_from_source_guess,
                         const PairOptions& options) {
  options.check();
  require(!source.levels.empty(), "the source pyramid has no levels; call build_pyramid() first");
  require(!target.levels.empty(), "the target pyramid has no levels; call build_pyramid() first");
  require(target_from_source_guess.translation.allFinite() &&
              target_from_source_guess.rotation.coeffs().allFinite(),
          "the guess of the pose is not finite; give a rotation and a translation");
  return Alignment(source, target, target_from_source_guess, options).finished();
}

}  // namespace facula
