// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/geometric_median.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>

#include <algorithm>

namespace facula {

Eigen::VectorXd geometric_median(const std::vector<Eigen::VectorXd>& votes,
                                 const std::vector<double>& weights) {
  require(!votes.empty() && votes.size() == weights.size(),
          "expected at least one vote and a weight for each");
  // From the medians of the coordinates, which no minority can drag away either.
  Eigen::VectorXd centre(votes.front().size());
  for (Eigen::Index d = 0; d < centre.size(); ++d) {
    std::vector<double> values;
    values.reserve(votes.size());
    for (const Eigen::VectorXd& v : votes) values.push_back(v[d]);
    centre[d] = median(values);
  }
  for (int round = 0; round < 100; ++round) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(centre.size());
    double weight_sum = 0;
    for (std::size_t i = 0; i < votes.size(); ++i) {
      // Bounded below so that a vote at the centre does not take all the weight.
      const double distance = std::max((votes[i] - centre).norm(), 1e-9);
      sum += weights[i] / distance * votes[i];
      weight_sum += weights[i] / distance;
    }
    const Eigen::VectorXd next = sum / weight_sum;
    const double step = (next - centre).norm();
    centre = next;
    if (step < 1e-10) break;
  }
  return centre;
}

}  // namespace facula
