// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/map_resample.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace facula {
namespace {

/// 1 GB of memory where every one holds one value.
constexpr double kMaxBricks = 1U << 25;

/// Bricks that are held at once: about 9 MB.
constexpr std::size_t kBatch = 4096;

/// Slack of a border, for rounding [cells].
constexpr double kSlack = 1e-6;

/// The target bricks, from..to per axis, that may have a cell with its middle in a box.
struct BrickRange {
  std::array<int, 3> from{};
  std::array<int, 3> to{};  // exclusive

  double count() const {
    double bricks = 1;
    for (std::size_t i = 0; i < 3; ++i) bricks *= std::max(0, to[i] - from[i]);
    return bricks;
  }
};

BrickRange bricks_over(const Eigen::AlignedBox3d& box, double resolution) {
  BrickRange range;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double centre = kCentreKey - 0.5;
    const double low = std::ceil(box.min()[axis] / resolution + centre - kSlack);
    const double high = std::floor(box.max()[axis] / resolution + centre + kSlack);
    if (high < 0 || low > kKeyLimit - 1 || high < low) return {};
    range.from[i] = static_cast<int>(std::max(low, 0.0)) / kBrickEdge;
    range.to[i] = static_cast<int>(std::min(high, kKeyLimit - 1.0)) / kBrickEdge + 1;
  }
  return range;
}

Eigen::AlignedBox3d box_of_brick(std::uint64_t code,
                                 double resolution,
                                 const RigidTransform& pose) {
  const Eigen::Vector3d low = centre_of(first_cell(code), resolution).array() - 0.5 * resolution;
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    box.extend(pose * (low + kBrickEdge * resolution * side));
  }
  return box;
}

/// Codes of the target bricks that the map may reach, ascending.
std::vector<std::uint64_t> reached_bricks(const OccupancyMap& source, const ResampleGrid& grid) {
  std::vector<std::uint64_t> codes;
  double count = 0;
  for (const LogOddsMap::Entry* entry : source.bricks().sorted()) {
    const BrickRange range = bricks_over(
        box_of_brick(entry->code, source.resolution(), grid.target_from_source), grid.resolution);
    count += range.count();
    require(count <= kMaxBricks,
            "the map would fill more than ",
            static_cast<std::size_t>(kMaxBricks),
            " bricks of 8 x 8 x 8 cells of ",
            grid.resolution,
            " m; take larger cells");
    for (int z = range.from[2]; z < range.to[2]; ++z) {
      for (int y = range.from[1]; y < range.to[1]; ++y) {
        for (int x = range.from[0]; x < range.to[0]; ++x) {
          codes.push_back(brick_code({x * kBrickEdge, y * kBrickEdge, z * kBrickEdge}));
        }
      }
    }
  }
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  return codes;
}

/// Looks cells up that mostly lie in the brick of the one before.
class CellLookup {
 public:
  explicit CellLookup(const OccupancyMap& map) : map_(map) {}

  std::optional<float> operator()(const Eigen::Vector3d& x) {
    const auto cell = cell_of(x, map_.resolution());
    if (!cell) return std::nullopt;
    const std::uint64_t code = brick_code(*cell);
    if (code != code_) {
      code_ = code;
      brick_ = map_.bricks().find(code);
      if (brick_ != nullptr) known_ = brick_->read(values_);
    }
    const std::size_t place = cell_in_brick(*cell);
    if (brick_ == nullptr || !known_.test(place)) return std::nullopt;
    return values_[place];
  }

 private:
  const OccupancyMap& map_;
  std::uint64_t code_ = ~std::uint64_t{0};
  const LogOddsBrick* brick_ = nullptr;
  CellMask known_;
  LogOddsBrick::Values values_{};
};

ResampledBrick sample_brick(const OccupancyMap& source,
                            double resolution,
                            const RigidTransform& source_from_target,
                            std::uint64_t code) {
  ResampledBrick result{.code = code, .known = {}};
  CellLookup lookup(source);
  const Eigen::Matrix3d turn = source_from_target.rotation.toRotationMatrix();
  const CellKey first = first_cell(code);
  for (std::size_t place = 0; place < kCellsPerBrick; ++place) {
    const Eigen::Vector3d centre = centre_of(cell_at(first, place), resolution);
    const auto value = lookup(turn * centre + source_from_target.translation);
    if (!value) continue;
    result.known.set(place);
    result.values[place] = *value;
  }
  return result;
}

void check(const ResampleGrid& grid) {
  const RigidTransform& pose = grid.target_from_source;
  require(pose.translation.allFinite() && pose.rotation.coeffs().allFinite(),
          "the pose of one map to the other is not finite");
  require(grid.resolution > 0, "a cell's edge must be above 0 m, got ", grid.resolution);
}

bool is_whole(double x) {
  return std::abs(x - std::round(x)) <= kSlack;
}

}  // namespace

void for_each_resampled(const OccupancyMap& source,
                        const ResampleGrid& grid,
                        const std::function<void(const ResampledBrick&)>& visit) {
  check(grid);
  const std::vector<std::uint64_t> codes = reached_bricks(source, grid);
  const RigidTransform source_from_target = grid.target_from_source.inverse();
  std::vector<ResampledBrick> batch;
  for (std::size_t first = 0; first < codes.size(); first += kBatch) {
    const auto part = std::span(codes).subspan(first, std::min(kBatch, codes.size() - first));
    batch.resize(part.size());
    const auto sample = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        batch[i] = sample_brick(source, grid.resolution, source_from_target, part[i]);
      }
    };
    parallel_for(part.size(), sample, {.num_threads = grid.num_threads, .chunk = 64});
    for (const ResampledBrick& brick : batch) {
      if (!brick.known.none()) visit(brick);
    }
  }
}

bool fits_cells(const OccupancyMap& source, const ResampleGrid& grid) {
  const Eigen::Matrix3d turn = grid.target_from_source.rotation.toRotationMatrix();
  const Eigen::Vector3d shift = grid.target_from_source.translation / grid.resolution;
  // How far a turn takes the farthest cell from the middle of another.
  const Eigen::Matrix3d off = (turn - turn.array().round().matrix()) * kCentreKey;
  return source.resolution() == grid.resolution && off.cwiseAbs().maxCoeff() <= 0.1 &&
         is_whole(shift.x()) && is_whole(shift.y()) && is_whole(shift.z());
}

}  // namespace facula
