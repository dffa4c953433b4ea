// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/tests/acquire/calibrate/board_scene.hpp>
#include <facula/tests/acquire/real/board_pictures.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace facula {
namespace {

using std::filesystem::path;

std::vector<path> numbered(const path& folder, const std::string& stem, int from, int to) {
  std::vector<path> files;
  for (int i = from; i <= to; ++i) files.push_back(folder / (stem + std::to_string(i) + ".jpg"));
  return files;
}

const Board kDots{.kind = BoardKind::kCircles, .cols = 7, .rows = 7, .spacing = 0.0375};

TEST(CircleGridSet, GivesThePublishedCamera) {
  FACULA_REQUIRE_REAL_DATA(set, "laser/circlegrid_laser_calib");
  const auto views = find_all(kDots, numbered(set / "calib_picture", "calib", 0, 11));
  const CameraCalibration result = calibrate_camera(kDots, views);
  EXPECT_EQ(result.views.size(), 12U);
  // Parameters.xml of the set's author.
  EXPECT_NEAR(result.camera.fx, 1144.4393, 0.001 * 1144.4);
  EXPECT_NEAR(result.camera.fy, 1142.4883, 0.001 * 1142.5);
  EXPECT_NEAR(result.camera.cx, 916.0594, 0.001 * 916.1);
  EXPECT_NEAR(result.camera.cy, 522.0497, 0.001 * 522.0);
  EXPECT_LE(result.rms, 0.10);
  EXPECT_LT(result.held_out_rms, 0.11);

  // The circles' diameter, 17.5 mm, moves the focal length by less than its own sigma.
  Board sized = kDots;
  sized.circle_diameter = 0.0175;
  const CameraCalibration unbiased = calibrate_camera(sized, views);
  EXPECT_LT(unbiased.rms, result.rms);
  EXPECT_NEAR(unbiased.camera.fx - result.camera.fx, 0.4, 0.2);
}

/// The lit pictures and how one channel sees their line.
struct LitSet {
  Camera camera;
  std::vector<BoardPose> poses;
  std::vector<Image8> lit;
  std::vector<Image8> dark;

  std::vector<LaserLineView> lines(Channel channel, bool with_dark) const {
    std::vector<LaserLineView> found;
    for (std::size_t i = 0; i < lit.size(); ++i) {
      BoardLineOptions options;
      options.stripe.channel = channel;
      options.stripe.direction = StripeDirection::kPerColumn;
      options.stripe.sigma = 3;
      found.push_back(find_line_on_board(lit[i].view(),
                                         with_dark ? dark[i].view() : ImageView8(),
                                         kDots,
                                         camera,
                                         poses[i].camera_from_board,
                                         options));
      found.back().view = i;
    }
    return found;
  }
};

LitSet read_lit_set(const path& set) {
  const auto dark = numbered(set / "calib_picture", "calib", 0, 11);
  const auto lit = numbered(set / "light_picture", "light", 0, 11);
  LitSet read;
  const auto views = find_all(kDots, dark);
  read.camera = calibrate_camera(kDots, views).camera;
  for (std::size_t i = 0; i < dark.size(); ++i) {
    read.poses.push_back(pose_of(locate_board(kDots, views[i], read.camera)));
    read.lit.push_back(read_image(lit[i]));
    read.dark.push_back(read_image(dark[i]));
  }
  return read;
}

/// Places of the same column in both lines: how far apart they are [px].
std::vector<double> gaps(const LaserLineView& a, const LaserLineView& b) {
  std::vector<double> found;
  for (const Eigen::Vector2d& p : a.pixels) {
    for (const Eigen::Vector2d& q : b.pixels) {
      if (p.x() == q.x()) found.push_back(std::abs(p.y() - q.y()));
    }
  }
  return found;
}

/// Why a simple extraction leaves millimetres on this set: on the nearly white paper red is clipped
/// at 255 (it starts at 170), green and blue rise to 254 in the core, and R - max(G, B) has a hole
/// where the line is: the halo on one side is found instead, 5 to 15 px off. Green shows the core.
TEST(CircleGridSet, GivesAFlatSheetWhereTheCoreIsReadInsteadOfItsRedHalo) {
  FACULA_REQUIRE_REAL_DATA(set, "laser/circlegrid_laser_calib");
  const LitSet lit = read_lit_set(set);
  const auto red_excess = lit.lines(Channel::kRedExcess, false);
  const auto green = lit.lines(Channel::kGreen, false);
  const auto difference = lit.lines(Channel::kGreen, true);

  const LaserCalibration halo = calibrate_laser(lit.camera, lit.poses, red_excess);
  const LaserCalibration core = calibrate_laser(lit.camera, lit.poses, green);
  const LaserCalibration best = calibrate_laser(lit.camera, lit.poses, difference);
  RecordProperty("halo_um", static_cast<int>(1e6 * halo.held_out_rms));
  RecordProperty("core_um", static_cast<int>(1e6 * core.held_out_rms));
  RecordProperty("difference_um", static_cast<int>(1e6 * best.held_out_rms));
  EXPECT_GT(halo.held_out_rms, 1.2e-3);
  EXPECT_LT(core.held_out_rms, 0.3e-3);
  EXPECT_LT(best.held_out_rms, 0.12e-3);
  EXPECT_EQ(best.views.size(), 12U);

  // The cause itself: red excess and green do not mark the same place.
  auto apart = gaps(red_excess[3], green[3]);
  ASSERT_GT(apart.size(), 50U);
  std::nth_element(
      apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2), apart.end());
  EXPECT_GT(apart[apart.size() / 2], 4.0);

  // The author's plane, A x + B y + C z = D [mm], fits these points worse than ours does, though
  // it is the same sheet within a quarter of a degree.
  LaserPlane author;
  author.normal = -Eigen::Vector3d(-0.13051671468331907, -6.3959525011364002, 1);
  author.distance = -0.30491858062622839 / author.normal.norm();
  author.normal.normalize();
  if (author.distance < 0) {
    author.distance = -author.distance;
    author.normal = -author.normal;
  }
  EXPECT_LT(std::acos(std::abs(author.normal.dot(best.plane.normal))), 0.35 * M_PI / 180);
  EXPECT_NEAR(author.distance, best.plane.distance, 1e-3);
  double squares = 0;
  double count = 0;
  for (const LaserLineView& line : difference) {
    for (const Eigen::Vector3d& p :
         points_on_board(lit.camera, lit.poses[line.view].camera_from_board, line)) {
      squares += std::pow(author.sheet_distance(p), 2);
      count += 1;
    }
  }
  RecordProperty("author_um", static_cast<int>(1e6 * std::sqrt(squares / count)));
  EXPECT_GT(std::sqrt(squares / count), 2 * best.rms);
}

}  // namespace
}  // namespace facula
