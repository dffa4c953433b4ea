// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/register/icp.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace facula {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kMinCorrespondences = 12;

/// A source point and the tangent plane of the target point nearest to it.
struct Correspondence {
  std::size_t target = 0;  ///< index of the target point [1]
  double distance = 0;     ///< between the two points [m]
  double residual = 0;     ///< point to plane [m]
  Vector6 jacobian;        ///< of the residual by a twist about the pivot [1, m]
};

/// The target cloud made ready for many searches.
struct Target {
  const PointCloud& cloud;
  NearestNeighbours tree;
  Eigen::Vector3d pivot;  ///< twists turn about the target's centroid, which decouples H [m]
};

Eigen::Vector3d centroid_of(const std::vector<Eigen::Vector3f>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite()) continue;
    sum += p.cast<double>();
    ++count;
  }
  require(count > 0, "the target cloud has no finite point; registration needs a surface");
  return sum / static_cast<double>(count);
}

/// Normals of known side may face each other; others are compared as lines.
class NormalGate {
 public:
  NormalGate(const PointCloud& source, const PointCloud& target, double max_angle)
      : used_(!source.normals.empty()),
        sided_(!source.sensor_origin.empty() && !target.sensor_origin.empty()),
        min_cosine_(std::cos(max_angle)) {}

  bool lets_pass(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    const double cosine = a.dot(b);
    return (sided_ ? cosine : std::abs(cosine)) >= min_cosine_;
  }
  bool used() const { return used_; }

 private:
  bool used_;
  bool sided_;
  double min_cosine_;
};

class Matcher {
 public:
  Matcher(const PointCloud& source, const Target& target, const IcpOptions& options)
      : source_(source),
        target_(target),
        gate_(source, target.cloud, options.max_normal_angle),
        num_threads_(options.num_threads) {}

  /// One correspondence for every source point that has a target point within `max_distance`.
  std::vector<Correspondence> match(const RigidTransform& pose, double max_distance) const {
    std::vector<std::optional<Correspondence>> found(source_.size());
    const auto body = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found[i] = match_point(pose, i, max_distance);
    };
    parallel_for(source_.size(), body, {.num_threads = num_threads_, .chunk = 512});
    std::vector<Correspondence> pairs;
    for (const auto& pair : found) {
      if (pair) pairs.push_back(*pair);
    }
    return pairs;
  }

 private:
  std::optional<Correspondence> match_point(const RigidTransform& pose,
                                            std::size_t i,
                                            double max_distance) const {
    if (!source_.points[i].allFinite()) return {};
    const Eigen::Vector3d x = pose * source_.points[i].cast<double>();
    const auto nearest = target_.tree.nearest(x.cast<float>());
    const double distance = std::sqrt(static_cast<double>(nearest.squared_distance));
    if (distance > max_distance) return {};
    const Eigen::Vector3d normal = target_.cloud.normals[nearest.index].cast<double>();
    if (!(normal.squaredNorm() > 0.5)) return {};  // a point whose plane is not known
    if (gate_.used() &&
        !gate_.lets_pass(pose.rotation * source_.normals[i].cast<double>(), normal)) {
      return {};
    }
    const Eigen::Vector3d q = target_.cloud.points[nearest.index].cast<double>();
    Correspondence pair{nearest.index, distance, normal.dot(x - q), Vector6::Zero()};
    pair.jacobian << normal, (x - target_.pivot).cross(normal);
    return pair;
  }

  const PointCloud& source_;
  const Target& target_;
  NormalGate gate_;
  int num_threads_;
};

/// Geman and McClure's scale: three standard deviations of the residuals, by their median.
double robust_scale(const std::vector<Correspondence>& pairs) {
  std::vector<double> sizes;
  sizes.reserve(pairs.size());
  for (const Correspondence& pair : pairs) sizes.push_back(std::abs(pair.residual));
  return std::max(3 * 1.4826 * median(sizes), 1e-9);
}

