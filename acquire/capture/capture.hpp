// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/scan_stand.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/stripe/background_match.hpp>
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

  /// Whether a point is kept; points on a bound are. `depth` is its z in the camera frame [m].
  bool contains(const Eigen::Vector3d& x_in_scan, double depth) const;

  /// Throws Error when nothing would be kept: no radius, or a least value above its greatest.
  void check() const;
};

/// A run of the same axis programme over the bare bed, frame by frame. Stripes are measured against
/// it, and rows that show bare bed in both runs take out the shift between the runs. Rows are image
/// columns for a stripe that runs per column. No background is taken off the bed's frames.
struct ZeroLine {
  std::vector<std::filesystem::path> frames;  ///< lit images, one per axis position
  std::vector<std::pair<int, int>> bed_rows;  ///< first and last row of bare bed, both in [px]
  double bed_position = 0;                    ///< where the bed's line should lie [px]
};

/// How frames with and without the laser follow each other in one sequence. A last frame without
/// its partners is left out. Three frames per position tell what moved: the two of a kind were
/// taken before and after the third, their mean stands for its moment, and where they differ
/// nothing is measured (see moving_pixels.hpp).
enum class Alternation {
  kNone,      ///< `frames` holds lit frames only
  kOnFirst,   ///< lit, dark, lit, dark, ...
  kOffFirst,  ///< dark, lit, dark, lit, ...
  kOnOffOn,   ///< lit, dark, lit of every position: the mean of the lit ones less the dark one
  kOffOnOff   ///< dark, lit, dark of every position: the lit one less the mean of the dark ones
};

/// Frames of one exposure at one position [1]: 1, 2 or 3.
std::size_t frames_per_exposure(Alternation alternation);

/// A recorded scan: which rig took it, its frames, and the axis position of every frame.
struct Capture {
  std::filesystem::path file;      ///< the capture.toml it was read from
  std::filesystem::path rig_file;  ///< the rig it names
  Rig rig;
  std::size_t laser = 0;                      ///< index of the sheet that is lit [1]
  std::vector<std::filesystem::path> frames;  ///< images, or one video
  /// Laser off: empty, one image for all frames, one each, or a video with one each.
  std::vector<std::filesystem::path> background;
  Alternation alternation = Alternation::kNone;
  Flicker flicker = Flicker::kIgnore;  ///< how a background is matched to its frame
  /// Of the frames that follow one another at every position, merged per row (see bracket.hpp);
  /// empty: one frame [ms].
  std::vector<double> exposures;
  std::vector<double> positions;  ///< of the axis, one per position of the head [rad or m]
  double frame_interval = 0;      ///< time between positions, 0 = unknown [s]
  StripeOptions stripe;
  WorkVolume volume;
  std::optional<ZeroLine> zero_line;
  RigidTransform world_from_scan;
  ScanStand stand = ScanStand::kFree;  ///< against other captures that say the same

  std::size_t exposures_per_position() const { return exposures.empty() ? 1 : exposures.size(); }
};

}  // namespace facula
