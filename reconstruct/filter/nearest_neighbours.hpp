// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A k-d tree over points. Points that are not finite are passed over. Queries are const and may
/// run from several threads. What they find is exact and the same on every machine: squared
/// distances are (dx^2 + dy^2) + dz^2 in single precision, and of equally near points the one with
/// the lower index comes first.
class NearestNeighbours {
 public:
  /// num_threads: of the building, 0 = all cores.
  explicit NearestNeighbours(const std::vector<Eigen::Vector3f>& points, int num_threads = 0);
  ~NearestNeighbours();
  NearestNeighbours(NearestNeighbours&&) noexcept;
  NearestNeighbours& operator=(NearestNeighbours&&) noexcept;

  struct Neighbour {
    std::size_t index = 0;       ///< of the point [1]
    float squared_distance = 0;  ///< [m^2]
  };

  /// Points in the tree: those that are finite.
  std::size_t size() const;

  /// The (up to) k nearest points, nearest first; none for a query that is not finite.
  std::vector<Neighbour> nearest(const Eigen::Vector3f& query, int k) const;

  /// The same into the caller's buffer, whose length is k; returns how many were found.
  std::size_t nearest(const Eigen::Vector3f& query, std::span<Neighbour> found) const;

  /// The nearest point; the tree must not be empty.
  Neighbour nearest(const Eigen::Vector3f& query) const;

  /// All points at most `radius` [m] away (0 or more), nearest first.
  std::vector<Neighbour> within(const Eigen::Vector3f& query, float radius) const;

  /// Takes the index of a point and its (up to) k nearest points of the cloud, itself among them,
  /// in no particular order (but the same one each time).
  using NeighbourBody = std::function<void(std::size_t, std::span<const Neighbour>)>;

  /// Calls body(i, neighbours of point i) once for every finite point, in the order of the tree,
  /// where near points follow each other, and from several threads at once.
  void for_all_nearest(int k, const NeighbourBody& body, int num_threads = 0) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace facula
