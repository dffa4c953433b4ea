// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/mesh/distance_volume.hpp>
#include <facula/reconstruct/mesh/sight_prism.hpp>

#include <algorithm>
#include <atomic>
#include <limits>
#include <sstream>

namespace facula {
namespace {

constexpr int kKeyBits = 21;
constexpr int kKeyOffset = 1 << (kKeyBits - 1);
constexpr std::size_t kTrianglesPerChunk = 4096;
constexpr std::size_t kBricksPerChunk = 16;

[[noreturn]] void fail_for_memory(const DistanceVolumeOptions& options) {
  std::ostringstream sentence;
  sentence << "voxels of " << options.voxel * 1e3
           << " mm about these scans need more memory, where " << options.max_memory * 1e-9
           << " GB are allowed; take larger voxels or allow more";
  throw VolumeMemoryError(sentence.str());
}

/// Counts what the threads list, and stops them where it is more than the memory holds.
class ListedBytes {
 public:
  explicit ListedBytes(const DistanceVolumeOptions& options) : options_(options) {}

  /// Throws where a list of `bytes` beside those that are complete would be too much, and from then
  /// on always: the other threads shall not fill their lists first.
  void expect(double bytes) {
    if (bytes + complete_ <= options_.max_memory) return;
    complete_ = std::numeric_limits<double>::infinity();
    fail_for_memory(options_);
  }

  void complete(std::size_t bytes) {
    expect(static_cast<double>(bytes));
    complete_ += static_cast<double>(bytes);
  }

 private:
  const DistanceVolumeOptions& options_;
  std::atomic<double> complete_{0};
};

void check_extent(const RangeSurface& surface, double voxel) {
  const double most = voxel * (kKeyOffset - 2) * kBrickSide;
  for (const TriangleMesh::Triangle& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) {
      const Eigen::Vector3f& p = surface.vertices[v].point;
      require(p.cwiseAbs().maxCoeff() < most,
              "a point stands ",
              p.cwiseAbs().maxCoeff(),
              " m from the world's origin, where voxels of ",
              voxel * 1e3,
              " mm reach ",
              most,
              " m; take larger voxels or move the scans nearer to the origin");
    }
  }
}

}  // namespace

std::uint64_t brick_key(const BrickPlace& place) {
  const auto part = [](int v) { return static_cast<std::uint64_t>(v + kKeyOffset); };
  return part(place.z()) << (2 * kKeyBits) | part(place.y()) << kKeyBits | part(place.x());
}

BrickPlace brick_place(std::uint64_t key) {
  const auto part = [key](int shift) {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << kKeyBits) - 1;
    return static_cast<int>(key >> shift & kMask) - kKeyOffset;
  };
  return {part(0), part(kKeyBits), part(2 * kKeyBits)};
}

std::optional<std::uint32_t> DistanceVolume::find(const BrickPlace& place) const {
  const auto found = index_.find(brick_key(place));
  if (found == index_.end()) return std::nullopt;
  return found->second;
}

std::uint32_t DistanceVolume::find_or_add(std::uint64_t key) {
  const auto [entry, is_new] = index_.try_emplace(key, static_cast<std::uint32_t>(bricks_.size()));
  if (is_new) {
    const double bytes = static_cast<double>((bricks_.size() + 1) * (sizeof(Brick) + 64));
    if (bytes > options_.max_memory || bricks_.size() >= kMostBricks) fail_for_memory(options_);
    bricks_.emplace_back();
    places_.push_back(brick_place(key));
  }
  return entry->second;
}

/// For every chunk of triangles the bricks they meet, in order.
std::vector<std::vector<DistanceVolume::Visit>> DistanceVolume::visits_of(
    const RangeSurface& surface) const {
  check_extent(surface, options_.voxel);
  const auto truncation = static_cast<float>(options_.truncation / options_.voxel);
  const std::size_t count = surface.triangles.size();
  std::vector<std::vector<Visit>> visits(count / kTrianglesPerChunk + 1);
  ListedBytes listed(options_);
  const auto list = [&](std::size_t begin, std::size_t end) {
    auto& out = visits[begin / kTrianglesPerChunk];
    for (std::size_t t = begin; t < end; ++t) {
      const SightPrism prism(surface, surface.triangles[t], options_.voxel, truncation);
      if (!prism.usable()) continue;
      listed.expect(sizeof(Visit) * (static_cast<double>(out.size()) + prism.bricks_at_most()));
      prism.visit_bricks([&](const BrickPlace& place) {
        if (options_.box && !options_.box->holds(place)) return;
        out.push_back({brick_key(place), static_cast<std::uint32_t>(t)});
      });
    }
    listed.complete(sizeof(Visit) * out.size());
  };
  parallel_for(count, list, {.num_threads = options_.num_threads, .chunk = kTrianglesPerChunk});
  return visits;
}

