// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/ready_scans.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/reconstruct/register/scan_network.hpp>

namespace facula {

/// Holds every scan of the network against all others and refuses those that do not stand the
/// check. Fills what the result says of scans, from its edges and the network.
void check_placements(const ReadyScans& scans,
                      const ScanNetwork& network,
                      int num_threads,
                      RegisterScansResult& result);

}  // namespace facula
