// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/mesh/marching_table.hpp>
#include <facula/reconstruct/mesh/surface_extraction.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr int kEdgesPerBrick = 3 * kBrickVoxels;
constexpr int kWordsPerBrick = kEdgesPerBrick / 64;
constexpr int kSide = kBrickSide + 1;  // a brick's cells reach one voxel into the next bricks
constexpr std::size_t kBricksPerChunk = 32;
constexpr std::uint32_t kNoBrick = std::numeric_limits<std::uint32_t>::max();
// Vertices keep this share of an edge away from its ends: no triangle shrinks to a point.
constexpr float kLeastShare = 0.02F;

/// A brick and those that follow it along x, y and z (bits of the index).
using Neighbours = std::array<std::uint32_t, 8>;

/// Distances of a brick's voxels and of the first layer of the next bricks; NaN = not seen.
using Samples = std::array<float, kSide * kSide * kSide>;

std::size_t sample_index(int x, int y, int z) {
  return static_cast<std::size_t>((z * kSide + y) * kSide + x);
}

class Extraction {
 public:
  Extraction(const DistanceVolume& volume, const SurfaceExtractionOptions& options)
      : volume_(volume),
        options_(options),
        triangles_(volume.size()),
        crossed_(volume.size() * kWordsPerBrick, 0),
        rank_(volume.size() * kWordsPerBrick + 1, 0) {}

  ExtractedSurface run() {
    find_triangles();
    number_vertices();
    place_vertices();
    join_triangles();
    return std::move(surface_);
  }

