// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/reconstruct/measure/bounding_rectangle.hpp>
#include <facula/reconstruct/measure/pose_errors.hpp>
#include <facula/reconstruct/measure/unexplained_variance.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

namespace facula {
namespace {

constexpr int kWeightingRounds = 4;     // what projects and adds to the sigmas settles at once
constexpr double kLeastCosine = 0.087;  // along grazing rays the beam's width counts: 85 degrees

/// The points of a fit as it wants them: doubles, with the direction and noise of their rays.
struct Samples {
  std::vector<Eigen::Vector3d> x;    ///< [m]
  std::vector<Eigen::Vector3d> ray;  ///< from the sensor, unit length
  std::vector<double> sigma;         ///< along the ray [m]; empty where there is none
  std::vector<std::size_t> index;    ///< in the cloud
  double mean_range = 0;             ///< [m]

  double sigma_along(const Eigen::Vector3d& normal, std::size_t i) const {
    return sigma[i] * std::max(kLeastCosine, std::abs(ray[i].dot(normal)));
  }
};

Samples samples_of(const PointCloud& cloud, const std::vector<std::size_t>& indices) {
  Samples samples;
  samples.x.reserve(indices.size());
  samples.ray.reserve(indices.size());
  samples.index.reserve(indices.size());
  bool has_sigma = !cloud.sigma.empty();
  for (const std::size_t i : indices) {
    if (!cloud.points[i].allFinite()) continue;
    const Eigen::Vector3d x = cloud.points[i].cast<double>();
    const Eigen::Vector3d eye = cloud.sensor_origin.empty()
                                    ? Eigen::Vector3d::Zero()
                                    : Eigen::Vector3d(cloud.sensor_origin[i].cast<double>());
    const double range = (x - eye).norm();
    samples.x.push_back(x);
    samples.index.push_back(i);
    samples.ray.emplace_back(range > 0 ? Eigen::Vector3d((x - eye) / range)
                                       : Eigen::Vector3d::Zero());
    samples.mean_range += range;
    has_sigma = has_sigma && is_known_sigma(cloud.sigma[i]);
    if (has_sigma) samples.sigma.push_back(cloud.sigma[i]);
  }
  if (!has_sigma) samples.sigma.clear();
  require(
      samples.x.size() >= 3, "a plane needs at least 3 points, the cloud has ", samples.x.size());
  samples.mean_range /= static_cast<double>(samples.x.size());
  return samples;
}

/// The points' stated variances along the normal.
std::vector<double> variances_along(const Samples& samples, const Eigen::Vector3d& normal) {
  std::vector<double> variance(samples.sigma.size());
  for (std::size_t i = 0; i < variance.size(); ++i) {
    variance[i] = std::pow(samples.sigma_along(normal, i), 2);
  }
  return variance;
}

/// Sets centroid, axes and plane: the principal axes of the weighted points.
void fit_axes(const Samples& samples, const std::vector<double>& weight, PlaneFit& fit) {
  const auto w = [&weight](std::size_t i) { return weight.empty() ? 1.0 : weight[i]; };
  const Eigen::Vector3d base = samples.x.front();  // far from the origin the squares lose digits
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0;
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    sum += w(i) * (samples.x[i] - base);
    total += w(i);
  }
  fit.centroid = base + sum / total;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    const Eigen::Vector3d d = samples.x[i] - fit.centroid;
    scatter += w(i) * d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  require(solver.eigenvalues()(1) > 1e-10 * solver.eigenvalues()(2),
          "the ",
          samples.x.size(),
          " points lie on one line or in one spot, so they decide no plane; add points beside it");
  fit.plane.normal = solver.eigenvectors().col(0).normalized();
  fit.plane.distance = fit.plane.normal.dot(fit.centroid);
  if (fit.plane.distance < 0) fit.plane = {-fit.plane.normal, -fit.plane.distance};
  fit.axis_u = solver.eigenvectors().col(2).normalized();
  fit.axis_v = fit.plane.normal.cross(fit.axis_u);
}

/// What the sigmas leave unexplained of the distances from the plane, as a variance.
double unexplained_by(const std::vector<double>& variance,
                      const Samples& samples,
                      const PlaneFit& fit) {
  std::vector<double> squares(variance.size());
  for (std::size_t i = 0; i < squares.size(); ++i) {
    squares[i] = std::pow(fit.plane.normal.dot(samples.x[i] - fit.centroid), 2);
  }
  return unexplained_variance(squares, variance, samples.x.size() - 3);
}

/// 1 / variance of every point along the normal, with what the sigmas leave unexplained.
std::vector<double> weights_for(const Samples& samples, const PlaneFit& fit) {
  std::vector<double> weight = variances_along(samples, fit.plane.normal);
  const double added = unexplained_by(weight, samples, fit);
  for (double& w : weight) w = 1 / (w + added);
  return weight;
}

void describe_distances(const Samples& samples, PlaneFit& fit) {
  const std::vector<double> variance = variances_along(samples, fit.plane.normal);
  double least = INFINITY;
  double most = -INFINITY;
  double squares = 0;
  double sizes = 0;
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    const double d = fit.plane.normal.dot(samples.x[i] - fit.centroid);
    least = std::min(least, d);
    most = std::max(most, d);
    squares += d * d;
    sizes += std::abs(d);
    if (!variance.empty()) fit.chi_squared += d * d / variance[i];
  }
  fit.unexplained = std::sqrt(unexplained_by(variance, samples, fit));
  fit.points = samples.x.size();
  fit.degrees_of_freedom = fit.points - 3;
  const double n = static_cast<double>(fit.points);
  fit.rms = fit.points > 3 ? std::sqrt(squares / (n - 3)) : 0;
  fit.mean_absolute = sizes / n;
  fit.peak_to_valley = most - least;
  fit.mean_range = samples.mean_range;
  fit.system_error = fit.mean_range > 0 ? 4 * fit.rms / fit.mean_range : 0;
}

