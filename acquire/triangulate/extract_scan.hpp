// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/progress.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace facula {

struct ExtractOptions {
  int num_threads = 0;  ///< 0 = all cores [1]
  Progress progress;    ///< called per frame; may be empty

  /// A stripe log to write while extracting, see docs/stripe_log.md; empty for none. The scan is
  /// then computed from what the log holds.
  std::filesystem::path log;
  bool resume = false;  ///< continue `log` where it is there: only what it lacks is read and added
};

/// What a stripe log holds, and what of it was lost.
struct LogFigures {
  std::uint64_t bytes = 0;          ///< of the file
  std::uint64_t raw_bytes = 0;      ///< of the frames it stands for, as they came from the camera
  std::size_t frames = 0;           ///< that can be used [1]
  std::size_t appended = 0;         ///< of those, added in this run [1]
  std::size_t dropped_records = 0;  ///< damaged within [1]
  std::uint64_t torn_bytes = 0;     ///< behind the last whole record [1]
};

/// What a whole capture gave, and how well.
struct ExtractResult {
  PolarScan scan;
  std::size_t frames = 0;          ///< [1]
  std::size_t rows_searched = 0;   ///< rows of the scan over all frames [1]
  std::size_t stripes_seen = 0;    ///< rows in which a stripe was found [1]
  std::size_t outside_volume = 0;  ///< stripes dropped by the work volume or the geometry [1]
  std::size_t saturated = 0;       ///< stripes with a clipped core [1]
  double median_pixel_sigma = 0;   ///< of the stripes kept [px]
  double median_width = 0;         ///< of the stripes kept, standard deviation [px]
  double median_noise = 0;         ///< of the frames [DN]
  double median_point_sigma = 0;   ///< along the ray, stripe and calibration together [m]
  double median_stripe_sigma = 0;  ///< the stripe's share of it [m]
  /// The calibration's share of it [m]; none where the rig has no covariance: point sigmas then
  /// hold the stripe's share only.
  std::optional<double> median_calibration_sigma;
  std::vector<double> zero_line_shift;  ///< shift between run and reference, per frame [px]
  std::optional<LogFigures> log;        ///< where a stripe log was written or read
};

/// The acquisition on one page: frames -> channel and background -> stripe per row -> ray meets
/// sheet -> axis -> PolarScan. Rows of the scan are image rows (image columns for a stripe that
/// runs per column). The result does not depend on the number of threads. Throws Error when a frame
/// cannot be read or is not of the camera's size, or the capture contradicts itself.
ExtractResult extract_scan(const Capture& capture, const ExtractOptions& options = {});

}  // namespace facula
