// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/ready_scans.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/reconstruct/register/scan_network.hpp>

#include <vector>

namespace facula {

/// Moves all scans of the network at once to where the points of all kept pairs fit best, at the
/// finest level: the sum that register_pair() makes small for one pair, over all of them, each by
/// its own noise (as Pulli 1999 and Williams and Bennamoun 2001 register many views). The anchor
/// stays. Covariances stay those of the graph.
void refine_jointly(const ReadyScans& scans,
                    const std::vector<ScanEdge>& edges,
                    const RegisterScansOptions& options,
                    ScanNetwork& network);

}  // namespace facula
