// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// A node of a k-d tree: the box around its points. Nodes stand in preorder: the left child of a
/// node follows it.
struct TreeNode {
  float low[3] = {};        ///< [m]
  float high[3] = {};       ///< [m]
  std::uint32_t right = 0;  ///< index of the right child; 0 = a leaf
  std::uint32_t leaf = 0;   ///< index of the leaf, leaves only
};

/// Points that are compared at once. All leaves but the last are full.
struct alignas(64) TreeLeaf {
  static constexpr std::size_t kSize = 16;
  float x[kSize] = {};              ///< [m]
  float y[kSize] = {};              ///< [m]
  float z[kSize] = {};              ///< [m]
  std::uint32_t index[kSize] = {};  ///< of the point in the caller's order
};

/// A k-d tree over points in boxes. Split at the median of the widest side, so that every leaf but
/// the last is full.
struct PointTree {
  std::vector<TreeNode> nodes;
  std::vector<TreeLeaf> leaves;
  std::size_t points = 0;  ///< in the leaves [1]

  std::size_t points_in(std::size_t leaf) const {
    const std::size_t rest = points - leaf * TreeLeaf::kSize;
    return rest < TreeLeaf::kSize ? rest : TreeLeaf::kSize;
  }
};

/// A point to build a tree of.
struct TreeItem {
  float at[3];          ///< finite [m]
  std::uint32_t index;  ///< in the caller's order, below 2^32 - 1
};

PointTree build_point_tree(std::vector<TreeItem> items, int num_threads);

/// A neighbour as one whole number that orders as (distance, index): the bits of a float that is
/// not negative order as the float itself.
using NeighbourKey = std::uint64_t;
constexpr NeighbourKey kNoNeighbour = 0x7F800000FFFFFFFFULL;  // infinitely far, behind every index

/// The `k` nearest points of a query [m] in ascending order; kNoNeighbour fills up what is missing.
/// Squared distances are (dx dx + dy dy) + dz dz in single precision, on every machine.
void nearest_keys(const PointTree& tree, const float* query, std::size_t k, NeighbourKey* keys);

/// The same for all points of a leaf; `keys` has k entries for each.
void nearest_keys_of_leaf(const PointTree& tree,
                          std::size_t leaf,
                          std::size_t k,
                          NeighbourKey* keys);

/// All points at most sqrt(`squared_radius`) [m^2] away, in no order.
void keys_within(const PointTree& tree,
                 const float* query,
                 float squared_radius,
                 std::vector<NeighbourKey>& keys);

}  // namespace facula
