// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/parallel.hpp>

#include <array>
#include <filesystem>
#include <vector>

namespace facula {

/// The board in every picture, in the order of the files.
inline std::vector<BoardView> find_all(const Board& board,
                                       const std::vector<std::filesystem::path>& files) {
  std::vector<BoardView> views(files.size());
  parallel_for(files.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   views[i] =
                       find_board(read_image(files[i]).view(), board, files[i].filename().string());
                 }
               },
               {.chunk = 1});
  return views;
}

/// Where a located board lies, as the laser calibration takes it.
inline BoardPose pose_of(const CalibratedView& located) {
  return {located.camera_from_board,
          located.pose_covariance(std::array{0, 1, 5}, std::array{0, 1, 5})};
}

}  // namespace facula
