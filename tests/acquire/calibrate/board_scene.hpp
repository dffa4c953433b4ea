// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/rig/camera.hpp>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {

/// Passes when the text holds the part; shows the text otherwise.
inline testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in: " << text;
}

/// Passes when one of the texts holds the part.
inline testing::AssertionResult one_says(const std::vector<std::string>& texts,
                                         const std::string& part) {
  std::string all;
  for (const std::string& text : texts) {
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    all += "\n  " + text;
  }
  return testing::AssertionFailure() << "'" << part << "' is in none of:" << all;
}

/// A camera of VGA size with some distortion.
inline Camera vga_camera() {
  return {.width = 640,
          .height = 480,
          .fx = 700,
          .fy = 702,
          .cx = 325,
          .cy = 236,
          .k1 = -0.08,
          .k2 = 0.05,
          .p1 = 0.001,
          .p2 = -0.0008};
}

/// Place i of a board: tilted by 30 degrees to all sides, between 0.3 and 0.5 m away, all over the
/// image.
inline RigidTransform board_place(const Board& board, int i) {
  const auto corners = board.outline(0);
  const Eigen::Vector3d middle = 0.5 * (corners[0] + corners[2]);
  const double turn = 2.4 * i;
  const double z = 0.3 + 0.02 * (i * 7 % 11);
  const Eigen::Vector3d centre(0.15 * z * std::cos(1.3 * i), 0.1 * z * std::sin(2.1 * i + 1), z);
  RigidTransform pose;
  pose.rotation = Eigen::Quaterniond(
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(std::cos(turn), std::sin(turn), 0)));
  pose.translation = centre - pose.rotation * middle;
  return pose;
}

/// The points of a board as the camera sees them, with noise.
inline BoardView seen_board(const Board& board,
                            const Camera& camera,
                            const RigidTransform& camera_from_board,
                            double noise,
                            Random& random) {
  BoardView view;
  view.image_width = camera.width;
  view.image_height = camera.height;
  view.ids.resize(board.size());
  std::iota(view.ids.begin(), view.ids.end(), 0);
  for (const int id : view.ids) {
    const Eigen::Vector2d shake(random.normal(), random.normal());
    view.pixels.emplace_back(camera.project(camera_from_board * board.point(id)) + noise * shake);
  }
  return view;
}

}  // namespace facula
