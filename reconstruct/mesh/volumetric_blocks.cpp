// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/brick_blocks.hpp>
#include <facula/reconstruct/mesh/distance_volume.hpp>
#include <facula/reconstruct/mesh/range_surface.hpp>
#include <facula/reconstruct/mesh/surface_extraction.hpp>
#include <facula/reconstruct/mesh/volumetric_blocks.hpp>
#include <facula/reconstruct/mesh/volumetric_scale.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

namespace facula {
namespace {

constexpr double kShareOfVoxels = 0.25;  // of max_memory; lists and mesh take the rest

/// Numbers of the vertices on borders between blocks, by brick and edge.
class BorderVertices {
 public:
  /// The number given to that edge before, or `next`.
  std::uint32_t find_or_add(const CrossedEdge& edge, std::uint32_t next) {
    for (const auto& [name, vertex] : of_brick_[brick_key(edge.brick)]) {
      if (name == edge.edge) return vertex;
    }
    of_brick_[brick_key(edge.brick)].emplace_back(edge.edge, next);
    return next;
  }

 private:
  std::unordered_map<std::uint64_t, std::vector<std::pair<std::uint16_t, std::uint32_t>>> of_brick_;
};

/// Whether a cell of another block has this edge too: it lies on the block's lower or upper side.
bool on_border(const CrossedEdge& edge, const BrickBox& own) {
  const int axis = edge.edge % 3;
  const int voxel = edge.edge / 3;
  const Eigen::Vector3i at =
      kBrickSide * edge.brick + Eigen::Vector3i(voxel & 7, voxel >> 3 & 7, voxel >> 6);
  for (int d = 0; d < 3; ++d) {
    if (d == axis) continue;
    if (at[d] == kBrickSide * own.low[d] || at[d] == kBrickSide * (own.high[d] + 1)) return true;
  }
  return false;
}

/// The bricks of all scans, and for every scan the box of its own.
struct SceneBricks {
  std::vector<BrickPlace> places;  ///< each once
  std::vector<BrickBox> of_scan;   ///< low above high where a scan has none
};

class BlockMerge {
 public:
  BlockMerge(const ScanSource& source, const MeshPieceSink& sink, const VolumetricOptions& options)
      : source_(source), sink_(sink), options_(options) {}

  BlockMergeResult run() {
    choose_voxel();
    const SceneBricks scene = find_bricks();
    const double most_bricks = kShareOfVoxels * options_.max_memory / sizeof(Brick);
    const auto most =
        static_cast<std::size_t>(std::clamp(most_bricks, 1.0, static_cast<double>(kMostBricks)));
    const std::vector<BrickBlock> blocks = split_into_blocks(scene.places, most);
    for (const BrickBlock& block : blocks) {
      merge_block(block, scene);
      if (options_.progress) options_.progress(result_.blocks, blocks.size());
    }
    return result_;
  }

 private:
  RangeSurface load_surface(std::size_t scan) {
    ++result_.loads;
    return range_surface(source_.load(scan), range_surface_options(options_));
  }

  DistanceVolumeOptions volume_options() const {
    return {.voxel = result_.voxel,
            .truncation = result_.truncation,
            .max_memory = options_.max_memory,
            .box = std::nullopt,
            .num_threads = options_.num_threads};
  }

  void choose_voxel() {
    std::vector<double> steps;
    for (std::size_t i = 0; i < source_.count && options_.voxel <= 0; ++i) {
      const RangeSurface surface = load_surface(i);
      steps.push_back(surface.triangles.empty() ? 0 : surface.step);
    }
    const VolumetricScale scale = volumetric_scale(options_, steps);
    result_.voxel = scale.voxel;
    result_.truncation = scale.truncation;
  }

  SceneBricks find_bricks() {
    SceneBricks scene;
    std::vector<std::uint64_t> all;
    for (std::size_t i = 0; i < source_.count; ++i) {
      const std::vector<std::uint64_t> keys = bricks_of(load_surface(i), volume_options());
      constexpr int kFar = std::numeric_limits<int>::max();
      BrickBox box{BrickPlace::Constant(kFar), BrickPlace::Constant(-kFar)};
      for (const std::uint64_t key : keys) {
        box.low = box.low.cwiseMin(brick_place(key));
        box.high = box.high.cwiseMax(brick_place(key));
      }
      scene.of_scan.push_back(box);
      std::vector<std::uint64_t> both;
      std::set_union(all.begin(), all.end(), keys.begin(), keys.end(), std::back_inserter(both));
      all = std::move(both);
      require(static_cast<double>(kBytesPerPlace * all.size()) <= options_.max_memory,
              "voxels of ",
              1e3 * result_.voxel,
              " mm are so many that ",
              1e-9 * options_.max_memory,
              " GB do not hold their places; take larger voxels or allow more");
    }
    require(!all.empty(), "none of the ", source_.count, " scans has a surface to merge");
    for (const std::uint64_t key : all) scene.places.push_back(brick_place(key));
    result_.bricks = all.size();
    return scene;
  }

  void merge_block(const BrickBlock& block, const SceneBricks& scene) {
    DistanceVolumeOptions volume_of_block = volume_options();
    volume_of_block.box = block.needed;
    DistanceVolume volume(volume_of_block);
    for (std::size_t i = 0; i < source_.count; ++i) {
      const BrickBox& scan = scene.of_scan[i];
      const bool meets = (scan.low.array() <= block.needed.high.array()).all() &&
                         (scan.high.array() >= block.needed.low.array()).all();
      if (meets) volume.add(load_surface(i));
    }
    ++result_.blocks;
    result_.largest_block = std::max(result_.largest_block, volume.size());
    hand_over(
        extract_surface(volume, {.cells_from = block.own, .num_threads = options_.num_threads}),
        block.own);
  }

  /// Gives the block's vertices their numbers in the whole mesh.
  void hand_over(const ExtractedSurface& surface, const BrickBox& own) {
    std::vector<Eigen::Vector3f> fresh;
    std::vector<std::uint32_t> number(surface.mesh.vertices.size());
    require(result_.vertices + number.size() < std::numeric_limits<std::int32_t>::max(),
            "the mesh has more than 2^31 vertices; take larger voxels");
    for (std::size_t v = 0; v < number.size(); ++v) {
      const auto next = static_cast<std::uint32_t>(result_.vertices);
      number[v] =
          on_border(surface.edges[v], own) ? border_.find_or_add(surface.edges[v], next) : next;
      if (number[v] != next) continue;
      fresh.push_back(surface.mesh.vertices[v]);
      ++result_.vertices;
    }
    std::vector<TriangleMesh::Triangle> triangles = surface.mesh.triangles;
    for (TriangleMesh::Triangle& triangle : triangles) {
      for (std::uint32_t& corner : triangle) corner = number[corner];
    }
    result_.triangles += triangles.size();
    sink_(fresh, triangles);
  }

  const ScanSource& source_;
  const MeshPieceSink& sink_;
  const VolumetricOptions& options_;
  BorderVertices border_;
  BlockMergeResult result_;
};

}  // namespace

BlockMergeResult merge_volumetric_in_blocks(const ScanSource& source,
                                            const MeshPieceSink& sink,
                                            const VolumetricOptions& options) {
  options.check();
  return BlockMerge(source, sink, options).run();
}

}  // namespace facula
