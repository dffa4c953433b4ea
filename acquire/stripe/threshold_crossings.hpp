// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>
#include <vector>

namespace facula {

/// The mean of the first and the last pixel at or above a threshold, to a whole pixel each: steps
/// of 1/2 px (source D, "horizontal thresholding"). The threshold is half the row's own height over
/// its surroundings, so that none has to be set.
std::unique_ptr<RowDetector> make_one_threshold(double sigma);

/// The mean of the four such pixels at one and two thirds of the height: steps of 1/4 px (source
/// D).
std::unique_ptr<RowDetector> make_two_thresholds(double sigma);

/// Variance [px^2] of a sum of steps of 1/N px at N places of a pixel about the straight line they
/// follow, for a line anywhere in the pixel: 1/12 where all steps coincide, 1/(12 N^2) where they
/// are spread evenly. Only the fractions of the places count; they are sorted here.
double step_variance(std::vector<double> places);

}  // namespace facula
