// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/range_design.hpp>

#include <cmath>

namespace facula {

double RangeDesign::nearest() const {
  return fs / (width * pixel_size);
}

double RangeDesign::resolution(double distance) const {
  return pixel_size * spot_precision * distance * distance / fs;
}

double RangeDesign::distance_of(double resolution) const {
  return std::sqrt(resolution * fs / (pixel_size * spot_precision));
}

double RangeDesign::fs_for(double resolution, double distance) const {
  return pixel_size * spot_precision * distance * distance / resolution;
}

double RangeDesign::fs_for_nearest(double distance) const {
  return distance * width * pixel_size;
}

double RangeDesign::laser_angle(double focal_length) const {
  return std::atan(focal_length / (0.5 * width * pixel_size));
}

void RangeDesign::check() const {
  require(fs > 0 && std::isfinite(fs),
          "expected focal length times baseline above 0 mm2, got ",
          1e6 * fs);
  require(pixel_size > 0 && pixel_size < 1e-3,
          "expected a pixel of 0 to 1000 um, got ",
          1e6 * pixel_size);
  require(width > 0, "expected a picture wider than 0 px, got ", width);
  require(spot_precision > 0 && std::isfinite(spot_precision),
          "expected a spot precision above 0 px, got ",
          spot_precision);
}

}  // namespace facula
