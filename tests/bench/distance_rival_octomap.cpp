// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/distance_rival_octomap.hpp>

#include <dynamicEDT3D/dynamicEDTOctomap.h>
#include <octomap/OcTree.h>

namespace facula {
namespace {

octomap::OcTreeKey tree_key(const CellKey& cell) {
  return {static_cast<octomap::key_type>(cell[0]),
          static_cast<octomap::key_type>(cell[1]),
          static_cast<octomap::key_type>(cell[2])};
}

}  // namespace

struct DistanceRival::State {
  octomap::OcTree tree{1.0};
  std::unique_ptr<DynamicEDTOctomap> field;
};

DistanceRival::DistanceRival(const std::filesystem::path& map) : state_(std::make_unique<State>()) {
  state_->tree.readBinary(map.string());
}

DistanceRival::~DistanceRival() = default;

void DistanceRival::compute(const CellBox& box, double max_distance) {
  octomap::OcTree& tree = state_->tree;
  state_->field.reset();
  state_->field = std::make_unique<DynamicEDTOctomap>(static_cast<float>(max_distance),
                                                      &tree,
                                                      tree.keyToCoord(tree_key(box.low)),
                                                      tree.keyToCoord(tree_key(box.high)),
                                                      false);
  state_->field->update();
}

std::int32_t DistanceRival::squared_cells(const CellKey& cell) const {
  const octomap::point3d centre = state_->tree.keyToCoord(tree_key(cell));
  return state_->field->getSquaredDistanceInCells(centre);
}

}  // namespace facula
