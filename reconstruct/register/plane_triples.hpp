// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/pose_candidates.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// The large planes of a scan, largest first, normals to the side that was seen, from a level of
/// the pyramid that has some thousand points. None where planes do not make up two fifths of the
/// scan: it is no room. Zero threads means all cores.
std::vector<Plane> room_planes(const ScanPyramid& scan, int num_threads);

struct PlaneTripleOptions {
  std::uint64_t seed = 1;   ///< of the points by which poses are judged [1]
  double max_angle = 0.09;  ///< by which the angles within two triples may differ [rad]
  int kept = 128;           ///< best poses kept [1]
  int num_threads = 0;      ///< 0 = all cores [1]
};

/// Poses that bring three planes of the source, no two of them parallel, onto three of the target,
/// best first: all such pairs of triples are tried. Empty when either scan has fewer than three.
std::vector<PoseCandidate> plane_triple_candidates(const GlobalFeatures& source,
                                                   const GlobalFeatures& target,
                                                   const PlaneTripleOptions& options);

}  // namespace facula
