// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/measure/unexplained_variance.hpp>

namespace facula {
namespace {

constexpr int kMostSteps = 60;
constexpr double kSettled = 1e-12;  // of the sum, against the degrees of freedom [1]

}  // namespace

double unexplained_variance(const std::vector<double>& squares,
                            const std::vector<double>& variances,
                            std::size_t degrees_of_freedom) {
  const double freedom = static_cast<double>(degrees_of_freedom);
  double added = 0;
  if (degrees_of_freedom == 0) return added;
  // The sum falls and is convex: Newton's steps from 0 never pass the root.
  for (int step = 0; step < kMostSteps; ++step) {
    double sum = 0;
    double slope = 0;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const double share = squares[i] / (variances[i] + added);
      sum += share;
      slope += share / (variances[i] + added);
    }
    if (sum <= freedom * (1 + kSettled)) break;
    added += (sum - freedom) / slope;
  }
  return added;
}

}  // namespace facula
