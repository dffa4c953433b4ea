// SPDX-License-Identifier: GPL-3.0-or-later
// Many scans of a simulated room against the places where the head stood.
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/simulate/simulate.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

RigidTransform stand(double x, double y, double yaw) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitZ())),
          {x, y, 1.1}};
}

/// What a head sees of a scene, every range with noise of 1 mm.
PosedCloud seen(const Scene& scene, const RigidTransform& pose, std::uint64_t number) {
  static const Rig rig = read_rig(shipped_data("rigs/head_fs1500.toml"));
  std::vector<double> positions;
  for (int k = 0; k < 144; ++k) positions.push_back(2.5 * kDegree * k);
  const PolarScan scan = true_scan(scene, rig, pose, positions, options_for(rig));
  PosedCloud posed;
  posed.name = "station" + std::to_string(number);
  posed.cloud = cloud_from_scan(scan);
  posed.grid = grid_from_scan(scan);
  posed.cloud.sigma.assign(posed.cloud.size(), 0.001F);
  Random random(1, number);
  for (std::size_t i = 0; i < posed.cloud.size(); ++i) {
    Eigen::Vector3f& p = posed.cloud.points[i];
    const Eigen::Vector3f ray = (p - posed.cloud.sensor_origin[i]).normalized();
    p += static_cast<float>(0.001 * random.normal()) * ray;
  }
  return posed;
}

struct Room {
  ScanProject project;
  std::vector<RigidTransform> truth;
};

/// Four stations in the furnished room; made once.
const Room& furnished_room() {
  static const Room room = [] {
    const Scene scene = read_scene(shipped_data("scenes/furnished_room.toml"));
    Room made;
    made.truth = {
        stand(-1.5, -0.3, 0), stand(0.2, 0.8, 120), stand(1.7, -0.3, -75), stand(-0.3, -0.2, 200)};
    for (std::size_t i = 0; i < 4; ++i) {
      made.project.scans.push_back(seen(scene, made.truth[i], i + 1));
    }
    return made;
  }();
  return room;
}

/// Compares with the truth after the scan that stays was laid onto its true pose.
void expect_truth(const Room& room, const ScanProject& found, const RegisterScansResult& result) {
  const RigidTransform true_from_found =
      room.truth[result.anchor] * found.scans[result.anchor].world_from_scan.inverse();
  for (std::size_t i = 0; i < room.truth.size(); ++i) {
    EXPECT_TRUE(result.scans[i].placed) << found.scans[i].name << ": " << result.scans[i].reason;
    EXPECT_TRUE(is_near_pose(
        true_from_found * found.scans[i].world_from_scan, room.truth[i], 0.05 * kDegree, 0.002))
        << found.scans[i].name;
    // The project states how far off that is: chi-squared of six below its 99.9 %.
    if (i == result.anchor) continue;
    const RigidTransform off =
        true_from_found.inverse() * room.truth[i] * found.scans[i].world_from_scan.inverse();
    const Eigen::Matrix<double, 6, 1> twist = log_se3(off);
    EXPECT_LT(twist.dot(found.scans[i].pose_covariance.ldlt().solve(twist)), 22.5)
        << found.scans[i].name;
  }
  EXPECT_TRUE(found.scans[result.anchor].pose_covariance.isZero(0));
}

bool same_bits(const ScanProject& a, const ScanProject& b) {
  for (std::size_t i = 0; i < a.scans.size(); ++i) {
    const RigidTransform& x = a.scans[i].world_from_scan;
    const RigidTransform& y = b.scans[i].world_from_scan;
    if (x.translation != y.translation || x.rotation.coeffs() != y.rotation.coeffs()) return false;
  }
  return true;
}

TEST(RegisterScans, FindsTheStationsOfARoomTheSameForAnyNumberOfThreadsAndAnyOrder) {
  const Room& room = furnished_room();
  ScanProject one = room.project;
  ScanProject two = room.project;
  std::reverse(two.scans.begin(), two.scans.end());
  const RegisterScansResult result = register_scans(one, {.num_threads = 1});
  EXPECT_FALSE(result.from_given);
  EXPECT_EQ(result.placed, 4U);
  expect_truth(room, one, result);
  std::size_t calls = 0;
  const RegisterScansResult other =
      register_scans(two, {.num_threads = 2, .progress = [&](std::size_t done, std::size_t total) {
                             EXPECT_LE(done, total);
                             ++calls;
                           }});
  EXPECT_EQ(other.anchor, 3 - result.anchor);
  std::reverse(two.scans.begin(), two.scans.end());
  EXPECT_TRUE(same_bits(one, two));
  EXPECT_GT(calls, 6U);
}

