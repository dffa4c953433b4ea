// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>

#include <algorithm>
#include <limits>

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

namespace facula {
namespace {

using Tree = flann::KDTreeSingleIndex<flann::L2_3D<float>>;

/// Keeps the one nearest point; of equally near ones the first in the cloud.
class NearestOne : public flann::ResultSet<float> {
 public:
  bool full() const override { return true; }
  void addPoint(float squared_distance, std::size_t index) override {
    if (squared_distance > best_ || (squared_distance == best_ && index > index_)) return;
    best_ = squared_distance;
    index_ = index;
  }
  float worstDist() const override { return best_; }

  float best() const { return best_; }
  std::size_t index() const { return index_; }

 private:
  float best_ = std::numeric_limits<float>::max();
  std::size_t index_ = std::numeric_limits<std::size_t>::max();
};

flann::SearchParams exact_search() {
  return {flann::FLANN_CHECKS_UNLIMITED, 0.0F, true};
}

}  // namespace

struct NearestNeighbours::Impl {
  std::vector<Eigen::Vector3f> points;  // the finite ones: FLANN does not bear NaN
  std::vector<std::size_t> original;    // their index in the caller's vector
  std::unique_ptr<Tree> tree;
  flann::SearchParams search = exact_search();

  explicit Impl(const std::vector<Eigen::Vector3f>& all) {
    points.reserve(all.size());
    original.reserve(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!all[i].allFinite()) continue;
      points.push_back(all[i]);
      original.push_back(i);
    }
    if (points.empty()) return;
    const flann::Matrix<float> rows(points.front().data(), points.size(), 3);
    tree = std::make_unique<Tree>(rows, flann::KDTreeSingleIndexParams(12, true));
    tree->buildIndex();
  }
};

NearestNeighbours::NearestNeighbours(const std::vector<Eigen::Vector3f>& points)
    : impl_(std::make_unique<Impl>(points)) {}
NearestNeighbours::~NearestNeighbours() = default;
NearestNeighbours::NearestNeighbours(NearestNeighbours&&) noexcept = default;
NearestNeighbours& NearestNeighbours::operator=(NearestNeighbours&&) noexcept = default;

std::vector<NearestNeighbours::Neighbour> NearestNeighbours::nearest(const Eigen::Vector3f& query,
                                                                     int k) const {
  const std::size_t count =
      std::min(impl_->points.size(), static_cast<std::size_t>(std::max(0, k)));
  if (count == 0 || !query.allFinite()) return {};
  flann::KNNSimpleResultSet<float> found(count);
  impl_->tree->findNeighbors(found, query.data(), impl_->search);
  std::vector<std::size_t> indices(count);
  std::vector<float> distances(count);
  found.copy(indices.data(), distances.data(), count);
  std::vector<Neighbour> neighbours(found.size());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    neighbours[i] = {impl_->original[indices[i]], distances[i]};
  }
  return neighbours;
}

NearestNeighbours::Neighbour NearestNeighbours::nearest(const Eigen::Vector3f& query) const {
  require(!impl_->points.empty(), "the nearest of no points was asked for; give at least one");
  require(query.allFinite(), "the nearest point of a query that is not finite was asked for");
  NearestOne found;
  impl_->tree->findNeighbors(found, query.data(), impl_->search);
  return {impl_->original[found.index()], found.best()};
}

}  // namespace facula
