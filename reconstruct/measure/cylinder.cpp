// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/cylinder.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Dense>

namespace facula {
namespace {

constexpr double kNormalCosine = 0.7;  // a point counts when its normal is within 45 degrees

/// A cylinder with two directions square to its axis.
struct Posed {
  Cylinder cylinder;
  Eigen::Vector3d u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d v = Eigen::Vector3d::UnitY();
};

class CylinderModel : public PrimitiveModel {
 public:
  explicit CylinderModel(const Cylinder& cylinder) : now_{cylinder} {
    now_.cylinder.axis.normalize();
    now_.u = now_.cylinder.axis.unitOrthogonal();
    now_.v = now_.cylinder.axis.cross(now_.u);
  }

  const Posed& posed() const { return now_; }

  int parameters() const override { return 5; }

  double distance(const Eigen::Vector3d& x,
                  Eigen::Vector3d& normal,
                  Eigen::VectorXd& gradient) const override {
    const Eigen::Vector3d d = x - now_.cylinder.point;
    const double along = d.dot(now_.cylinder.axis);
    const Eigen::Vector3d off = d - along * now_.cylinder.axis;
    const double length = off.norm();
    normal = length > 0 ? Eigen::Vector3d(off / length) : now_.u;
    const double nu = normal.dot(now_.u);
    const double nv = normal.dot(now_.v);
    gradient << -nu, -nv, -along * nu, -along * nv, -1;
    return length - now_.cylinder.radius;
  }

  void move(const Eigen::VectorXd& step) override {
    before_ = now_;
    Cylinder& c = now_.cylinder;
    c.point += step(0) * now_.u + step(1) * now_.v;
    c.axis = (c.axis + step(2) * now_.u + step(3) * now_.v).normalized();
    c.radius += step(4);
    now_.u = (now_.u - now_.u.dot(c.axis) * c.axis).normalized();
    now_.v = c.axis.cross(now_.u);
  }

  void undo() override { now_ = before_; }

 private:
  Posed now_;
  Posed before_;
};

/// Puts the axis's point in the middle of the points.
Cylinder centered(Cylinder cylinder,
                  const PointCloud& cloud,
                  const std::vector<std::size_t>& indices) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const std::size_t i : indices) {
    if (!cloud.points[i].allFinite()) continue;
    const double along = (cloud.points[i].cast<double>() - cylinder.point).dot(cylinder.axis);
    least = std::min(least, along);
    most = std::max(most, along);
  }
  cylinder.point += (least + most) / 2 * cylinder.axis;
  return cylinder;
}

/// Length along the axis and share of the circumference.
void describe_extent(const PointCloud& cloud,
                     const std::vector<std::size_t>& indices,
                     CylinderFit& fit) {
  double reach = 0;
  std::vector<double> turns;
  for (const std::size_t i : indices) {
    if (!cloud.points[i].allFinite()) continue;
    const Eigen::Vector3d d = cloud.points[i].cast<double>() - fit.cylinder.point;
    reach = std::max(reach, std::abs(d.dot(fit.cylinder.axis)));
    turns.push_back(std::atan2(d.dot(fit.axis_v), d.dot(fit.axis_u)));
  }
  fit.length = 2 * reach;
  std::sort(turns.begin(), turns.end());
  constexpr double kTurn = 2 * std::numbers::pi;
  double gap = turns.front() + kTurn - turns.back();
  for (std::size_t i = 1; i < turns.size(); ++i) gap = std::max(gap, turns[i] - turns[i - 1]);
  fit.covered = kTurn - gap;
}

bool counts(const PointCloud& cloud, std::size_t i, const Cylinder& cylinder, double within) {
  const Eigen::Vector3d x = cloud.points[i].cast<double>();
  if (!(std::abs(cylinder.signed_distance(x)) <= within)) return false;
  const Eigen::Vector3d d = x - cylinder.point;
  const Eigen::Vector3d off = (d - d.dot(cylinder.axis) * cylinder.axis).normalized();
  return std::abs(off.dot(cloud.normals[i].cast<double>())) >= kNormalCosine;
}

std::vector<std::size_t> points_on(const PointCloud& cloud,
                                   const Cylinder& cylinder,
                                   double within) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (counts(cloud, i, cylinder, within)) result.push_back(i);
  }
  return result;
}