TEST(RegisterScans, RefusesAScanOfAnotherPlaceWhichChangesNothingElse) {
  const Room& room = furnished_room();
  const TemporaryFolder folder;
  const Scene other =
      read_scene(folder.write("other.toml",
                              "[[object]]\nname = 'hall'\nshape = 'room'\n"
                              "size_mm = [3100, 9300, 4200]\n"
                              "position_mm = [0, 0, 2100]\n"
                              "[[object]]\nname = 'tank'\nshape = 'sphere'\nradius_mm = 900\n"
                              "position_mm = [300, 2500, 1200]\n"
                              "[[object]]\nname = 'post'\nshape = 'cylinder'\nradius_mm = 200\n"
                              "height_mm = 4200\nposition_mm = [-900, -2, 2100]\n"));
  ScanProject project;
  project.scans.push_back(seen(other, stand(0.4, 0.2, 10), 9));
  for (std::size_t i = 4; i-- > 0;) project.scans.push_back(room.project.scans[i]);
  ScanProject alone = room.project;
  const RegisterScansResult expected = register_scans(alone);
  const RegisterScansResult result = register_scans(project);
  EXPECT_EQ(result.placed, 4U);
  EXPECT_FALSE(result.scans[0].placed);
  EXPECT_NE(result.scans[0].reason, "");
  EXPECT_EQ(result.anchor, 4 - expected.anchor);
  // The search goes by the sampling of all scans, so refinement starts elsewhere: it ends within a
  // thousandth of the finest voxel.
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(is_near_pose(
        project.scans[4 - i].world_from_scan, alone.scans[i].world_from_scan, 1e-6, 1e-6));
  }
}

TEST(RegisterScans, StartsFromRoughPosesAndKeepsTheFirst) {
  const Room& room = furnished_room();
  ScanProject project = room.project;
  Eigen::Matrix<double, 6, 1> off;
  off << 0.05, -0.06, 0.04, 0.03, -0.02, 0.03;
  for (std::size_t i = 0; i < 4; ++i) {
    project.scans[i].world_from_scan =
        i == 0 ? room.truth[0] : room.truth[i] * exp_se3((i % 2 == 0 ? 1 : -1) * off);
  }
  RegisterScansOptions options;
  options.refinement.max_distance = 0.4;
  const RegisterScansResult result = register_scans(project, options);
  EXPECT_TRUE(result.from_given);
  EXPECT_EQ(result.anchor, 0U);
  EXPECT_TRUE(is_near_pose(project.scans[0].world_from_scan, room.truth[0], 1e-12, 1e-12));
  expect_truth(room, project, result);
}

RigidTransform leaning(double angle) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX())), {}};
}

TEST(RegisterScans, KeepsHeadsUprightWhenToldSo) {
  const Room& room = furnished_room();
  ScanProject project = room.project;
  project.scans[3].cloud = transformed(project.scans[3].cloud, leaning(1e-4));
  ScanProject free = project;
  RegisterScansOptions options;
  options.motion.kind = ScanStand::kUpright;
  options.motion.angle_sigma = 4e-5;
  const RegisterScansResult result = register_scans(project, options);
  const RegisterScansResult other = register_scans(free);
  expect_truth(room, project, result);
  // What is known beforehand weighs as a measurement does: the head is drawn upright, not set so.
  const auto lean = [](const ScanProject& p, std::size_t a) {
    const Eigen::Quaterniond turn =
        p.scans[a].world_from_scan.rotation.conjugate() * p.scans[3].world_from_scan.rotation;
    return (turn * Eigen::Vector3d::UnitZ()).head<2>().norm();
  };
  ASSERT_NE(other.anchor, 3U);
  EXPECT_NEAR(lean(free, other.anchor), 1e-4, 5e-5);
  EXPECT_LT(lean(project, result.anchor), 0.95 * lean(free, other.anchor));
}

