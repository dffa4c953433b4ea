// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/voxel_bricks.hpp>

#include <vector>

namespace octomap {
class OcTree;
}

namespace facula {

/// Gives every cell marked as passed one miss and every cell marked as ended one hit. `bricks` must
/// come from VoxelBricks::take_sorted(). The tree is afterwards the one that
/// OcTree::updateNode() cell by cell gives, but every node on the way is visited once instead of
/// once per cell below it.
void update_cells(octomap::OcTree& tree, std::vector<VoxelBrick> bricks);

}  // namespace facula
