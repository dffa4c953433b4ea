// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/register/feature_matches.hpp>

#include <algorithm>

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

namespace facula {

struct FeatureTree::Impl {
  using Tree = flann::KDTreeSingleIndex<flann::L2<float>>;

  std::vector<FpfhFeature> features;
  std::vector<std::uint32_t> keys;
  std::unique_ptr<Tree> tree;
};

FeatureTree::FeatureTree(const std::vector<FpfhFeature>& features,
                         const std::vector<std::uint32_t>& keys)
    : impl_(std::make_unique<Impl>()) {
  impl_->keys = keys;
  impl_->features.reserve(keys.size());
  for (const std::uint32_t key : keys) impl_->features.push_back(features.at(key));
  if (keys.empty()) return;
  const flann::Matrix<float> rows(impl_->features.front().data(), keys.size(), kFpfhBins);
  impl_->tree =
      std::make_unique<Impl::Tree>(rows, flann::KDTreeSingleIndexParams(12, /*reorder=*/true));
  impl_->tree->buildIndex();
}

FeatureTree::~FeatureTree() = default;
FeatureTree::FeatureTree(FeatureTree&&) noexcept = default;
FeatureTree& FeatureTree::operator=(FeatureTree&&) noexcept = default;

std::size_t FeatureTree::size() const {
  return impl_->keys.size();
}

std::vector<std::uint32_t> FeatureTree::nearest(const FpfhFeature& query, int k) const {
  const std::size_t count = std::min(size(), static_cast<std::size_t>(std::max(0, k)));
  if (count == 0) return {};
  flann::KNNSimpleResultSet<float> found(count);
  const flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED, 0.0F, true);
  impl_->tree->findNeighbors(found, query.data(), exact);
  std::vector<std::size_t> indices(found.size());
  std::vector<float> distances(found.size());
  found.copy(indices.data(), distances.data(), found.size());
  std::vector<std::uint32_t> points;
  points.reserve(indices.size());
  for (const std::size_t index : indices) points.push_back(impl_->keys[index]);
  return points;
}

}  // namespace facula