double median_distance(const std::vector<Correspondence>& pairs) {
  std::vector<double> distances;
  distances.reserve(pairs.size());
  for (const Correspondence& pair : pairs) distances.push_back(pair.distance);
  return median(distances);
}

/// Throws unless all six directions are held by the pairs.
void require_decided(const Matrix6& h, std::size_t pairs) {
  // Rotations are scaled to the cloud's size, so that all entries are pure numbers.
  const double size = std::sqrt(h.diagonal().tail<3>().sum() / h.diagonal().head<3>().sum());
  Vector6 scale;
  scale << 1, 1, 1, 1 / size, 1 / size, 1 / size;
  const Matrix6 scaled = scale.asDiagonal() * h * scale.asDiagonal();
  const double least = Eigen::SelfAdjointEigenSolver<Matrix6>(scaled).eigenvalues()(0);
  require(least > 1e-7 * static_cast<double>(pairs),
          "the surfaces where the two clouds overlap (",
          pairs,
          " points) leave at least one direction of the pose undecided, as one plane alone does; "
          "register scans that share surfaces of three directions");
}

struct Step {
  Vector6 twist;      ///< about the pivot
  double sigmas = 0;  ///< its length in standard deviations of the pose [1]
};

/// Gauss-Newton step with Geman-McClure weights.
Step robust_step(const std::vector<Correspondence>& pairs) {
  const double scale = robust_scale(pairs);
  const double s2 = scale * scale;
  Matrix6 h = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
  Matrix6 unweighted = Matrix6::Zero();
  for (const Correspondence& pair : pairs) {
    const double w = std::pow(s2 / (s2 + pair.residual * pair.residual), 2);
    h += w * pair.jacobian * pair.jacobian.transpose();
    g += w * pair.residual * pair.jacobian;
    unweighted += pair.jacobian * pair.jacobian.transpose();
  }
  require_decided(unweighted, pairs.size());
  const Vector6 twist = -h.ldlt().solve(g);
  return {twist, std::sqrt(twist.dot(h * twist)) / (scale / 3)};
}

bool is_still(const Step& step, const IcpOptions& options) {
  return step.sigmas < options.significance ||
         (step.twist.head<3>().norm() < options.translation_epsilon &&
          step.twist.tail<3>().norm() < options.rotation_epsilon);
}

/// A twist about `pivot` as a transform of the target frame.
RigidTransform turn_about(const Eigen::Vector3d& pivot, const Vector6& twist) {
  const RigidTransform from_pivot{Eigen::Quaterniond::Identity(), pivot};
  return from_pivot * exp_se3(twist) * from_pivot.inverse();
}

/// Covariance of the twist about the pivot by the sandwich formula of M-estimators (Huber 1964;
/// clusters after Liang and Zeger 1986): pairs that share a target point share its error.
Matrix6 sandwich_covariance(const std::vector<Correspondence>& pairs) {
  const double s2 = std::pow(robust_scale(pairs), 2);
  Matrix6 h = Matrix6::Zero();
  double slope = 0;
  std::map<std::size_t, Vector6> scores;
  for (const Correspondence& pair : pairs) {
    const double r2 = pair.residual * pair.residual;
    const double psi = pair.residual * std::pow(s2 / (s2 + r2), 2);
    slope += s2 * s2 * (s2 - 3 * r2) / std::pow(s2 + r2, 3);
    h += pair.jacobian * pair.jacobian.transpose();
    scores.try_emplace(pair.target, Vector6::Zero()).first->second += psi * pair.jacobian;
  }
  Matrix6 spread = Matrix6::Zero();
  for (const auto& [target, score] : scores) spread += score * score.transpose();
  const double n = static_cast<double>(pairs.size());
  const double clusters = static_cast<double>(scores.size());
  slope = std::max(slope / n, 0.1);  // below, more than half of the pairs are outliers
  const Matrix6 inverse = h.ldlt().solve(Matrix6::Identity());
  const double freedom = clusters > 6 ? clusters / (clusters - 6) : 1;
  return freedom / (slope * slope) * inverse * spread * inverse;
}

