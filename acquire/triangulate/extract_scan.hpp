// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/progress.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace facula {

struct ExtractOptions {
  int num_threads = 0;  ///< 0 = all cores [1]
  Progress progress;    ///< called per frame; may be empty
};

/// What a whole capture gave, and how well.
struct ExtractResult {
  PolarScan scan;
  std::size_t frames = 0;               ///< [1]
  std::size_t rows_searched = 0;        ///< rows of the scan over all frames [1]
  std::size_t stripes_seen = 0;         ///< rows in which a stripe was found [1]
  std::size_t outside_volume = 0;       ///< stripes dropped by the work volume or the geometry [1]
  std::size_t saturated = 0;            ///< stripes with a clipped core [1]
  double median_pixel_sigma = 0;        ///< of the stripes kept [px]
  double median_width = 0;              ///< of the stripes kept, standard deviation [px]
  double median_noise = 0;              ///< of the frames [DN]
  double median_point_sigma = 0;        ///< along the ray [m]
  std::vector<double> zero_line_shift;  ///< shift between run and reference, per frame [px]
};

/// The acquisition on one page: frames -> channel and background -> stripe per row -> ray meets
/// sheet -> axis -> PolarScan. Rows of the scan are image rows (image columns for a stripe that
/// runs per column). The result does not depend on the number of threads. Throws Error when a frame
/// cannot be read or is not of the camera's size, or the capture contradicts itself.
ExtractResult extract_scan(const Capture& capture, const ExtractOptions& options = {});

}  // namespace facula
