// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_box.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>

namespace facula {

/// DynamicEDTOctomap of dynamicEDT3D 1.9.7 over a box of a .bt file.
class DistanceRival {
 public:
  explicit DistanceRival(const std::filesystem::path& map);
  ~DistanceRival();

  /// Makes the field anew, as its users do: construct, update(). Distances are cut at max_distance
  /// [m]; unknown cells are free.
  void compute(const CellBox& box, double max_distance);

  /// Squared distance of a cell to the nearest obstacle [cells^2].
  std::int32_t squared_cells(const CellKey& cell) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace facula
