// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <string>
#include <vector>

namespace facula {

struct DeviationHistogramOptions {
  double largest = 1e-3;  ///< the axis runs a quarter beyond it to both sides [m], above 0
  double sigma = 0;       ///< of the normal distribution drawn over it [m], 0 = none
  int width = 640;        ///< of the plot area [px]
  int height = 240;       ///< of the plot area [px]
  std::string label = "distance from plane";  ///< of the axis, without the unit
};

/// How often which signed distance [m] occurs, with mean, standard deviation and largest values
/// below. Values that are not finite are left out.
Image8 deviation_histogram(const std::vector<float>& distances,
                           const DeviationHistogramOptions& options);

}  // namespace facula
