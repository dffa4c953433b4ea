// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/ready_scans.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/reconstruct/register/scan_network.hpp>

#include <vector>

namespace facula {

/// Holds every scan of the network against all others and gives up scans until no two that stay
/// contradict each other: their edges are refused, and scans.refusals says why. `scatter` [m]: 1
/// standard deviation of the scans about the surfaces they share, where poses were given and that
/// is known; 0 = below their sampling.
void drop_contradicted(const ScanNetwork& network,
                       double scatter,
                       int num_threads,
                       ReadyScans& scans,
                       std::vector<ScanEdge>& edges);

/// Fills what the result says of scans, from its edges and the network.
void describe_placements(const ReadyScans& scans,
                         const ScanNetwork& network,
                         RegisterScansResult& result);

}  // namespace facula
