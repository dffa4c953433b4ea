// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/fpfh_features.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace facula {

/// Two points whose surroundings look alike.
struct FeatureMatch {
  std::uint32_t source = 0;  ///< index of the source point [1]
  std::uint32_t target = 0;  ///< index of the target point [1]

  bool operator==(const FeatureMatch&) const = default;
};

/// Features made ready for searching. Exact (FLANN); queries may run from several threads.
class FeatureTree {
 public:
  /// Of the features at `keys`, which must be finite.
  FeatureTree(const std::vector<FpfhFeature>& features, const std::vector<std::uint32_t>& keys);
  ~FeatureTree();
  FeatureTree(FeatureTree&&) noexcept;
  FeatureTree& operator=(FeatureTree&&) noexcept;

  /// Points (entries of `keys`) with the (up to) k nearest features, nearest first.
  std::vector<std::uint32_t> nearest(const FpfhFeature& query, int k) const;

  std::size_t size() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace facula
