// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A k-d tree over points (FLANN). Queries are const and may run from several threads.
class NearestNeighbours {
 public:
  explicit NearestNeighbours(const std::vector<Eigen::Vector3f>& points);
  ~NearestNeighbours();
  NearestNeighbours(NearestNeighbours&&) noexcept;
  NearestNeighbours& operator=(NearestNeighbours&&) noexcept;

  struct Neighbour {
    std::size_t index = 0;       ///< of the point [1]
    float squared_distance = 0;  ///< [m^2]
  };

  /// The (up to) k nearest points, nearest first.
  std::vector<Neighbour> nearest(const Eigen::Vector3f& query, int k) const;

  /// The nearest point; the tree must not be empty.
  Neighbour nearest(const Eigen::Vector3f& query) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace facula
