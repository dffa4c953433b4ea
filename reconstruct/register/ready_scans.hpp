// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/global_features.hpp>
#include <facula/reconstruct/register/register_scans.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace facula {

/// The scans of a project made ready for pairs, once each.
struct ReadyScans {
  std::vector<std::optional<ScanPyramid>> pyramids;     ///< none for a scan that is of no use
  std::vector<std::optional<GlobalFeatures>> features;  ///< for the search from nothing
  std::vector<std::string> refusals;                    ///< why a scan is of no use, else empty
  std::vector<std::size_t> order;                       ///< usable scans by name, not as given

  /// All pairs (source, target) of usable scans; the target comes first in `order`.
  std::vector<std::pair<std::size_t, std::size_t>> pairs() const;
};

/// Throws Error when fewer than two scans can be used.
ReadyScans ready_scans(const ScanProject& project, const RegisterScansOptions& options);

/// Adds what the search from nothing needs.
void add_features(ReadyScans& scans, const RegisterScansOptions& options);

/// Share of source points that lie within `distance` of a target point, both at their coarsest
/// level, or of target points near the source: the greater of the two [0..1].
double rough_overlap(const ScanPyramid& source,
                     const ScanPyramid& target,
                     const RigidTransform& target_from_source,
                     double distance);

}  // namespace facula