/// The axis is square to both normals and passes where their lines come nearest each other.
std::optional<Cylinder> through(const PointCloud& cloud, std::size_t i, std::size_t j) {
  const Eigen::Vector3d p = cloud.points[i].cast<double>();
  const Eigen::Vector3d q = cloud.points[j].cast<double>();
  const Eigen::Vector3d n = cloud.normals[i].cast<double>();
  const Eigen::Vector3d m = cloud.normals[j].cast<double>();
  const Eigen::Vector3d axis = n.cross(m);
  const double squared = axis.squaredNorm();
  if (!(squared > 0.01)) return std::nullopt;
  const double to_axis = (q - p).cross(m).dot(axis) / squared;
  const Cylinder cylinder{p + to_axis * n, axis.normalized(), std::abs(to_axis)};
  if (!cylinder.point.allFinite()) return std::nullopt;
  return cylinder;
}

std::optional<Cylinder> best_of_trials(const PointCloud& cloud, const ShapeSearchOptions& options) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].allFinite() && cloud.normals[i].allFinite() &&
        cloud.normals[i].squaredNorm() > 0.5F) {
      usable.push_back(i);
    }
  }
  require(usable.size() >= 5,
          "expected a cylinder, got ",
          usable.size(),
          " points that have a normal, of which it needs at least 5; points on one line or in one "
          "spot have none");
  Random random(options.seed);
  constexpr std::size_t kMostJudges = 5000;
  std::vector<std::size_t> judging = usable;
  if (usable.size() > kMostJudges) {
    judging.resize(kMostJudges);
    for (std::size_t& i : judging) i = usable[random.below(usable.size())];
  }
  std::optional<Cylinder> best;
  std::size_t most = 0;
  for (int t = 0; t < options.trials; ++t) {
    const std::size_t i = usable[random.below(usable.size())];
    const std::size_t j = usable[random.below(usable.size())];
    const std::optional<Cylinder> cylinder = through(cloud, i, j);
    if (!cylinder || cylinder->radius < options.min_radius ||
        cylinder->radius > options.max_radius) {
      continue;
    }
    std::size_t count = 0;
    for (const std::size_t k : judging) {
      count += counts(cloud, k, *cylinder, options.inlier_distance) ? 1 : 0;
    }
    if (count <= most) continue;
    most = count;
    best = cylinder;
  }
  return best;
}

}  // namespace

CylinderFit fit_cylinder(const PointCloud& cloud,
                         const std::vector<std::size_t>& indices,
                         const Cylinder& start,
                         const PrimitiveFitOptions& options) {
  require(start.axis.allFinite() && start.axis.norm() > 0.5 && start.point.allFinite() &&
              start.radius > 0,
          "expected a first cylinder with an axis and a radius above 0 mm, got a radius of ",
          1000 * start.radius);
  for (const std::size_t i : indices) {
    require(i < cloud.size(), "expected points of a cloud of ", cloud.size(), ", got number ", i);
  }
  CylinderFit fit;
  fit.cylinder = start;
  for (int round = 0; round < 2; ++round) {  // the second about the middle of the points
    CylinderModel model(centered(fit.cylinder, cloud, indices));
    fit.quality = fit_primitive(cloud, indices, model, options);
    fit.cylinder = centered(model.posed().cylinder, cloud, indices);
    fit.axis_u = model.posed().u;
    fit.axis_v = model.posed().v;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> tilts(
      Eigen::Matrix2d(fit.quality.covariance.block<2, 2>(2, 2)));
  fit.axis_sigma = std::sqrt(std::max(0.0, tilts.eigenvalues()(1)));
  fit.radius_sigma = std::sqrt(fit.quality.covariance(4, 4));
  describe_extent(cloud, indices, fit);
  return fit;
}

FoundCylinder find_cylinder(const PointCloud& cloud, const ShapeSearchOptions& options) {
  options.check();
  cloud.check();
  require(!cloud.normals.empty() || cloud.empty(),
          "a cylinder is sought by normals, the cloud has none; estimate them first");
  const std::optional<Cylinder> start = best_of_trials(cloud, options);
  FoundCylinder found;
  if (start) found.indices = points_on(cloud, *start, options.inlier_distance);
  options.require_found("cylinder", found.indices.size(), cloud.size());
  found.fit = fit_cylinder(cloud, found.indices, *start);
  for (int round = 0; round < 4; ++round) {
    std::vector<double> away;
    for (const std::size_t i : found.indices) {
      away.push_back(found.fit.cylinder.signed_distance(cloud.points[i].cast<double>()));
    }
    const double within = trimmed_distance(away, options.inlier_distance);
    found.indices = points_on(cloud, found.fit.cylinder, within);
    require(found.indices.size() >= options.min_points,
            "expected a cylinder of ",
            options.min_points,
            " points or more, the fit drifted off to one of ",
            found.indices.size(),
            "; raise the inlier distance or name the radius sought");
    found.fit = fit_cylinder(cloud, found.indices, found.fit.cylinder);
  }
  return found;
}

}  // namespace facula