/// Sorts the visits by brick; within a brick they keep their order.
DistanceVolume::Lists DistanceVolume::by_brick(const std::vector<std::vector<Visit>>& visits) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  Lists lists;
  std::vector<std::uint32_t> list_of_brick;
  std::vector<std::uint32_t> list_of_visit;
  std::uint64_t last_key = ~std::uint64_t{0};
  std::uint32_t list = 0;
  for (const auto& chunk : visits) {
    for (const Visit& visit : chunk) {
      if (visit.brick != last_key) {  // neighbouring triangles mostly meet the same brick
        const std::uint32_t brick = find_or_add(visit.brick);
        list_of_brick.resize(std::max<std::size_t>(list_of_brick.size(), brick + 1), kNone);
        if (list_of_brick[brick] == kNone) {
          list_of_brick[brick] = static_cast<std::uint32_t>(lists.bricks.size());
          lists.bricks.push_back({brick, 0, 0});
        }
        last_key = visit.brick;
        list = list_of_brick[brick];
      }
      ++lists.bricks[list].end;
      list_of_visit.push_back(list);
    }
  }
  std::size_t begin = 0;
  for (BrickList& entry : lists.bricks) {
    const std::size_t count = entry.end;
    entry.begin = entry.end = begin;
    begin += count;
  }
  lists.triangles.resize(list_of_visit.size());
  std::size_t next = 0;
  for (const auto& chunk : visits) {
    for (const Visit& visit : chunk) {
      lists.triangles[lists.bricks[list_of_visit[next++]].end++] = visit.triangle;
    }
  }
  return lists;
}

void DistanceVolume::add(const RangeSurface& surface) {
  const Lists lists = by_brick(visits_of(surface));
  const auto truncation = static_cast<float>(options_.truncation / options_.voxel);
  const auto fill = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const BrickList& list = lists.bricks[i];
      for (std::size_t k = list.begin; k < list.end; ++k) {
        const TriangleMesh::Triangle& triangle = surface.triangles[lists.triangles[k]];
        const SightPrism prism(surface, triangle, options_.voxel, truncation);
        prism.add_to(places_[list.brick], bricks_[list.brick]);
      }
    }
  };
  parallel_for(
      lists.bricks.size(), fill, {.num_threads = options_.num_threads, .chunk = kBricksPerChunk});
}

std::vector<std::uint64_t> bricks_of(const RangeSurface& surface,
                                     const DistanceVolumeOptions& options) {
  check_extent(surface, options.voxel);
  const auto truncation = static_cast<float>(options.truncation / options.voxel);
  const std::size_t count = surface.triangles.size();
  std::vector<std::vector<std::uint64_t>> parts(count / kTrianglesPerChunk + 1);
  ListedBytes listed(options);
  const auto list = [&](std::size_t begin, std::size_t end) {
    auto& out = parts[begin / kTrianglesPerChunk];
    for (std::size_t t = begin; t < end; ++t) {
      const SightPrism prism(surface, surface.triangles[t], options.voxel, truncation);
      if (!prism.usable()) continue;
      const double after = static_cast<double>(out.size()) + prism.bricks_at_most();
      listed.expect(kBytesPerPlace * after);
      prism.visit_bricks([&out](const BrickPlace& place) { out.push_back(brick_key(place)); });
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    listed.complete(kBytesPerPlace * out.size());
  };
  parallel_for(count, list, {.num_threads = options.num_threads, .chunk = kTrianglesPerChunk});
  std::vector<std::uint64_t> keys;
  for (const auto& part : parts) keys.insert(keys.end(), part.begin(), part.end());
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

}  // namespace facula
