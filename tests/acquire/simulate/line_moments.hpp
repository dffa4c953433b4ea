// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/frame_renderer.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>

#include <algorithm>
#include <cmath>

namespace facula {

struct Moments {
  double sum = 0;       // [DN px]
  double position = 0;  // [px]
  double variance = 0;  // [px^2]
};

// Of the light in columns [first, last) of a row of one channel.
inline Moments moments(const Image<double>& image, int r, int first = 0, int last = 1 << 20) {
  Moments m;
  last = std::min(last, image.cols);
  for (int c = first; c < last; ++c) m.sum += image.row(r)[c];
  for (int c = first; c < last; ++c) m.position += c * image.row(r)[c] / m.sum;
  for (int c = first; c < last; ++c) {
    m.variance += std::pow(c - m.position, 2) * image.row(r)[c] / m.sum;
  }
  return m;
}

inline Image<double> light_on_wall(const Rig& rig,
                                   const SimulateOptions& options,
                                   double depth = 2.0) {
  const Scene scene = scene_with({wall_at(depth)});
  return FrameRenderer(scene, rig, options).expected_signal({}, true);
}

}  // namespace facula
