// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/point_tree.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace facula {
namespace {

using Neighbour = NearestNeighbours::Neighbour;

Neighbour neighbour_of(NeighbourKey key) {
  return {static_cast<std::uint32_t>(key), std::bit_cast<float>(std::uint32_t(key >> 32U))};
}

/// Room for k keys: on the stack for the k that is usual.
class KeyBuffer {
 public:
  explicit KeyBuffer(std::size_t k) {
    if (k > few_.size()) many_.resize(k);
  }
  NeighbourKey* data() { return many_.empty() ? few_.data() : many_.data(); }

 private:
  std::array<NeighbourKey, 64> few_;
  std::vector<NeighbourKey> many_;
};

std::vector<TreeItem> finite_items(const std::vector<Eigen::Vector3f>& points) {
  require(points.size() < std::numeric_limits<std::uint32_t>::max(),
          "a cloud of ",
          points.size(),
          " points is too large for a search tree; thin it or take it in parts");
  std::vector<TreeItem> items;
  items.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& p = points[i];
    if (p.allFinite()) items.push_back({{p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(i)});
  }
  return items;
}

}  // namespace

struct NearestNeighbours::Impl {
  PointTree tree;
};

NearestNeighbours::NearestNeighbours(const std::vector<Eigen::Vector3f>& points, int num_threads)
    : impl_(std::make_unique<Impl>(Impl{build_point_tree(finite_items(points), num_threads)})) {}
NearestNeighbours::~NearestNeighbours() = default;
NearestNeighbours::NearestNeighbours(NearestNeighbours&&) noexcept = default;
NearestNeighbours& NearestNeighbours::operator=(NearestNeighbours&&) noexcept = default;

std::size_t NearestNeighbours::size() const {
  return impl_->tree.points;
}

std::size_t NearestNeighbours::nearest(const Eigen::Vector3f& query,
                                       std::span<Neighbour> found) const {
  const std::size_t count = std::min(size(), found.size());
  if (count == 0 || !query.allFinite()) return 0;
  KeyBuffer keys(count);
  nearest_keys(impl_->tree, query.data(), count, keys.data());
  std::transform(keys.data(), keys.data() + count, found.begin(), neighbour_of);
  return count;
}

std::vector<Neighbour> NearestNeighbours::nearest(const Eigen::Vector3f& query, int k) const {
  std::vector<Neighbour> found(std::min(size(), static_cast<std::size_t>(std::max(0, k))));
  found.resize(nearest(query, found));
  return found;
}

Neighbour NearestNeighbours::nearest(const Eigen::Vector3f& query) const {
  require(size() > 0, "the nearest of no points was asked for; give at least one");
  require(query.allFinite(), "the nearest point of a query that is not finite was asked for");
  NeighbourKey key = kNoNeighbour;
  nearest_keys(impl_->tree, query.data(), 1, &key);
  return neighbour_of(key);
}

std::vector<Neighbour> NearestNeighbours::within(const Eigen::Vector3f& query, float radius) const {
  require(radius >= 0, "a search radius is ", radius, " m; give a length of 0 or more");
  if (size() == 0 || !query.allFinite()) return {};
  std::vector<NeighbourKey> keys;
  keys_within(impl_->tree, query.data(), radius * radius, keys);
  std::sort(keys.begin(), keys.end());
  std::vector<Neighbour> found(keys.size());
  std::transform(keys.begin(), keys.end(), found.begin(), neighbour_of);
  return found;
}

void NearestNeighbours::for_all_nearest(int k, const NeighbourBody& body, int num_threads) const {
  require(k >= 1, "the ", k, " nearest points were asked for; give at least 1");
  const PointTree& tree = impl_->tree;
  const std::size_t count = std::min(size(), static_cast<std::size_t>(k));
  const auto search = [&](std::size_t begin, std::size_t end) {
    std::vector<NeighbourKey> keys(count * TreeLeaf::kSize);
    std::vector<Neighbour> found(count);
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      nearest_keys_of_leaf(tree, leaf, count, keys.data());
      for (std::size_t i = 0; i < tree.points_in(leaf); ++i) {
        const auto first = keys.begin() + static_cast<std::ptrdiff_t>(i * count);
        std::transform(
            first, first + static_cast<std::ptrdiff_t>(count), found.begin(), neighbour_of);
        body(tree.leaves[leaf].index[i], found);
      }
    }
  };
  parallel_for(tree.leaves.size(), search, {.num_threads = num_threads, .chunk = 64});
}

}  // namespace facula
