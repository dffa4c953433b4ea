// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_calibration.hpp>
#include <facula/acquire/calibrate/synthetic_set.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>
#include <facula/acquire/triangulate/calibration_sigma.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace facula {
namespace {

/// A rig with the covariance that a calibration of it would have.
Rig known_rig(const char* name, AxisKind kind) {
  Rig rig = read_rig(shipped_data("rigs") / name);
  rig.axis.kind = kind;
  SyntheticSetOptions options;
  options.distance = kind == AxisKind::kTurntable ? 0.3 : 0.5;
  options.span = kind == AxisKind::kLinear ? 0.2 : 0.9;
  JointOptions joint;
  joint.folds = 0;
  const JointCalibration found = calibrate_jointly(synthesize_calibration_set(rig, options), joint);
  return found.rig;
}

/// Point of a pixel in the scan frame.
std::optional<Eigen::Vector3d> point_in_scan(const Rig& rig,
                                             const Eigen::Vector2d& pixel,
                                             double position) {
  const auto point = triangulate(rig, 0, pixel, 0.1);
  if (!point) return std::nullopt;
  return rig.axis.scan_from_camera_at(position) * point->x_in_camera;
}

/// Standard deviation along the ray over rigs drawn from the covariance.
double drawn_sigma(const Rig& rig, const Eigen::Vector2d& pixel, double position) {
  const auto& names = rig.covariance->parameters;
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(rig.covariance->matrix);
  const Eigen::VectorXd d = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt();
  const Eigen::MatrixXd root =
      ldlt.transpositionsP().transpose() * Eigen::MatrixXd(ldlt.matrixL()) * d.asDiagonal();
  const Eigen::Vector3d centre = *point_in_scan(rig, pixel, position);
  const Eigen::Vector3d ray =
      (centre - rig.axis.scan_from_camera_at(position).translation).normalized();
  Random random(5);
  double sum = 0;
  double sum2 = 0;
  constexpr int kDraws = 3000;
  for (int k = 0; k < kDraws; ++k) {
    Eigen::VectorXd z(static_cast<Eigen::Index>(names.size()));
    for (double& value : z) value = random.normal();
    const double off =
        ray.dot(*point_in_scan(moved(rig, names, root * z), pixel, position) - centre);
    sum += off;
    sum2 += off * off;
  }
  const double mean = sum / kDraws;
  return std::sqrt(sum2 / kDraws - mean * mean);
}

/// 3000 draws know a standard deviation to 1.3 %.
TEST(CalibrationSigma, IsTheSpreadOverRigsDrawnFromTheCovariance) {
  const struct {
    const char* name;
    AxisKind kind;
    double position;
  } cases[] = {{"ciclop_turntable.toml", AxisKind::kTurntable, 1.0},
               {"head_fs1500.toml", AxisKind::kPan, -0.7},
               {"head_fs1500.toml", AxisKind::kLinear, 0.4}};
  for (const auto& c : cases) {
    const Rig rig = known_rig(c.name, c.kind);
    const CalibrationSigma sigma(rig, 0);
    ASSERT_TRUE(sigma.known());
    int compared = 0;
    for (const double u : {0.3, 0.5, 0.7}) {
      for (const double v : {0.1, 0.9}) {
        const Eigen::Vector2d pixel(u * rig.camera.width, v * rig.camera.height);
        const auto point = triangulate(rig, 0, pixel, 0.1);
        if (!point || point->x_in_camera.norm() > 2) continue;
        const double drawn = drawn_sigma(rig, pixel, c.position);
        EXPECT_NEAR(std::sqrt(sigma.exact_variance(pixel, c.position)), drawn, 0.05 * drawn);
        const double range = point->x_in_camera.norm();
        EXPECT_NEAR(std::sqrt(sigma.variance(pixel, range, c.position)), drawn, 0.06 * drawn);
        ++compared;
      }
    }
    EXPECT_GE(compared, 3) << c.name;
  }
}

TEST(CalibrationSigma, IsWellInterpolatedAllOverTheImage) {
  for (const char* name : {"ciclop_turntable.toml", "head_fs1500.toml"}) {
    const Rig rig = known_rig(name, read_rig(shipped_data("rigs") / name).axis.kind);
    const CalibrationSigma sigma(rig, 0);
    Random random(1);
    int compared = 0;
    double worst = 0;
    for (int k = 0; k < 500; ++k) {
      const Eigen::Vector2d pixel(random.uniform() * (rig.camera.width - 1),
                                  random.uniform() * (rig.camera.height - 1));
      const auto point = triangulate(rig, 0, pixel, 0.1);
      if (!point || point->x_in_camera.norm() > 10) continue;
      const double exact = std::sqrt(sigma.exact_variance(pixel, 0));
      const double fast = std::sqrt(sigma.variance(pixel, point->x_in_camera.norm(), 0));
      worst = std::max(worst, std::abs(fast / exact - 1));
      ++compared;
    }
    EXPECT_GT(compared, 100) << name;
    EXPECT_LT(worst, 0.03) << name;
  }
}

/// Closed form: an uncertain axis shift along the ray moves the point by itself.
TEST(CalibrationSigma, OfAShiftedAxisIsTheShiftItself) {
  Rig rig = read_rig(shipped_data("rigs") / "head_fs1500.toml");
  RigCovariance c;
  c.parameters = {"axis.shift_x_mm"};
  c.matrix = Eigen::MatrixXd::Constant(1, 1, 0.04);
  rig.covariance = c;
  const Eigen::Vector2d pixel(rig.camera.cx, rig.camera.cy);  // looks along scan x
  EXPECT_NEAR(CalibrationSigma(rig, 0).exact_variance(pixel, 1.2), 0.04e-6, 1e-12);
}

TEST(CalibrationSigma, OfARigWithoutCovarianceIsUnknown) {
  const Rig rig = read_rig(shipped_data("rigs") / "head_fs1500.toml");
  const CalibrationSigma sigma(rig, 0);
  EXPECT_FALSE(sigma.known());
  EXPECT_EQ(sigma.variance({100, 100}, 1, 0), 0);
}

}  // namespace
}  // namespace facula