/// A point's row of J: how far the plane moves there, along the normal, by (a, b, h).
Eigen::Vector3d row_of(const PlaneFit& fit, const Eigen::Vector3d& x) {
  const Eigen::Vector3d d = x - fit.centroid;
  return {-d.dot(fit.axis_u), -d.dot(fit.axis_v), 1};
}

/// The estimate is linear in the noise e: (a, b, h) = (J'WJ)^-1 J'W e with rows J = (-u, -v, 1), so
/// its covariance is (J'WJ)^-1 J'W S W J (J'WJ)^-1 with S the points' own (GUM, 5.1.2 and F.1.2).
void describe_uncertainty(const Samples& samples,
                          const std::vector<double>& weight,
                          PlaneFit& fit) {
  const std::vector<double> stated = variances_along(samples, fit.plane.normal);
  const double added = fit.unexplained * fit.unexplained;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  Eigen::Vector3d shared = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    const double w = weight.empty() ? 1.0 : weight[i];
    const Eigen::Vector3d row = row_of(fit, samples.x[i]);
    const double variance = stated.empty() ? fit.rms * fit.rms : stated[i] + added;
    information += w * row * row.transpose();
    noise += w * w * variance * row * row.transpose();
    shared += w * samples.ray[i].dot(fit.plane.normal) * row;
  }
  const Eigen::Matrix3d inverse = information.inverse();
  fit.covariance = inverse * noise * inverse;
  fit.covariance = (fit.covariance + fit.covariance.transpose()).eval() / 2;
  fit.range_response = inverse * shared;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> tilts(fit.covariance.topLeftCorner<2, 2>());
  fit.normal_sigma = std::sqrt(std::max(0.0, tilts.eigenvalues()(1)));
  fit.distance_sigma = std::sqrt(fit.covariance(2, 2));
}

