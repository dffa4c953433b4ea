// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/profile/sheet_projection_fit.hpp>

#include <cmath>
#include <sstream>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace facula {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Moves the centroid to 0 and scales the mean square distance to 2.
Eigen::Matrix3d normalisation(const Points& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double squares = 0;
  for (const Eigen::Vector2d& p : points) squares += (p - mean).squaredNorm();
  const double scale = std::sqrt(2 * static_cast<double>(points.size()) / squares);
  Eigen::Matrix3d t = Eigen::Matrix3d::Identity();
  t.topLeftCorner<2, 2>() *= scale;
  t.topRightCorner<2, 1>() = -scale * mean;
  return t;
}

/// Whether the points, with any one of them left out, still span a plane.
bool spans_plane(const Points& points) {
  for (std::size_t out = 0; out < points.size(); ++out) {
    Points others = points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : others) mean += p / static_cast<double>(others.size());
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Eigen::Vector2d& p : others) spread += (p - mean) * (p - mean).transpose();
    const Eigen::Vector2d sizes =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues();
    if (!(sizes[0] > 1e-8 * sizes[1])) return false;
  }
  return true;
}

void check_points(const std::vector<SheetPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    require(points[i].in_sheet.allFinite() && points[i].pixel.allFinite(),
            "point ",
            i,
            " of the sheet: expected finite coordinates");
  }
  require(points.size() >= 5,
          "expected at least 5 points of the sheet (4 decide the projection, one checks it), got ",
          points.size());
  Points sheet;
  Points image;
  for (const SheetPoint& p : points) {
    sheet.push_back(p.in_sheet);
    image.push_back(p.pixel);
  }
  require(
      spans_plane(sheet),
      "the known points lie on one line, all or all but one: they cannot decide the projection; "
      "add points at other heights");
  require(spans_plane(image),
          "the points are seen on one line of the picture, all or all but one: the camera looks "
          "along the sheet; move it out of the plane of the light");
}

/// Direct linear transform: the null vector of the stacked cross products.
Eigen::Matrix3d direct_solution(const std::vector<SheetPoint>& points) {
  Eigen::MatrixXd rows(2 * static_cast<Eigen::Index>(points.size()), 9);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::RowVector3d x = points[i].in_sheet.homogeneous().transpose();
    const auto r = 2 * static_cast<Eigen::Index>(i);
    rows.row(r) << x, Eigen::RowVector3d::Zero(), -points[i].pixel.x() * x;
    rows.row(r + 1) << Eigen::RowVector3d::Zero(), x, -points[i].pixel.y() * x;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
  const Eigen::VectorXd h = svd.matrixV().col(8);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data());
}

double cost(const std::vector<SheetPoint>& points, const Eigen::Matrix3d& h) {
  double sum = 0;
  for (const SheetPoint& p : points) {
    sum += (SheetProjection{h}.project(p.in_sheet) - p.pixel).squaredNorm();
  }
  return sum;
}

/// Gauss and Newton on the image distances; the matrix keeps its length of 1.
Eigen::Matrix3d refine(const std::vector<SheetPoint>& points, Eigen::Matrix3d h) {
  for (int iteration = 0; iteration < 30; ++iteration) {
    Eigen::MatrixXd jacobian(2 * static_cast<Eigen::Index>(points.size()) + 1, 9);
    Eigen::VectorXd residual(jacobian.rows());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d x = points[i].in_sheet.homogeneous();
      const Eigen::Vector3d y = h * x;
      const Eigen::Vector2d seen = y.hnormalized();
      const auto r = 2 * static_cast<Eigen::Index>(i);
      const Eigen::RowVector3d scaled = x.transpose() / y.z();
      jacobian.row(r) << scaled, Eigen::RowVector3d::Zero(), -seen.x() * scaled;
      jacobian.row(r + 1) << Eigen::RowVector3d::Zero(), scaled, -seen.y() * scaled;
      residual.segment<2>(r) = points[i].pixel - seen;
    }
    // The scale of the matrix is free: a row that holds it.
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_rows = h;
    jacobian.bottomRows<1>() = Eigen::Map<const Eigen::RowVectorXd>(by_rows.data(), 9);
    residual[residual.size() - 1] = 0;
    const Eigen::VectorXd step = jacobian.colPivHouseholderQr().solve(residual);
    const Eigen::Matrix3d moved =
        h + Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(step.data());
    const Eigen::Matrix3d next = moved / moved.norm();
    if (!(cost(points, next) < cost(points, h))) break;
    const bool settled = step.norm() < 1e-14;
    h = next;
    if (settled) break;
  }
  return h;
}

