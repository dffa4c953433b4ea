// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

Rig shipped_rig(const char* name) {
  return read_rig(shipped_data("rigs") / name);
}

Rig moved_by(const Rig& rig, const std::string& name, double delta) {
  return moved(rig, {name}, Eigen::VectorXd::Constant(1, delta));
}

TEST(RigParameters, MoveOnlyWhatTheyName) {
  const Rig rig = shipped_rig("head_fs1500.toml");
  EXPECT_DOUBLE_EQ(moved_by(rig, "camera.fx_px", 2).camera.fx, rig.camera.fx + 2);
  EXPECT_DOUBLE_EQ(moved_by(rig, "camera.k3", 0.1).camera.k3, 0.1);
  EXPECT_DOUBLE_EQ(moved_by(rig, "laser.808 nm.distance_mm", 2).lasers[0].distance, 0.252);
  EXPECT_DOUBLE_EQ(moved_by(rig, "laser.808 nm.bow_rad", 0.01).lasers[0].bow, 0.01);
  const Rig turned = moved_by(rig, "laser.808 nm.turn_a_rad", 1e-3);
  EXPECT_NEAR(std::acos(turned.lasers[0].normal.dot(rig.lasers[0].normal)), 1e-3, 1e-8);
  EXPECT_EQ(turned.lasers[0].distance, rig.lasers[0].distance);
}

/// The axis line stands in the camera frame; moving the camera by d along scan x moves the line by
/// -d there, and what moves it along itself is no parameter.
TEST(RigParameters, AxisLineMovesByTheShiftAndTheTurn) {
  const Rig rig = shipped_rig("ciclop_turntable.toml");
  const auto origin = [](const Rig& r) {
    return r.axis.scan_from_camera.inverse() * Eigen::Vector3d::Zero().eval();
  };
  const auto direction = [](const Rig& r) {
    return Eigen::Vector3d(r.axis.scan_from_camera.rotation.conjugate() * Eigen::Vector3d::UnitZ());
  };
  const Rig shifted = moved_by(rig, "axis.shift_x_mm", 3);
  EXPECT_NEAR((origin(shifted) - origin(rig)).norm(), 3e-3, 1e-12);
  EXPECT_NEAR((origin(shifted) - origin(rig)).dot(direction(rig)), 0, 1e-12);
  const Rig turned = moved_by(rig, "axis.turn_y_rad", 1e-3);
  EXPECT_NEAR(std::acos(direction(turned).dot(direction(rig))), 1e-3, 1e-8);
  EXPECT_EQ(rig_parameter_names(rig).size(), 9U + 4U + 4U);
}

TEST(RigParameters, OfALinearAxisAreItsTwoAngles) {
  Rig rig = shipped_rig("head_fs1500.toml");
  rig.axis.kind = AxisKind::kLinear;
  EXPECT_EQ(rig_parameter_names(rig).size(), 9U + 4U + 2U);
  const Rig turned = moved_by(rig, "axis.direction_b_rad", 2e-3);
  EXPECT_NEAR(std::acos(turned.axis.direction.dot(rig.axis.direction)), 2e-3, 1e-8);
  EXPECT_THROW(moved_by(rig, "axis.turn_x_rad", 1e-3), Error);
}

TEST(RigParameters, UnknownNamesAreAnsweredWithTheNearest) {
  const Rig rig = shipped_rig("head_fs1500.toml");
  const std::string sentence = error_of([&] { moved_by(rig, "camera.fx_pix", 1); });
  EXPECT_NE(sentence.find("did you mean 'camera.fx_px'"), std::string::npos) << sentence;
}

Rig with_covariance() {
  Rig rig = shipped_rig("head_fs1500.toml");
  RigCovariance c;
  c.parameters = {"camera.fx_px", "laser.808 nm.distance_mm", "axis.shift_x_mm"};
  c.matrix.resize(3, 3);
  c.matrix << 0.09, 0.001, 0, 0.001, 1e-4, 2e-5, 0, 2e-5, 4e-4;
  rig.covariance = c;
  return rig;
}

TEST(RigCovariance, IsReadBackAsWritten) {
  const TemporaryFolder folder;
  const Rig rig = with_covariance();
  write_rig(folder / "rig.toml", rig);
  const Rig copy = read_rig(folder / "rig.toml");
  ASSERT_TRUE(copy.covariance.has_value());
  EXPECT_EQ(copy.covariance->parameters, rig.covariance->parameters);
  EXPECT_EQ(copy.covariance->matrix, rig.covariance->matrix);
  EXPECT_DOUBLE_EQ(parameter_sigma(copy, "camera.fx_px"), 0.3);
  EXPECT_EQ(parameter_sigma(copy, "camera.fy_px"), 0);
}

TEST(RigCovariance, ThatCannotBeIsRefusedInASentence) {
  const auto complaint = [](const std::function<void(RigCovariance&)>& spoil) {
    Rig rig = with_covariance();
    spoil(*rig.covariance);
    return error_of([&] { rig.check(); });
  };
  using C = RigCovariance;
  EXPECT_NE(complaint([](C& c) { c.parameters[1] = "laser.red.distance_mm"; }).find("no parameter"),
            std::string::npos);
  EXPECT_NE(complaint([](C& c) { c.parameters[1] = c.parameters[0]; }).find("named twice"),
            std::string::npos);
  EXPECT_NE(complaint([](C& c) { c.matrix.conservativeResize(2, 3); }).find("one row and column"),
            std::string::npos);
  EXPECT_NE(complaint([](C& c) { c.matrix(0, 1) = 0; }).find("symmetric"), std::string::npos);
  EXPECT_NE(complaint([](C& c) { c.matrix(0, 0) = -1; }).find("0 or more"), std::string::npos);
  EXPECT_NE(complaint([](C& c) { c.matrix(0, 1) = c.matrix(1, 0) = 0.01; }).find("semidefinite"),
            std::string::npos);
  EXPECT_NE(complaint([](C& c) { c.matrix(2, 2) = std::nan(""); }).find("finite"),
            std::string::npos);
}

TEST(RigCovariance, OfAWrongShapeInTheFileNamesTheKey) {
  const TemporaryFolder folder;
  write_rig(folder / "rig.toml", shipped_rig("head_fs1500.toml"));
  std::ifstream written(folder / "rig.toml");
  const std::string good((std::istreambuf_iterator<char>(written)), {});
  const auto complaint = [&](const std::string& table) {
    const auto file = folder.write("bad.toml", good + "\n[covariance]\n" + table);
    return error_of([&] { read_rig(file); });
  };
  EXPECT_NE(complaint("parameters = [\"camera.k1\"]\n").find("covariance.rows"), std::string::npos);
  EXPECT_NE(complaint("parameters = [\"camera.k1\"]\nrows = [[1, 2]]\n").find("row 1"),
            std::string::npos);
  EXPECT_NE(complaint("parameters = [1]\nrows = [[1]]\n").find("texts"), std::string::npos);
  EXPECT_NE(complaint("parameters = []\nrows = []\n").find("at least one"), std::string::npos);
  EXPECT_NE(complaint("parameters = [\"camera.k1\"]\nrows = [1]\n").find("lists of numbers"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