/// (J'WJ)^-1 J'W e again, where e is how far a twist (t, w) of its scan moves a point x along the
/// normal: n.t + (x x n).w.
void describe_pose_response(const Samples& samples,
                            const std::vector<double>& weight,
                            const PoseErrors& poses,
                            PlaneFit& fit) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  fit.pose_response.setZero(3, static_cast<Eigen::Index>(6 * poses.root.size()));
  const Eigen::Vector3d& normal = fit.plane.normal;
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    const Eigen::Vector3d row = (weight.empty() ? 1.0 : weight[i]) * row_of(fit, samples.x[i]);
    information += row * row_of(fit, samples.x[i]).transpose();
    Eigen::Matrix<double, 1, 6> moved;
    moved << normal.transpose(), samples.x[i].cross(normal).transpose();
    const std::size_t point = samples.index[i];
    for (std::size_t k = poses.first[point]; k < poses.first[point + 1]; ++k) {
      const auto [scan, share] = poses.shares[k];
      fit.pose_response.middleCols<6>(6 * static_cast<Eigen::Index>(scan)) +=
          double(share) * row * moved;
    }
  }
  const Eigen::Matrix3d inverse = information.inverse();
  for (std::size_t scan = 0; scan < poses.root.size(); ++scan) {
    auto part = fit.pose_response.middleCols<6>(6 * static_cast<Eigen::Index>(scan));
    part = (inverse * part * poses.root[scan]).eval();
  }
}

void describe_extent(const Samples& samples, PlaneFit& fit) {
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(samples.x.size());
  for (const Eigen::Vector3d& x : samples.x) {
    const Eigen::Vector3d d = x - fit.centroid;
    flat.emplace_back(d.dot(fit.axis_u), d.dot(fit.axis_v));
  }
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(flat));
  fit.area = polygon_area(hull);
  for (const Eigen::Vector2d& p : hull) {
    fit.outline.emplace_back(fit.centroid + p.x() * fit.axis_u + p.y() * fit.axis_v);
  }
  const RectangleSides sides = smallest_bounding_rectangle(hull);
  fit.extent = sides.longer;
  fit.width = sides.shorter;
}

}  // namespace

PlaneFit fit_plane(const PointCloud& cloud,
                   const std::vector<std::size_t>& indices,
                   const PlaneFitOptions& options) {
  cloud.check();
  const Samples samples = samples_of(cloud, indices);
  PlaneFit fit;
  std::vector<double> weight;
  fit_axes(samples, weight, fit);
  if (options.weigh_by_sigma && !samples.sigma.empty()) {
    for (int round = 0; round < kWeightingRounds; ++round) {
      weight = weights_for(samples, fit);
      fit_axes(samples, weight, fit);
    }
  }
  describe_distances(samples, fit);
  describe_uncertainty(samples, weight, fit);
  if (options.poses != nullptr && !options.poses->empty()) {
    require(options.poses->first.size() == cloud.size() + 1,
            "the errors of poses are told of ",
            options.poses->first.size() - 1,
            " points, the cloud has ",
            cloud.size());
    describe_pose_response(samples, weight, *options.poses, fit);
  }
  describe_extent(samples, fit);
  return fit;
}

PlaneFit fit_plane(const PointCloud& cloud, const PlaneFitOptions& options) {
  std::vector<std::size_t> all(cloud.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return fit_plane(cloud, all, options);
}

Eigen::Matrix3d PlaneFit::covariance_at(const Eigen::Vector3d& x) const {
  // Tilting the normal by (a, b) moves the plane at the foot of x by -(a u + b v) along it.
  Eigen::Matrix3d move = Eigen::Matrix3d::Identity();
  move(2, 0) = -(x - centroid).dot(axis_u);
  move(2, 1) = -(x - centroid).dot(axis_v);
  return move * covariance * move.transpose();
}

double PlaneFit::sigma_at(const Eigen::Vector3d& x) const {
  return std::sqrt(std::max(0.0, covariance_at(x)(2, 2)));
}

double angle_between(const Plane& a, const Plane& b) {
  // atan2 keeps its digits near 0, where acos loses them.
  return std::atan2(a.normal.cross(b.normal).norm(), std::abs(a.normal.dot(b.normal)));
}

double distance_between(const PlaneFit& a, const PlaneFit& b) {
  return std::abs(a.plane.signed_distance(b.centroid));
}

}  // namespace facula
