// SPDX-License-Identifier: GPL-3.0-or-later
// The search of point_tree.hpp for one instruction set. Distances are summed in the same order
// everywhere, without fused multiply-add, so that every set finds the same neighbours to the last
// bit. Boxes are measured in that order too: rounding keeps order, so a box is never taken for
// farther away than a point in it.
#if defined(FACULA_POINT_TREE_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_POINT_TREE_SIMD
#undef FACULA_POINT_TREE_SIMD
#else
#define FACULA_POINT_TREE_SIMD
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The squared distance from a query to a box.
HWY_INLINE float box_distance(const TreeNode& node, const float* query) {
  float square[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float below = node.low[axis] - query[axis];
    const float above = query[axis] - node.high[axis];
    const float outside = below > above ? below : above;
    const float off = outside > 0 ? outside : 0;
    square[axis] = off * off;
  }
  return (square[0] + square[1]) + square[2];
}

/// The squared distances of a leaf's points, and which of them are at most `limit` (a bit each).
HWY_INLINE std::uint32_t leaf_distances(const TreeLeaf& leaf,
                                        const float* query,
                                        float limit,
                                        float* squared) {
  const hn::CappedTag<float, TreeLeaf::kSize> d;
  const auto x = hn::Set(d, query[0]);
  const auto y = hn::Set(d, query[1]);
  const auto z = hn::Set(d, query[2]);
  const auto most = hn::Set(d, limit);
  std::uint32_t near = 0;
  for (std::size_t i = 0; i < TreeLeaf::kSize; i += hn::Lanes(d)) {
    const auto dx = hn::Sub(hn::Load(d, leaf.x + i), x);
    const auto dy = hn::Sub(hn::Load(d, leaf.y + i), y);
    const auto dz = hn::Sub(hn::Load(d, leaf.z + i), z);
    const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    hn::Store(square, d, squared + i);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Le(square, most), bits);
    near |= (std::uint32_t{bits[0]} | std::uint32_t{bits[1]} << 8U) << i;
  }
  return near;
}

HWY_INLINE NeighbourKey key_of(float squared, std::uint32_t index) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &squared, sizeof bits);
  return NeighbourKey{bits} << 32U | index;
}

HWY_INLINE float distance_of(NeighbourKey key) {
  const auto bits = static_cast<std::uint32_t>(key >> 32U);
  float squared = 0;
  std::memcpy(&squared, &bits, sizeof squared);
  return squared;
}

/// The k best keys so far, ascending.
struct BestKeys {
  NeighbourKey* keys;
  std::size_t k;

  HWY_INLINE float worst() const { return distance_of(keys[k - 1]); }

  HWY_INLINE void add(NeighbourKey key) {
    if (key >= keys[k - 1]) return;
    std::size_t at = k - 1;
    for (; at > 0 && keys[at - 1] > key; --at) keys[at] = keys[at - 1];
    keys[at] = key;
  }

  HWY_INLINE float limit() const { return worst(); }
};

/// Every key up to a limit.
struct AllKeys {
  std::vector<NeighbourKey>& keys;
  float most;

  HWY_INLINE void add(NeighbourKey key) { keys.push_back(key); }
  HWY_INLINE float limit() const { return most; }
};

template <typename Keys>
HWY_INLINE void search_leaf(const PointTree& tree,
                            std::size_t leaf,
                            const float* query,
                            Keys& found) {
  HWY_ALIGN float squared[TreeLeaf::kSize];
  const TreeLeaf& points = tree.leaves[leaf];
  std::uint32_t near = leaf_distances(points, query, found.limit(), squared);
  near &= (1U << tree.points_in(leaf)) - 1U;
  for (; near != 0; near &= near - 1) {
    const auto i = static_cast<std::size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(near));
    found.add(key_of(squared[i], points.index[i]));
  }
}

/// Walks the boxes, nearest first, that may hold a key.
template <typename Keys>
HWY_INLINE void search_tree(const PointTree& tree, const float* query, Keys& found) {
  struct Waiting {
    std::uint32_t node;
    float distance;
  };
  Waiting stack[64];  // a node's sibling per level of the tree: 32 at most
  int waiting = 0;
  std::uint32_t at = 0;
  while (true) {
    const TreeNode& node = tree.nodes[at];
    if (node.right != 0) {
      Waiting near{at + 1, box_distance(tree.nodes[at + 1], query)};
      Waiting far{node.right, box_distance(tree.nodes[node.right], query)};
      if (far.distance < near.distance) std::swap(near, far);
      if (far.distance <= found.limit()) stack[waiting++] = far;
      if (near.distance <= found.limit()) {
        at = near.node;
        continue;
      }
    } else {
      search_leaf(tree, node.leaf, query, found);
    }
    do {
      if (waiting == 0) return;
      --waiting;
    } while (stack[waiting].distance > found.limit());
    at = stack[waiting].node;
  }
}

