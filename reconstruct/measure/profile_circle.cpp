// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/profile_circle.hpp>

#include <cmath>
#include <numeric>

#include <Eigen/Dense>

namespace facula {
namespace {

class CircleModel : public PrimitiveModel {
 public:
  explicit CircleModel(const Eigen::Vector3d& start) : now_(start) {}

  const Eigen::Vector3d& parameters_now() const { return now_; }

  int parameters() const override { return 3; }

  double distance(const Eigen::Vector3d& x,
                  Eigen::Vector3d& normal,
                  Eigen::VectorXd& gradient) const override {
    const Eigen::Vector2d d = x.head<2>() - now_.head<2>();
    const double length = d.norm();
    normal = Eigen::Vector3d::UnitX();
    if (length > 0) normal << d / length, 0;
    gradient << -normal.x(), -normal.y(), -1;
    return length - now_.z();
  }

  void move(const Eigen::VectorXd& step) override {
    before_ = now_;
    now_ += step;
  }

  void undo() override { now_ = before_; }

 private:
  Eigen::Vector3d now_;  // centre and radius [m]
  Eigen::Vector3d before_ = Eigen::Vector3d::Zero();
};

/// Least squares of |p|^2 = 2 c.p + k, about the mean of the points.
Eigen::Vector3d algebraic_circle(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0;
  for (const Eigen::Vector2d& p : points) {
    scatter += p * p.transpose();
    right += p * p.squaredNorm();
    squares += p.squaredNorm() / static_cast<double>(points.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
  require(solver.eigenvalues()(0) > 1e-12 * solver.eigenvalues()(1),
          "the ",
          points.size(),
          " points of the section lie on one line, so they decide no circle");
  const Eigen::Vector2d center = scatter.ldlt().solve(right) / 2;
  return {center.x(), center.y(), std::sqrt(center.squaredNorm() + squares)};
}

}  // namespace

CircleFit fit_circle(const ProfileSection& section) {
  require(section.points.size() >= 3,
          "a circle needs at least 3 points, the section has ",
          section.points.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : section.points) {
    mean += p / static_cast<double>(section.points.size());
  }
  std::vector<Eigen::Vector2d> centered;
  PointCloud cloud;
  for (const Eigen::Vector2d& p : section.points) {
    centered.emplace_back(p - mean);
    cloud.points.emplace_back(
        static_cast<float>(p.x() - mean.x()), static_cast<float>(p.y() - mean.y()), 0.F);
  }
  for (const double sigma : section.sigma) cloud.sigma.push_back(static_cast<float>(sigma));
  std::vector<std::size_t> all(cloud.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  CircleModel model(algebraic_circle(centered));
  CircleFit fit;
  fit.quality = fit_primitive(cloud, all, model);
  fit.center = mean + model.parameters_now().head<2>();
  fit.radius = model.parameters_now().z();
  fit.radius_sigma = std::sqrt(fit.quality.covariance(2, 2));
  return fit;
}

}  // namespace facula
