// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>
#include <facula/reconstruct/register/pan_tilt_list.hpp>

#include <cstddef>

namespace facula {

struct TiltZeroOptions {
  double largest = 0.35;         ///< farthest from 0 that is looked at [rad], at most pi/4
  double step = 0.05;            ///< of the first look [rad], above 0
  double min_share = 0.05;       ///< of the points that a wall must hold [0..1]
  double max_off_square = 0.26;  ///< planes nearer than this to square or parallel are [rad]
  PlaneExtractionOptions planes = {.min_points = 100, .max_planes = 5, .iterations = 500};

  void check() const;
};

/// What must be added to every tilt of a scan.
struct TiltZero {
  Measured tilt_zero;            ///< sigma from how well the pairs of planes agree, NaN for one
                                 ///< pair, which always agrees with itself [rad]
  std::size_t pairs = 0;         ///< of planes that were asked to be square or parallel [1]
  double off_square_before = 0;  ///< root mean square over the pairs, with no correction [rad]
  double off_square = 0;         ///< the same with it [rad]
  double on_planes_before = 0;   ///< share of the points on the four largest planes [0..1]
  double on_planes = 0;          ///< the same with it [0..1]
};

/// Finds the zero of the tilt axis by asking that the walls, floor and ceiling of the scanned room
/// be square: first the zero that puts most points on few planes (a wrong one makes cones of
/// planes), then least squares over the angles of the planes. Deterministic. Throws Error when no
/// two planes are found that could be square, or when the planes' angles do not tell the tilt.
TiltZero find_tilt_zero(const PanTiltList& list, const TiltZeroOptions& options = {});

}  // namespace facula