TEST(RegisterScans, RefusesAHeadThatLeansWhereAllAreSaidToStandUpright) {
  const Room& room = furnished_room();
  ScanProject project;
  project.scans = {room.project.scans[0], room.project.scans[1], room.project.scans[3]};
  project.scans[2].cloud = transformed(project.scans[2].cloud, leaning(3 * kDegree));
  ScanProject free = project;
  EXPECT_EQ(register_scans(free).placed, 3U);
  RegisterScansOptions options;
  options.motion.kind = ScanStand::kUpright;
  const RegisterScansResult result = register_scans(project, options);
  EXPECT_EQ(result.placed, 2U);
  EXPECT_FALSE(result.scans[2].placed);
  EXPECT_NE(result.scans[2].reason.find("does not keep to the motion"), std::string::npos)
      << result.scans[2].reason;
}

TEST(RegisterScans, RefusesByNameWhatHoldsNoSurfaceOrIsGivenTwice) {
  const Room& room = furnished_room();
  ScanProject project;
  project.scans = {room.project.scans[0], room.project.scans[1], room.project.scans[0]};
  project.scans[2].name = "copy";
  PosedCloud empty;
  empty.name = "empty";
  project.scans.push_back(empty);
  PosedCloud line;
  line.name = "line";
  for (int k = 0; k < 100; ++k) line.cloud.points.emplace_back(0.01F * static_cast<float>(k), 0, 0);
  project.scans.push_back(line);
  const RegisterScansResult result = register_scans(project);
  EXPECT_EQ(result.placed, 2U);
  EXPECT_NE(result.scans[2].reason.find("same points as scan 'station1'"), std::string::npos);
  EXPECT_NE(result.scans[3].reason.find("no points"), std::string::npos);
  EXPECT_NE(result.scans[4].reason.find("line"), std::string::npos);
}

TEST(RegisterScans, SaysWhyThereIsNothingToRegister) {
  const Room& room = furnished_room();
  ScanProject one;
  one.scans = {room.project.scans[0]};
  EXPECT_NE(error_of([&] { register_scans(one); }).find("expected two scans"), std::string::npos);
  one.scans.emplace_back();
  one.scans.back().name = "hollow";
  EXPECT_NE(error_of([&] { register_scans(one); }).find("'hollow': it has no points"),
            std::string::npos);
}

TEST(RegisterScans, PlacesNoneOfScansThatLieApart) {
  const Room& room = furnished_room();
  ScanProject project;
  project.scans = {room.project.scans[0], room.project.scans[1]};
  project.scans[1].world_from_scan.translation.x() = 50;
  const RegisterScansResult result = register_scans(project);
  EXPECT_EQ(result.placed, 0U);
  EXPECT_NE(result.scans[1].reason.find("overlaps no other"), std::string::npos);
  EXPECT_EQ(project.scans[1].world_from_scan.translation.x(), 50);
}

TEST(ScanMotion, WeighsLeanAndHeightAlone) {
  ScanMotion table;
  table.kind = ScanStand::kTable;
  table.axis = {0, 2, 0};
  const auto pose = [](double lean, double turn, const Eigen::Vector3d& shift) {
    const Eigen::AngleAxisd about_axis(turn, Eigen::Vector3d::UnitY());
    const Eigen::AngleAxisd over(lean, Eigen::Vector3d::UnitX());
    return RigidTransform{Eigen::Quaterniond(over * about_axis), shift};
  };
  EXPECT_TRUE(table.allows(pose(0, 2.5, {1, 0, -3})));
  EXPECT_TRUE(table.allows(pose(0.02, 2.5, {1, 0.004, -3})));
  EXPECT_FALSE(table.allows(pose(0.03, 2.5, {1, 0, -3})));
  EXPECT_FALSE(table.allows(pose(0, 2.5, {1, 0.006, -3})));
  const RigidTransform off = pose(0.01, 2.5, {1, 0.002, -3});
  const PoseEdge edge = table.as_edge(1, 0, off);
  const auto twist = log_se3(off * edge.to_from_from.inverse());
  // Two standard deviations of each: chi2 is 4 + 4 (the lean also lifts the far end a little).
  EXPECT_NEAR(
      twist.tail<3>().dot(edge.information.bottomRightCorner<3, 3>() * twist.tail<3>()), 4, 1e-6);
  table.axis.setZero();
  EXPECT_NE(error_of([&] { table.check(); }).find("axis"), std::string::npos);
}

}  // namespace
}  // namespace facula
