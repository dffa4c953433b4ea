// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/register/nearest_grid.hpp>

#include <cmath>

namespace facula {
namespace {

constexpr std::size_t kFirstCapacity = 1024;

}  // namespace

NearestGrid::NearestGrid(const std::vector<Eigen::Vector3f>& points, double cell, double reach) {
  require(cell > 0 && std::isfinite(cell), "cell is ", cell, " m; give a length above 0");
  require(reach >= 0 && reach <= 16 * cell, "reach is ", reach, " m; give 0 to 16 cells");
  per_cell_ = static_cast<float>(1 / cell);
  const int span = static_cast<int>(std::ceil(reach / cell));
  const auto limit = static_cast<float>(reach / cell * reach / cell);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint64_t middle = key_of(points[i]);
    if (middle == kEmpty) continue;
    const Eigen::Array3f c = points[i].array() * per_cell_ + kHalf;
    // The point's place in its own cell, against that cell's centre.
    const Eigen::Array3f within = c - c.floor() - 0.5F;
    for (int x = -span; x <= span; ++x) {
      for (int y = -span; y <= span; ++y) {
        for (int z = -span; z <= span; ++z) {
          const Eigen::Array3f step(static_cast<float>(x), static_cast<float>(y), float(z));
          const float distance = (step - within).square().sum();
          if (distance > limit && (x != 0 || y != 0 || z != 0)) continue;
          const Eigen::Array3f there = c.floor() + step;
          if (there.minCoeff() < 0 || there.maxCoeff() >= 2 * kHalf) continue;
          const std::uint64_t key = (static_cast<std::uint64_t>(there.x()) << 42) |
                                    (static_cast<std::uint64_t>(there.y()) << 21) |
                                    static_cast<std::uint64_t>(there.z());
          offer(key, distance, static_cast<std::int32_t>(i));
        }
      }
    }
  }
}

void NearestGrid::offer(std::uint64_t key, float distance, std::int32_t point) {
  if (2 * (used_ + 1) > entries_.size()) grow();
  std::size_t slot = hash(key) & mask_;
  while (entries_[slot].key != kEmpty && entries_[slot].key != key) slot = (slot + 1) & mask_;
  Entry& entry = entries_[slot];
  if (entry.key == kEmpty) {
    entry = {key, distance, point};
    ++used_;
  } else if (distance < entry.distance) {
    entry.distance = distance;
    entry.point = point;
  }
}

void NearestGrid::grow() {
  std::vector<Entry> old = std::move(entries_);
  entries_.assign(old.empty() ? kFirstCapacity : 2 * old.size(), Entry{});
  mask_ = entries_.size() - 1;
  for (const Entry& entry : old) {
    if (entry.key == kEmpty) continue;
    std::size_t slot = hash(entry.key) & mask_;
    while (entries_[slot].key != kEmpty) slot = (slot + 1) & mask_;
    entries_[slot] = entry;
  }
}

}  // namespace facula
