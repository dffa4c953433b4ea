// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/range_surface.hpp>

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Voxels are kept in bricks of kBrickSide^3, only where a scan's band runs. Voxel (i, j, k) is the
/// sample at voxel * (i, j, k) in the world frame.
constexpr int kBrickSide = 8;
constexpr int kBrickVoxels = kBrickSide * kBrickSide * kBrickSide;

/// A volume holds so many at most: the edges of their voxels are numbered in 32 bits.
constexpr std::size_t kMostBricks = std::numeric_limits<std::uint32_t>::max() / (3 * kBrickVoxels);

/// The voxels asked for need more memory than allowed: merge_volumetric_in_blocks() takes less.
class VolumeMemoryError : public Error {
  using Error::Error;
};

/// Place of a brick in units of bricks.
using BrickPlace = Eigen::Vector3i;

/// A brick's place as one number, in the order z, y, x; places reach from -2^20 to 2^20 - 1.
std::uint64_t brick_key(const BrickPlace& place);
BrickPlace brick_place(std::uint64_t key);

/// Sums over what the scans say of a voxel. Their quotient is the signed distance [voxels],
/// positive on the scanners' side.
struct VoxelSum {
  float distance = 0;  ///< weight times distance
  float weight = 0;    ///< 0 = not seen
};
using Brick = std::array<VoxelSum, kBrickVoxels>;

/// Index of a voxel in its brick from its place in it.
inline std::size_t voxel_index(int x, int y, int z) {
  return static_cast<std::size_t>((z * kBrickSide + y) * kBrickSide + x);
}

/// Bricks from `low` to `high`, both included.
struct BrickBox {
  BrickPlace low;
  BrickPlace high;
  bool holds(const BrickPlace& place) const {
    return (place.array() >= low.array()).all() && (place.array() <= high.array()).all();
  }
};

struct DistanceVolumeOptions {
  double voxel = 0;             ///< [m]
  double truncation = 0;        ///< half width of the band along the normal [m]
  double max_memory = 3e9;      ///< for bricks and the lists that fill them [byte]
  std::optional<BrickBox> box;  ///< bricks elsewhere are left out
  int num_threads = 0;          ///< 0 = all cores [1]
};

/// Sparse volume of weighted signed distances (Curless and Levoy 1996, equations 3 and 4).
class DistanceVolume {
 public:
  explicit DistanceVolume(const DistanceVolumeOptions& options) : options_(options) {}

  /// Adds one scan. Scans count in the order they are added, triangles in theirs, for every voxel:
  /// the sums do not depend on the number of threads, nor on the box. Throws VolumeMemoryError when
  /// the memory does not suffice, Error when the scan reaches beyond what voxels of this size can
  /// number.
  void add(const RangeSurface& surface);

  std::size_t size() const { return bricks_.size(); }
  const Brick& brick(std::size_t index) const { return bricks_[index]; }
  const BrickPlace& place(std::size_t index) const { return places_[index]; }
  /// Index of the brick there; nothing where no band runs.
  std::optional<std::uint32_t> find(const BrickPlace& place) const;
  const DistanceVolumeOptions& options() const { return options_; }

 private:
  struct Visit {
    std::uint64_t brick;
    std::uint32_t triangle;
  };
  struct BrickList {
    std::uint32_t brick = 0;
    std::size_t begin = 0;  ///< of its triangles in Lists::triangles
    std::size_t end = 0;
  };
  struct Lists {
    std::vector<BrickList> bricks;
    std::vector<std::uint32_t> triangles;
  };
  std::vector<std::vector<Visit>> visits_of(const RangeSurface& surface) const;
  Lists by_brick(const std::vector<std::vector<Visit>>& visits);
  std::uint32_t find_or_add(std::uint64_t key);

  DistanceVolumeOptions options_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
  std::vector<BrickPlace> places_;
  std::deque<Brick> bricks_;
};

/// What a brick costs before it holds voxels: its key in several lists, its place in others [byte].
constexpr std::size_t kBytesPerPlace = 40;

/// Keys of the bricks that the band about a surface meets, each once, in ascending order. Throws
/// Error as DistanceVolume::add() does, where kBytesPerPlace for each are more than max_memory.
std::vector<std::uint64_t> bricks_of(const RangeSurface& surface,
                                     const DistanceVolumeOptions& options);

}  // namespace facula