/// The covariance of a twist about `pivot` as that of a twist about the origin.
Matrix6 about_origin(const Matrix6& covariance, const Eigen::Vector3d& pivot) {
  Eigen::Matrix3d cross;
  cross << 0, -pivot.z(), pivot.y(), pivot.z(), 0, -pivot.x(), -pivot.y(), pivot.x(), 0;
  Matrix6 adjoint = Matrix6::Identity();
  adjoint.topRightCorner<3, 3>() = cross;
  const Matrix6 moved = adjoint * covariance * adjoint.transpose();
  return (moved + moved.transpose()) / 2;
}

void require_overlap(const std::vector<Correspondence>& pairs,
                     std::size_t source_points,
                     double max_distance) {
  require(pairs.size() >= kMinCorrespondences,
          "only ",
          pairs.size(),
          " of ",
          source_points,
          " source points have a target point within ",
          max_distance,
          " m whose normal agrees; start nearer to the truth or raise max_distance");
}

void describe_fit(const std::vector<Correspondence>& pairs,
                  std::size_t source_points,
                  IcpResult& result) {
  double squares = 0;
  for (const Correspondence& pair : pairs) squares += pair.residual * pair.residual;
  result.inliers = pairs.size();
  result.overlap = static_cast<double>(pairs.size()) / static_cast<double>(source_points);
  result.rms = std::sqrt(squares / static_cast<double>(pairs.size()));
}

}  // namespace

void IcpOptions::check() const {
  const auto positive = [](double value, const char* name, const char* unit) {
    require(value > 0 && std::isfinite(value), name, " is ", value, unit, "; give a value above 0");
  };
  positive(max_distance, "max_distance", " m");
  positive(min_max_distance, "min_max_distance", " m");
  positive(rotation_epsilon, "rotation_epsilon", " rad");
  positive(translation_epsilon, "translation_epsilon", " m");
  positive(max_normal_angle, "max_normal_angle", " rad");
  require(significance >= 0, "significance is ", significance, "; give 0 or more");
  require(max_iterations >= 1, "max_iterations is ", max_iterations, "; give at least 1");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

IcpResult register_icp(const PointCloud& source,
                       const PointCloud& target_cloud,
                       const RigidTransform& target_from_source_guess,
                       const IcpOptions& options) {
  options.check();
  source.check();
  target_cloud.check();
  require(!source.empty(), "the source cloud is empty; registration needs two clouds");
  require(!target_cloud.empty(), "the target cloud is empty; registration needs two clouds");
  require(!target_cloud.normals.empty(),
          "the target cloud has no normals; call estimate_normals() first");

  const Target target{
      target_cloud, NearestNeighbours(target_cloud.points), centroid_of(target_cloud.points)};
  const Matcher matcher(source, target, options);
  IcpResult result;
  result.target_from_source = target_from_source_guess;
  const double tightest = std::min(options.min_max_distance, options.max_distance);
  double bound = options.max_distance;
  while (!result.converged && result.iterations < options.max_iterations) {
    const auto pairs = matcher.match(result.target_from_source, bound);
    require_overlap(pairs, source.size(), bound);
    const Step step = robust_step(pairs);
    result.target_from_source = turn_about(target.pivot, step.twist) * result.target_from_source;
    ++result.iterations;
    const bool still = is_still(step, options);
    result.converged = still && bound <= tightest;
    const double wanted = still ? bound / 2 : 3 * median_distance(pairs);
    bound = std::clamp(wanted, tightest, bound);
  }
  const auto pairs = matcher.match(result.target_from_source, bound);
  require_overlap(pairs, source.size(), bound);
  describe_fit(pairs, source.size(), result);
  result.covariance = about_origin(sandwich_covariance(pairs), target.pivot);
  return result;
}

}  // namespace facula