 private:
  template <typename Body>
  void for_each_brick(const Body& body) const {
    parallel_for(volume_.size(),
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t b = begin; b < end; ++b) body(b);
                 },
                 {.num_threads = options_.num_threads, .chunk = kBricksPerChunk});
  }

  Neighbours neighbours(std::size_t brick) const {
    Neighbours result;
    for (int n = 0; n < 8; ++n) {
      const BrickPlace step(n & 1, n >> 1 & 1, n >> 2 & 1);
      result[static_cast<std::size_t>(n)] =
          volume_.find(volume_.place(brick) + step).value_or(kNoBrick);
    }
    return result;
  }

  Samples samples(const Neighbours& bricks) const {
    Samples result;
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          const int n = (x >> 3) | (y >> 3) << 1 | (z >> 3) << 2;
          const std::uint32_t brick = bricks[static_cast<std::size_t>(n)];
          float& value = result[sample_index(x, y, z)];
          value = NAN;
          if (brick == kNoBrick) continue;
          const VoxelSum& sum = volume_.brick(brick)[voxel_index(x & 7, y & 7, z & 7)];
          if (sum.weight > 0) value = sum.distance / sum.weight;
        }
      }
    }
    return result;
  }

  /// Bits of the corners below zero; 0 where no surface is to be drawn.
  std::uint8_t inside_corners(const Samples& sample, int x, int y, int z) const {
    std::array<float, 8> value;
    unsigned inside = 0;
    for (int c = 0; c < 8; ++c) {
      const float d = sample[sample_index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2 & 1))];
      if (std::isnan(d)) return 0;
      value[static_cast<std::size_t>(c)] = d;
      if (d < 0) inside |= 1U << c;
    }
    if (inside == 0 || inside == 255) return 0;
    for (const CellEdge& edge : cell_edges()) {
      const float a = value[static_cast<std::size_t>(edge.from)];
      const float b = value[static_cast<std::size_t>(edge.from | 1 << edge.axis)];
      if ((a < 0) != (b < 0) && std::abs(a - b) > options_.max_jump) return 0;
    }
    return static_cast<std::uint8_t>(inside);
  }

  void find_triangles() {
    cell_triangles(0);
    for_each_brick([&](std::size_t b) {
      if (options_.cells_from && !options_.cells_from->holds(volume_.place(b))) return;
      const Neighbours bricks = neighbours(b);
      const Samples sample = samples(bricks);
      for (int z = 0; z < kBrickSide; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
          for (int x = 0; x < kBrickSide; ++x) {
            const std::uint8_t inside = inside_corners(sample, x, y, z);
            for (const auto& corners : cell_triangles(inside)) {
              TriangleMesh::Triangle edges;
              for (std::size_t i = 0; i < 3; ++i) {
                edges[i] = edge_name(bricks, cell_edges()[corners[i]], {x, y, z});
              }
              triangles_[b].push_back(edges);
            }
          }
        }
      }
    });
  }

  /// The number of a voxel edge over all bricks.
  static std::uint32_t edge_name(const Neighbours& bricks,
                                 const CellEdge& edge,
                                 const Eigen::Vector3i& cell) {
    const int x = cell.x() + (edge.from & 1);
    const int y = cell.y() + (edge.from >> 1 & 1);
    const int z = cell.z() + (edge.from >> 2 & 1);
    const int n = (x >> 3) | (y >> 3) << 1 | (z >> 3) << 2;
    const auto in_brick = static_cast<std::uint32_t>(3 * voxel_index(x & 7, y & 7, z & 7)) +
                          static_cast<std::uint32_t>(edge.axis);
    return bricks[static_cast<std::size_t>(n)] * kEdgesPerBrick + in_brick;
  }

  void number_vertices() {
    for (const auto& list : triangles_) {
      for (const TriangleMesh::Triangle& triangle : list) {
        for (const std::uint32_t e : triangle) crossed_[e / 64] |= std::uint64_t{1} << e % 64;
      }
    }
    for (std::size_t w = 0; w < crossed_.size(); ++w) {
      rank_[w + 1] = rank_[w] + static_cast<std::uint32_t>(std::popcount(crossed_[w]));
    }
  }

  std::uint32_t vertex_of(std::uint32_t e) const {
    const std::uint64_t before = crossed_[e / 64] & ((std::uint64_t{1} << e % 64) - 1);
    return rank_[e / 64] + static_cast<std::uint32_t>(std::popcount(before));
  }

  void place_vertices() {
    surface_.mesh.vertices.resize(rank_.back());
    surface_.edges.resize(rank_.back());
    for_each_brick([&](std::size_t b) {
      std::uint32_t vertex = rank_[b * kWordsPerBrick];
      if (vertex == rank_[(b + 1) * kWordsPerBrick]) return;
      const Samples sample = samples(neighbours(b));
      for (int e = 0; e < kEdgesPerBrick; ++e) {
        const std::uint64_t word = crossed_[b * kWordsPerBrick + static_cast<std::size_t>(e / 64)];
        if ((word >> e % 64 & 1) == 0) continue;
        surface_.mesh.vertices[vertex] = crossing(sample, volume_.place(b), e);
        surface_.edges[vertex] = {volume_.place(b), static_cast<std::uint16_t>(e)};
        ++vertex;
      }
    });
  }

  Eigen::Vector3f crossing(const Samples& sample, const BrickPlace& place, int e) const {
    const int axis = e % 3;
    const int v = e / 3;
    Eigen::Vector3i low(v & 7, v >> 3 & 7, v >> 6);
    Eigen::Vector3i high = low;
    ++high[axis];
    const float a = sample[sample_index(low.x(), low.y(), low.z())];
    const float b = sample[sample_index(high.x(), high.y(), high.z())];
    const float share = std::clamp(a / (a - b), kLeastShare, 1 - kLeastShare);
    Eigen::Vector3d at = (kBrickSide * place + low).cast<double>();
    at[axis] += static_cast<double>(share);
    return (volume_.options().voxel * at).cast<float>();
  }

  void join_triangles() {
    std::size_t count = 0;
    std::vector<std::size_t> first(volume_.size());
    for (std::size_t b = 0; b < volume_.size(); ++b) {
      first[b] = count;
      count += triangles_[b].size();
    }
    surface_.mesh.triangles.resize(count);
    for_each_brick([&](std::size_t b) {
      std::size_t t = first[b];
      for (const auto& [i, j, k] : triangles_[b]) {
        surface_.mesh.triangles[t++] = {vertex_of(i), vertex_of(j), vertex_of(k)};
      }
    });
  }

  const DistanceVolume& volume_;
  const SurfaceExtractionOptions& options_;
  std::vector<std::vector<TriangleMesh::Triangle>> triangles_;  ///< of edge names, by brick
  std::vector<std::uint64_t> crossed_;                          ///< one bit per voxel edge
  std::vector<std::uint32_t> rank_;                             ///< crossed edges before each word
  ExtractedSurface surface_;
};

}  // namespace

ExtractedSurface extract_surface(const DistanceVolume& volume,
                                 const SurfaceExtractionOptions& options) {
  static_assert(kMostBricks <= std::numeric_limits<std::uint32_t>::max() / kEdgesPerBrick);
  return Extraction(volume, options).run();
}

}  // namespace facula