void search_nearest(const PointTree& tree, const float* query, std::size_t k, NeighbourKey* keys) {
  for (std::size_t i = 0; i < k; ++i) keys[i] = kNoNeighbour;
  BestKeys best{keys, k};
  search_tree(tree, query, best);
}

/// Leaves around a leaf, their boxes side by side.
struct NearbyLeaves {
  static constexpr std::size_t kMost = 128;
  alignas(64) float low[3][kMost];
  alignas(64) float high[3][kMost];
  std::uint32_t leaf[kMost];
  std::size_t count = 0;

  /// Gathers the leaves at most sqrt(`limit`) from the box of `around`; false when there are more
  /// than fit.
  bool gather(const PointTree& tree, const TreeNode& around, float limit) {
    std::uint32_t stack[64];
    int waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
      const std::uint32_t at = stack[--waiting];
      const TreeNode& node = tree.nodes[at];
      if (between_boxes(node, around) > limit) continue;
      if (node.right != 0) {
        stack[waiting++] = node.right;
        stack[waiting++] = at + 1;
      } else if (count == kMost) {
        return false;
      } else {
        add(node);
      }
    }
    return true;
  }

 private:
  static float between_boxes(const TreeNode& a, const TreeNode& b) {
    float square[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float below = a.low[axis] - b.high[axis];
      const float above = b.low[axis] - a.high[axis];
      const float outside = below > above ? below : above;
      const float off = outside > 0 ? outside : 0;
      square[axis] = off * off;
    }
    return (square[0] + square[1]) + square[2];
  }

  void add(const TreeNode& node) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis][count] = node.low[axis];
      high[axis][count] = node.high[axis];
    }
    leaf[count++] = node.leaf;
  }
};

/// Neighbours of all points of one leaf. The first point is searched for from the root; a ball
/// around it that holds k points lies within a larger one around each of its neighbours, which
/// bounds their search before it starts.
class LeafSearch {
 public:
  LeafSearch(const PointTree& tree, std::size_t leaf, std::size_t k)
      : tree_(tree), points_(tree.leaves[leaf]), count_(tree.points_in(leaf)), k_(k) {}

  void run(NeighbourKey* keys) {
    float query[3];
    take_point(0, query);
    search_nearest(tree_, query, k_, keys);
    for (float& radius : radius_) radius = INFINITY;
    bound_others(query, distance_of(keys[k_ - 1]));
    TreeNode box;
    const float farthest = put_box(box);
    const bool gathered = nearby_.gather(tree_, box, limit_of(farthest));
    for (std::size_t i = 1; i < count_; ++i) {
      take_point(i, query);
      NeighbourKey* const found = keys + i * k_;
      if (!gathered || !search_nearby(query, limit_of(radius_[i]), found)) {
        search_nearest(tree_, query, k_, found);
      }
      bound_others(query, distance_of(found[k_ - 1]));
    }
  }

 private:
  static constexpr std::size_t kRoom = 256;

  /// Squared, with room for the rounding of every step before.
  static float limit_of(float radius) { return radius * radius * 1.00001F + 1e-36F; }

  void take_point(std::size_t i, float* query) const {
    query[0] = points_.x[i];
    query[1] = points_.y[i];
    query[2] = points_.z[i];
  }

  /// |p_i - q| + r holds k points around p_i when r holds k around q.
  void bound_others(const float* query, float squared_radius) {
    HWY_ALIGN float squared[TreeLeaf::kSize];
    leaf_distances(points_, query, INFINITY, squared);
    const hn::CappedTag<float, TreeLeaf::kSize> d;
    const auto r = hn::Sqrt(hn::Set(d, squared_radius));
    for (std::size_t i = 0; i < TreeLeaf::kSize; i += hn::Lanes(d)) {
      const auto radius = hn::Add(hn::Sqrt(hn::Load(d, squared + i)), r);
      hn::Store(hn::Min(hn::Load(d, radius_ + i), radius), d, radius_ + i);
    }
  }

