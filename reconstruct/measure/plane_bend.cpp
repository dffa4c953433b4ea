// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/measure/plane_bend.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace facula {
namespace {

constexpr std::size_t kMost = 4000;  // points that are looked at [1]

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Place on the plane and height over it of up to kMost of the points, about their mean.
Rows flattened(const PointCloud& cloud,
               const std::vector<std::size_t>& indices,
               const Plane& plane) {
  const std::size_t count = std::min(kMost, indices.size());
  const Eigen::Vector3d u = plane.normal.unitOrthogonal();
  const Eigen::Vector3d v = plane.normal.cross(u);
  const Eigen::Vector3d base = cloud.points[indices.front()].cast<double>();
  Rows rows(static_cast<Eigen::Index>(count), 3);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d d =
        cloud.points[indices[i * indices.size() / count]].cast<double>() - base;
    rows.row(static_cast<Eigen::Index>(i)) << d.dot(u), d.dot(v), d.dot(plane.normal);
  }
  const Eigen::RowVector3d mean = rows.colwise().mean();
  rows.rowwise() -= mean;
  return rows;
}

}  // namespace

PlaneBend bend_of(const PointCloud& cloud,
                  const std::vector<std::size_t>& indices,
                  const Plane& plane) {
  if (indices.size() < 12) return {};
  Rows rows = flattened(cloud, indices, plane);
  const double size = rows.leftCols<2>().cwiseAbs().maxCoeff();
  if (!(size > 0)) return {};
  rows /= size;
  const auto s = rows.col(0).array();
  const auto t = rows.col(1).array();
  Eigen::Matrix<double, Eigen::Dynamic, 6> terms(rows.rows(), 6);
  terms << Eigen::VectorXd::Ones(rows.rows()), rows.col(0), rows.col(1), s.square().matrix(),
      (s * t).matrix(), t.square().matrix();
  const auto unexplained = [&](const auto& columns) {
    const Eigen::MatrixXd normal = columns.transpose() * columns;
    const Eigen::VectorXd fitted = normal.ldlt().solve(columns.transpose() * rows.col(2));
    return std::pair{(rows.col(2) - columns * fitted).squaredNorm(), fitted};
  };
  const double flat = unexplained(terms.leftCols<3>()).first;
  const auto [round, coefficients] = unexplained(terms);
  Eigen::Matrix2d curvature;
  curvature << 2 * coefficients(3), coefficients(4), coefficients(4), 2 * coefficients(5);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(curvature);
  PlaneBend bend;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::VectorXd along = rows.leftCols<2>() * solver.eigenvectors().col(axis);
    const double reach = along.maxCoeff() - along.minCoeff();
    bend.angle = std::max(bend.angle, std::abs(solver.eigenvalues()(axis)) * reach);
  }
  bend.share = flat > 0 ? 1 - round / flat : 0;
  return bend;
}

}  // namespace facula
