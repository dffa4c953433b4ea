// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/calibrate/sheet_fit.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>

#include <cmath>
#include <limits>
#include <locale>
#include <numbers>
#include <sstream>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace facula {
namespace {

struct Sums {
  double squares = 0;
  double sum = 0;
};

Sums sums_of(const SheetView& view, const LaserPlane& plane) {
  Sums sums;
  for (const SheetPoint& p : view.points) {
    const double off = plane.sheet_distance(p.x);
    sums.squares += off * off;
    sums.sum += off;
  }
  return sums;
}

LaserViewResidual residual_of(const std::vector<SheetView>& views,
                              std::size_t v,
                              const LaserPlane& plane,
                              const LaserCalibrationOptions& options) {
  std::vector<SheetView> others = views;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(v));
  LaserViewResidual residual;
  residual.view = views[v].view;
  residual.points = views[v].points.size();
  const auto n = static_cast<double>(residual.points);
  const Sums fitted = sums_of(views[v], plane);
  residual.rms = std::sqrt(fitted.squares / n);
  residual.mean = fitted.sum / n;
  const LaserPlane without = fit_sheet(others, options).plane;
  const Sums held_out = sums_of(views[v], without);
  residual.held_out_rms = std::sqrt(held_out.squares / n);
  residual.held_out_mean = held_out.sum / n;
  return residual;
}

template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

void add_warnings(const std::vector<SheetView>& views, LaserCalibration& result) {
  if (views.size() < 4) {
    result.warnings.push_back(sentence(
        "only ",
        views.size(),
        " views hold the line; 6 to 15 at distances all over the range make errors average out"));
  }
  const double tilt = std::sqrt(std::max(result.covariance(0, 0), result.covariance(1, 1)));
  if (tilt > 1e-3) {
    result.warnings.push_back(
        sentence("the sheet's direction is known to ",
                 tilt * 180 / std::numbers::pi,
                 " degrees only (1 sigma); hold the board nearer and farther"));
  }
  std::vector<double> spread;
  for (const LaserViewResidual& view : result.views) {
    if (std::isfinite(view.held_out_rms)) spread.push_back(view.held_out_rms);
  }
  const double usual = median(spread);
  for (const LaserViewResidual& view : result.views) {
    if (view.held_out_rms > 3 * usual && view.held_out_rms > 1e-4) {
      result.warnings.push_back(
          sentence("view ",
                   view.view,
                   " lies ",
                   1000 * view.held_out_rms,
                   " mm off the sheet of the others (usual: ",
                   1000 * usual,
                   " mm): its board or the laser moved, or something else was taken for the line"));
    }
  }
  if (result.outlier_share > 0.1) {
    result.warnings.push_back(
        sentence(100 * result.outlier_share,
                 " % of the points count as outliers; the figures include them"));
  }
}

/// A sheet that the points leave open, or that is not what most of them lie on.
void require_decided(const SheetFit& fit) {
  constexpr double kMostTilt = 0.1;  // [rad], 1 sigma
  constexpr double kMostOutliers = 0.3;
  const double variance = std::max(fit.covariance(0, 0), fit.covariance(1, 1));
  const Eigen::VectorXd scale = fit.covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * fit.covariance * scale.asDiagonal();
  const bool sound = correlation.allFinite() && Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                                    correlation, Eigen::EigenvaluesOnly)
                                                        .eigenvalues()
                                                        .minCoeff() > 0;
  require(sound && variance < kMostTilt * kMostTilt,
          "the points of the laser line leave the direction of the sheet open: the boards stand "
          "in the same place, or nearly; hold them at several distances or tilts");
  require(fit.outlier_share < kMostOutliers,
          "expected one sheet of light through the lines on the boards, got ",
          100 * fit.outlier_share,
          " % of their points off the best one; check that the laser was on, that it is the same "
          "in all pictures, and its colour and direction");
}

}  // namespace

void LaserCalibrationOptions::check() const {
  require(outlier_sigmas > 1, "outlier_sigmas: expected above 1, got ", outlier_sigmas);
  require(min_pixel_sigma > 0 && min_pixel_sigma < 10,
          "min_pixel_sigma_px: expected above 0, got ",
          min_pixel_sigma);
}

std::vector<Eigen::Vector3d> points_on_board(const Camera& camera,
                                             const RigidTransform& camera_from_board,
                                             const LaserLineView& line) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& pixel : line.pixels) {
    points.push_back(
        meet_board(camera, camera_from_board, pixel).value_or(Eigen::Vector3d(none, none, none)));
  }
  return points;
}

LaserCalibration calibrate_laser(const Camera& camera,
                                 const std::vector<BoardPose>& poses,
                                 const std::vector<LaserLineView>& lines,
                                 std::size_t laser,
                                 const LaserCalibrationOptions& options) {
  options.check();
  const std::vector<SheetView> views =
      sheet_views(camera, poses, lines, laser, options.min_pixel_sigma);
  require(views.size() >= 2,
          "expected the laser line on boards in 2 pictures or more, found it in ",
          views.size(),
          "; take pictures of the board with the line across it at several distances");
  const PlaneStart start = plane_through(views);
  require(start.breadth > 0.01 * start.length,
          "all points of the laser line lie on one straight line in space (",
          1000 * start.breadth,
          " mm broad, ",
          1000 * start.length,
          " mm long), through which any sheet passes; hold the board at several distances or "
          "tilts");
  const SheetFit fit = fit_sheet(views, options);
  require_decided(fit);
  LaserCalibration result;
  result.plane = fit.plane;
  // Distances in mm, as the rig's parameters count.
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(fit.covariance.rows());
  unit[2] = 1000;
  result.covariance = unit.asDiagonal() * fit.covariance * unit.asDiagonal();
  result.outlier_share = fit.outlier_share;
  result.reduced_chi_squared = fit.variance_factor;
  double squares = 0;
  double held_out = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (views.size() > 2) {
      result.views.push_back(residual_of(views, v, result.plane, options));
    } else {
      const Sums sums = sums_of(views[v], result.plane);
      const auto n = static_cast<double>(views[v].points.size());
      result.views.push_back({views[v].view,
                              views[v].points.size(),
                              std::sqrt(sums.squares / n),
                              sums.sum / n,
                              std::nan(""),
                              std::nan("")});
    }
    const auto n = static_cast<double>(views[v].points.size());
    result.points += views[v].points.size();
    squares += n * std::pow(result.views.back().rms, 2);
    held_out += n * std::pow(result.views.back().held_out_rms, 2);
  }
  result.rms = std::sqrt(squares / static_cast<double>(result.points));
  result.held_out_rms = std::sqrt(held_out / static_cast<double>(result.points));
  add_warnings(views, result);
  return result;
}

}  // namespace facula
