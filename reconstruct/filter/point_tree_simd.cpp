// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/point_tree.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "facula/reconstruct/filter/point_tree_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifdef HWY_TARGET  // below the headers that choose it
#include <facula/reconstruct/filter/point_tree_simd-inl.hpp>
#endif

#if HWY_ONCE
namespace facula {
namespace {

HWY_EXPORT(search_nearest);
HWY_EXPORT(search_nearest_of_leaf);
HWY_EXPORT(search_within);

}  // namespace

void nearest_keys(const PointTree& tree, const float* query, std::size_t k, NeighbourKey* keys) {
  HWY_DYNAMIC_DISPATCH(search_nearest)(tree, query, k, keys);
}

void nearest_keys_of_leaf(const PointTree& tree,
                          std::size_t leaf,
                          std::size_t k,
                          NeighbourKey* keys) {
  HWY_DYNAMIC_DISPATCH(search_nearest_of_leaf)(tree, leaf, k, keys);
}

void keys_within(const PointTree& tree,
                 const float* query,
                 float squared_radius,
                 std::vector<NeighbourKey>& keys) {
  HWY_DYNAMIC_DISPATCH(search_within)(tree, query, squared_radius, keys);
}

}  // namespace facula
#endif
