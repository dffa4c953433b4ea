// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/calibrate/joint_calibration.hpp>
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/capture/frame_list.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace facula {
namespace {

/// Every other of the 14 pictures of the chessboard with the line on it: finding a board takes half
/// a second.
void add_chessboard(const std::filesystem::path& folder,
                    const Capture& capture,
                    CalibrationSet& set) {
  BoardLineOptions options;
  options.stripe = capture.stripe;
  const auto files = list_frames(folder, "laser_plane_color/image*.png");
  ASSERT_EQ(files.size(), 14U);
  for (std::size_t f = 0; f < files.size(); f += 2) {
    const auto& file = files[f];
    const Image8 picture = read_image(file);
    JointView view;
    view.points = find_board(picture.view(), set.boards[0], file.filename().string());
    ASSERT_TRUE(view.points.found()) << file << ": " << view.points.failure;
    const Camera& camera = capture.rig.camera;
    const RigidTransform pose = locate_board(set.boards[0], view.points, camera).camera_from_board;
    view.lines = {find_line_on_board(picture.view(), {}, set.boards[0], camera, pose, options)};
    ASSERT_EQ(view.lines[0].failure, "") << file;
    set.views.push_back(std::move(view));
  }
}

/// Pixels of the stripe that the published calibration puts on the table, clear of the pot.
LaserLineView line_on_table(const Capture& capture, std::size_t frame) {
  const Rig& rig = capture.rig;
  const StripeProfile profile =
      detect_stripe(read_image(capture.frames[frame]).view(), {}, capture.stripe);
  LaserLineView line;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    const Eigen::Vector2d pixel(static_cast<double>(profile.position[r]), static_cast<double>(r));
    const auto n = rig.camera.undistort(pixel);
    const auto x = n ? rig.lasers[0].intersect({n->x(), n->y(), 1}) : std::nullopt;
    if (!x) continue;
    const Eigen::Vector3d p = rig.axis.scan_from_camera * *x;
    const double radius = p.head<2>().norm();
    if (std::abs(p.z() + 0.005) > 0.006 || radius < 0.06 || radius > 0.16) continue;
    line.pixels.push_back(pixel);
    line.sigmas.push_back(std::hypot(static_cast<double>(profile.sigma[r]), 0.02));
  }
  return line;
}

/// The published corners of the board on the table, wrong ones and all; the line of every other
/// frame. Pixels there count from 1.
void add_table(const std::filesystem::path& folder, const Capture& capture, CalibrationSet& set) {
  std::map<std::size_t, JointView> views;
  std::ifstream file(folder / "caltag_corners.txt");
  for (std::string text; std::getline(file, text);) {
    std::istringstream words(text);
    std::size_t frame = 0;
    double x = 0;
    double y = 0;
    double u = 0;
    double v = 0;
    if (!(words >> frame >> x >> y >> u >> v) || frame < 1 || frame > 72) continue;
    BoardView& points = views[frame - 1].points;
    points.ids.push_back(static_cast<int>(std::lround(y / 25) * 8 + std::lround(x / 25)));
    points.pixels.emplace_back(u - 1, v - 1);
  }
  for (auto& [frame, view] : views) {
    view.board = 1;
    view.position = capture.positions[frame];
    view.points.name = "frame " + std::to_string(frame + 1);
    if (frame % 2 == 0) view.lines = {line_on_table(capture, frame)};
    if (!view.lines.empty() && view.lines[0].pixels.size() < 20) view.lines.clear();
    set.views.push_back(std::move(view));
  }
}

/// RMS off the best plane of the table's points in the frames whose lines took no part.
double table_rms(const PolarScan& scan, double height) {
  std::vector<Eigen::Vector3d> points;
  for (int col = 1; col < scan.cols; col += 2) {
    for (int row = 0; row < scan.rows; ++row) {
      const std::size_t cell = scan.index(row, col);
      const Eigen::Vector3d p = scan.point[cell].cast<double>();
      if (scan.valid[cell] == 0 || std::abs(p.z() - height) > 0.006) continue;
      if (p.head<2>().norm() > 0.06 && p.head<2>().norm() < 0.16) points.push_back(p);
    }
  }
  double rms = 0;
  // As for the published calibration: what is over 3 RMS is the pot's foot and crumbs.
  for (int round = 0; round < 4; ++round) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto& p : points) centre += p / static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& p : points) scatter += (p - centre) * (p - centre).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    rms = std::sqrt(solver.eigenvalues()[0] / static_cast<double>(points.size() - 3));
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    std::erase_if(points, [&](const Eigen::Vector3d& p) {
      return std::abs(normal.dot(p - centre)) > 3 * rms;
    });
  }
  EXPECT_GT(points.size(), 4000U);
  return rms;
}

TEST(PotSetCalibratedJointly, HasAFlatterTableAndTwoBoardsThatContradict) {
  FACULA_REQUIRE_REAL_DATA(folder, "laser/caltag_turntable_pot");
  Capture capture = read_capture(shipped_data("captures/caltag_turntable_pot"), folder);
  CalibrationSet set;
  set.lasers = {"red"};
  set.axis = AxisKind::kTurntable;
  set.boards.resize(2);
  set.boards[0].cols = 11;
  set.boards[0].rows = 7;
  set.boards[0].spacing = 0.021167;
  set.boards[1].cols = 8;
  set.boards[1].rows = 10;
  set.boards[1].spacing = 0.025;
  add_chessboard(folder, capture, set);
  const std::size_t by_hand = set.views.size();
  add_table(folder, capture, set);
  ASSERT_EQ(set.views.size(), by_hand + 72);

  JointOptions options;
  options.camera = capture.rig.camera;
  options.position_sigma = 0.02;  // the table was turned by hand
  options.folds = 0;
  const JointCalibration result = calibrate_jointly(set, options);
  ASSERT_EQ(result.scales.size(), 1U);
  EXPECT_TRUE(result.scales[0].conflict);
  EXPECT_NEAR(result.scales[0].factor, 1.02, 0.004);
  EXPECT_LT(result.scales[0].sigma, 0.001);
  RecordProperty("scale_ppm", static_cast<int>(result.scales[0].factor * 1e6));

  const double published = table_rms(extract_scan(capture).scan, -0.005);
  capture.rig = result.rig;
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    if (!set.views[v].position) continue;
    capture.positions[v - by_hand] = result.positions[v];
  }
  const double joint = table_rms(extract_scan(capture).scan, 0);
  RecordProperty("table_rms_published_um", static_cast<int>(published * 1e6));
  RecordProperty("table_rms_um", static_cast<int>(joint * 1e6));
  EXPECT_LE(joint, 0.40e-3);
  EXPECT_LT(joint, 0.8 * published);
}

}  // namespace
}  // namespace facula
