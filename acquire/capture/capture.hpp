// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace facula {

/// The part of space that is kept, in the scan frame and along the camera's axis.
struct WorkVolume {
  std::optional<double> max_radius;  ///< distance from the scan frame's z axis [m]
  std::optional<double> min_z;       ///< height in the scan frame [m]
  std::optional<double> max_z;       ///< height in the scan frame [m]
  std::optional<double> min_depth;   ///< depth in the camera frame [m]
  std::optional<double> max_depth;   ///< depth in the camera frame [m]

  bool contains(const Eigen::Vector3d& x_in_scan, double depth) const;
};

/// A run of the same axis programme over the bare bed, frame by frame. Stripes are measured against
/// it, and rows that show bare bed in both runs take out the shift between the runs.
struct ZeroLine {
  std::vector<std::filesystem::path> frames;  ///< one per axis position
  std::vector<std::pair<int, int>> bed_rows;  ///< first and last row of bare bed [px]
  double bed_position = 0;                    ///< where the bed's line should lie [px]
};

/// How frames with and without the laser follow each other in one sequence.
enum class Alternation {
  kNone,     ///< `frames` holds lit frames only
  kOnFirst,  ///< lit, dark, lit, dark, ...
  kOffFirst  ///< dark, lit, dark, lit, ...
};

/// A recorded scan: which rig took it, its frames, and the axis position of every frame.
struct Capture {
  std::filesystem::path file;      ///< the capture.toml it was read from
  std::filesystem::path rig_file;  ///< the rig it names
  Rig rig;
  std::size_t laser = 0;                          ///< index of the sheet that is lit [1]
  std::vector<std::filesystem::path> frames;      ///< images, or one video
  std::vector<std::filesystem::path> background;  ///< laser off; empty, one for all, or one each
  Alternation alternation = Alternation::kNone;
  std::vector<double> positions;  ///< of the axis, one per lit frame [rad or m]
  double frame_interval = 0;      ///< time between positions, 0 = unknown [s]
  StripeOptions stripe;
  WorkVolume volume;
  std::optional<ZeroLine> zero_line;
  RigidTransform world_from_scan;
};

}  // namespace facula