/// Of normalised points back to the given ones, with its sign so that the points lie in front.
SheetProjection solve(const std::vector<SheetPoint>& points) {
  Points sheet;
  Points image;
  for (const SheetPoint& p : points) {
    sheet.push_back(p.in_sheet);
    image.push_back(p.pixel);
  }
  const Eigen::Matrix3d from_sheet = normalisation(sheet);
  const Eigen::Matrix3d from_image = normalisation(image);
  std::vector<SheetPoint> normalised;
  normalised.reserve(points.size());
  for (const SheetPoint& p : points) {
    normalised.push_back({(from_sheet * p.in_sheet.homogeneous()).hnormalized(),
                          (from_image * p.pixel.homogeneous()).hnormalized()});
  }
  const Eigen::Matrix3d h = refine(normalised, direct_solution(normalised));
  Eigen::Matrix3d whole = from_image.inverse() * h * from_sheet;
  double sign = 0;
  for (const SheetPoint& p : points) sign += (whole * p.in_sheet.homogeneous()).z();
  whole /= whole.row(2).norm() * (sign < 0 ? -1 : 1);
  return {whole};
}

double distance_in_sheet(const SheetProjection& projection, const SheetPoint& p) {
  const auto x = projection.in_sheet(p.pixel);
  return x ? (*x - p.in_sheet).norm() : std::nan("");
}

double root_mean(double squares, std::size_t count) {
  return std::sqrt(squares / static_cast<double>(count));
}

void judge(const std::vector<SheetPoint>& points, SheetProjectionFit& fit) {
  double squares_px = 0;
  double squares = 0;
  double out_px = 0;
  double out = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SheetPoint& p = points[i];
    fit.residual_px.push_back((fit.projection.project(p.in_sheet) - p.pixel).norm());
    fit.residual.push_back(distance_in_sheet(fit.projection, p));
    squares_px += fit.residual_px.back() * fit.residual_px.back();
    squares += fit.residual.back() * fit.residual.back();
    std::vector<SheetPoint> others = points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const SheetProjection without = solve(others);
    out_px += (without.project(p.in_sheet) - p.pixel).squaredNorm();
    out += std::pow(distance_in_sheet(without, p), 2);
  }
  fit.rms_px = root_mean(squares_px, points.size());
  fit.rms = root_mean(squares, points.size());
  fit.held_out_rms_px = root_mean(out_px, points.size());
  fit.held_out_rms = root_mean(out, points.size());
}

}  // namespace

SheetProjectionFit fit_sheet_projection(const std::vector<SheetPoint>& points) {
  check_points(points);
  SheetProjectionFit fit;
  fit.projection = solve(points);
  fit.projection.check();
  judge(points, fit);
  if (points.size() < 8) {
    std::ostringstream text;
    text << points.size()
         << " points leave little to check the projection by; 20 or more are usual";
    fit.warnings.push_back(text.str());
  }
  if (!(fit.held_out_rms_px <= 3 * fit.rms_px + 1e-9)) {
    fit.warnings.emplace_back(
        "points left out are missed far more than points fitted: the projection hangs on single "
        "points; spread more of them over the sheet");
  }
  return fit;
}

}  // namespace facula
