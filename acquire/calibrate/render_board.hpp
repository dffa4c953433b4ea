// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/rig/camera.hpp>
#include <facula/acquire/rig/laser_plane.hpp>

#include <cstdint>
#include <vector>

namespace facula {

struct RenderBoardOptions {
  double black = 30;            ///< level of the print [DN]
  double white = 190;           ///< level of the paper [DN]
  double surroundings = 60;     ///< level beside the sheet of paper [DN]
  double blur = 0.7;            ///< of the lens, standard deviation [px]
  double noise = 1;             ///< of a pixel, standard deviation [DN]
  double laser_level = 180;     ///< peak of the red line on white paper, over it [DN]
  double laser_on_black = 0.2;  ///< share of it on the print [1]
  double laser_width = 0.4e-3;  ///< of the line on the board, standard deviation [m]
  int samples = 2;              ///< rays per pixel, along each side [1]
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< 0 = all cores [1]
  void check() const;
};

/// A colour picture of a board as a camera sees it, laser lines on it: per pixel the mean over its
/// area (rays x the exact mean of the print over each ray's share), blurred by a Gaussian, noise
/// added, cut off at 0 and 255. The board is the truth a calibration must find again. Throws Error
/// when the board lies behind the camera.
Image8 render_board(const Board& board,
                    const Camera& camera,
                    const RigidTransform& camera_from_board,
                    const std::vector<LaserPlane>& lasers,
                    const RenderBoardOptions& options = {});

}  // namespace facula
