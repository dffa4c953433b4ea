// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/ready_scans.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/reconstruct/register/scan_edges.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace facula {

/// Scans joined by edges.
struct ScanNetwork {
  std::size_t anchor = 0;       ///< scan of the largest group that stays where it is
  PoseGuesses world_from_scan;  ///< of the largest group
  std::vector<Eigen::Matrix<double, 6, 6>> covariance;  ///< of the same
  Eigen::MatrixXd joint_covariance;  ///< of all poses together; empty after move_anchor()
  double chi2 = 0;
  int degrees_of_freedom = 0;
};

/// Joins the scans by the edges that are kept, gives up those that contradict the others when
/// options.graph is robust (and says so in their verdicts), and solves for the poses of the largest
/// group, whose first scan by name stays. `scan_sigma` is what scans have wrong as a whole, beside
/// the noise that the covariances of pairs tell of: a shift of this size of what both share, and
/// the turn that moves its rim as far [m]. Residuals go to the edges. The order of the scans makes
/// no difference, to the last bit, where their names differ.
ScanNetwork join_scans(const ScanProject& project,
                       std::vector<ScanEdge>& edges,
                       const RegisterScansOptions& options,
                       double scan_sigma);

/// The scan of the network against which the others are known best, by the sum of the variances of
/// their middles; the poses are then as sure as they can be.
std::size_t central_scan(const ReadyScans& scans, const ScanNetwork& network);

/// The first scan of the network in the order of the project.
std::size_t first_scan(const ScanNetwork& network);

/// The network with another scan that stays.
void move_anchor(const ScanProject& project, std::size_t anchor, ScanNetwork& network);

/// The least scan_sigma with which the kept edges' residuals are as large as they should be, by the
/// median: a few bad edges do not count. Between `least` and `most` [m]; `least` where no loop
/// tells.
double fitting_scan_sigma(const ScanProject& project,
                          const std::vector<ScanEdge>& edges,
                          const RegisterScansOptions& options,
                          const std::pair<double, double>& least_most);

}  // namespace facula