  /// The box of the points, and the largest of their radii.
  float put_box(TreeNode& box) const {
    float farthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float* const at = axis == 0 ? points_.x : axis == 1 ? points_.y : points_.z;
      box.low[axis] = box.high[axis] = at[0];
      for (std::size_t i = 1; i < count_; ++i) {
        box.low[axis] = std::min(box.low[axis], at[i]);
        box.high[axis] = std::max(box.high[axis], at[i]);
      }
    }
    for (std::size_t i = 0; i < count_; ++i) farthest = std::max(farthest, radius_[i]);
    return farthest;
  }

  /// Which of eight or more leaves from `first` on lie within the limit (a bit each).
  std::uint32_t leaves_within(const float* query, float limit, std::size_t first) const {
    const hn::CappedTag<float, TreeLeaf::kSize> d;
    auto sum = hn::Zero(d);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto q = hn::Set(d, query[axis]);
      const auto below = hn::Sub(hn::Load(d, nearby_.low[axis] + first), q);
      const auto above = hn::Sub(q, hn::Load(d, nearby_.high[axis] + first));
      const auto off = hn::Max(hn::Max(below, above), hn::Zero(d));
      sum = hn::Add(sum, hn::Mul(off, off));
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Le(sum, hn::Set(d, limit)), bits);
    const std::uint32_t near = std::uint32_t{bits[0]} | std::uint32_t{bits[1]} << 8U;
    const std::size_t rest = nearby_.count - first;
    return rest < hn::Lanes(d) ? near & ((1U << rest) - 1U) : near;
  }

  /// The k nearest of the nearby leaves' points within the limit; false when there are too many.
  bool search_nearby(const float* query, float limit, NeighbourKey* found) {
    const hn::CappedTag<float, TreeLeaf::kSize> d;
    std::size_t near = 0;
    for (std::size_t first = 0; first < nearby_.count; first += hn::Lanes(d)) {
      std::uint32_t leaves = leaves_within(query, limit, first);
      for (; leaves != 0; leaves &= leaves - 1) {
        const std::size_t i = first + hwy::Num0BitsBelowLS1Bit_Nonzero32(leaves);
        if (near + TreeLeaf::kSize > kRoom) return false;
        near = add_leaf(nearby_.leaf[i], query, limit, near);
      }
    }
    if (near < k_) return false;
    for (std::size_t i = 0; i < near; ++i) keys_[i] = key_of(squared_[i], index_[i]);
    std::nth_element(keys_, keys_ + (k_ - 1), keys_ + near);
    std::copy(keys_, keys_ + k_, found);
    return true;
  }

  /// Adds the leaf's points within the limit to those gathered; returns how many there are then.
  std::size_t add_leaf(std::uint32_t leaf, const float* query, float limit, std::size_t near) {
    const hn::CappedTag<float, TreeLeaf::kSize> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const TreeLeaf& points = tree_.leaves[leaf];
    const auto x = hn::Set(d, query[0]);
    const auto y = hn::Set(d, query[1]);
    const auto z = hn::Set(d, query[2]);
    const std::size_t count = tree_.points_in(leaf);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const auto dx = hn::Sub(hn::Load(d, points.x + i), x);
      const auto dy = hn::Sub(hn::Load(d, points.y + i), y);
      const auto dz = hn::Sub(hn::Load(d, points.z + i), z);
      const auto square = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      const auto within = hn::And(hn::Le(square, hn::Set(d, limit)), hn::FirstN(d, count - i));
      hn::CompressStore(
          hn::Load(du, points.index + i), hn::RebindMask(du, within), du, index_ + near);
      near += hn::CompressStore(square, within, d, squared_ + near);
    }
    return near;
  }

  const PointTree& tree_;
  const TreeLeaf& points_;
  std::size_t count_;
  std::size_t k_;
  NearbyLeaves nearby_;
  alignas(64) float radius_[TreeLeaf::kSize];
  alignas(64) float squared_[kRoom + 16];
  alignas(64) std::uint32_t index_[kRoom + 16];
  NeighbourKey keys_[kRoom];
};

void search_nearest_of_leaf(const PointTree& tree,
                            std::size_t leaf,
                            std::size_t k,
                            NeighbourKey* keys) {
  LeafSearch(tree, leaf, k).run(keys);
}

void search_within(const PointTree& tree,
                   const float* query,
                   float squared_radius,
                   std::vector<NeighbourKey>& keys) {
  AllKeys all{keys, squared_radius};
  search_tree(tree, query, all);
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif
