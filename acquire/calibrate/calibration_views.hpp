// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_calibration.hpp>
#include <facula/acquire/stripe/channel.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace facula {

/// One [[views]] of a calibration.toml: views of one board that were taken the same way.
struct ViewGroup {
  std::string where;                ///< how complaints name it
  std::filesystem::path folder;     ///< from which picture patterns count
  std::size_t board = 0;            ///< [1]
  std::filesystem::path corners;    ///< .csv; empty: looked for in the pictures
  std::filesystem::path lines;      ///< .csv; may be empty
  std::filesystem::path positions;  ///< .csv; empty: held by hand
  std::string pictures;             ///< pattern; may be empty
  std::string lit;    ///< pattern of the same views with the laser on; empty: the same
  std::string laser;  ///< which laser the pictures show; empty: none
  Channel channel = Channel::kRedExcess;
  double line_sigma = 2;  ///< width of the line in the pictures, standard deviation [px]
};

/// Reads the views of all groups into the set. `camera` helps to find lines in pictures; none: it
/// is calibrated from the corners. Throws Error naming file and line, or picture.
void read_views(const std::vector<ViewGroup>& groups,
                const std::optional<Camera>& camera,
                CalibrationSet& set);

}  // namespace facula
