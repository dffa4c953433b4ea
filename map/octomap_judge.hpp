// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace facula {

/// What liboctomap's own map of the same scans says about ours.
struct OctomapVerdict {
  bool same_ot = false;    ///< every node and value: the bytes of OcTree::write()
  bool same_bt = false;    ///< the bytes of OcTree::writeBinary()
  std::size_t nodes = 0;   ///< of liboctomap's tree [1]
  std::size_t memory = 0;  ///< OcTree::memoryUsage() [bytes]
  double seconds = 0;      ///< liboctomap took to insert the scans [s]
};

/// Builds the map once more, with liboctomap. A scan with one sensor origin goes through
/// OcTree::insertPointCloud(); of one with several, the sets of OcTree::computeUpdate() of every
/// origin are joined, occupied before free, and go through OcTree::updateNode().
class OctomapJudge {
 public:
  explicit OctomapJudge(const OccupancyOptions& options);
  ~OctomapJudge();
  OctomapJudge(OctomapJudge&&) noexcept;
  OctomapJudge& operator=(OctomapJudge&&) noexcept;

  void insert(const PointCloud& cloud);

  /// Compares with a map of the same scans. Headers are compared by their numbers: liboctomap
  /// writes a resolution with six digits, and so reads another one back.
  OctomapVerdict verdict(const OccupancyMap& map) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace facula
