// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/distance_field.hpp>
#include <facula/map/distance_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr std::int32_t kStaysUnknown = std::numeric_limits<std::int32_t>::min();
constexpr double kBytesPerMegabyte = 1e6;

CellBox chosen_box(const OccupancyMap& map, const DistanceFieldOptions& options) {
  if (options.box) {
    for (std::size_t i = 0; i < 3; ++i) {
      require(options.box->low[i] >= 0 && options.box->low[i] <= options.box->high[i] &&
                  options.box->high[i] < kKeyLimit,
              "DistanceFieldOptions: expected a box of cells between 0 and ",
              kKeyLimit - 1,
              " whose lower corner is not above its upper one, got ",
              options.box->low[i],
              " to ",
              options.box->high[i]);
    }
    return *options.box;
  }
  const auto known = known_box(map);
  require(known.has_value(),
          "expected a map with at least one known cell to take distances in, got an empty one; "
          "insert a scan or give a box");
  return *known;
}

void require_size(const CellBox& box, std::size_t max_memory) {
  double diagonal_squared = 0;
  for (std::size_t i = 0; i < 3; ++i) diagonal_squared += std::pow(box.size(i), 2);
  require(diagonal_squared <= std::pow(kLongestDiagonal, 2),
          "expected a box of at most ",
          kLongestDiagonal,
          " cells from corner to corner for a distance field, got ",
          std::ceil(std::sqrt(diagonal_squared)),
          "; choose a smaller box, of the field or of the rays that make the map, or larger cells");
  const std::size_t needed = DistanceField::memory_needed(box);
  require(needed <= max_memory,
          "expected a distance field of at most ",
          static_cast<double>(max_memory) / kBytesPerMegabyte,
          " MB, but ",
          box.size(0),
          " x ",
          box.size(1),
          " x ",
          box.size(2),
          " cells need ",
          static_cast<double>(needed) / kBytesPerMegabyte,
          " MB; choose a smaller box, of the field or of the rays that make the map, larger cells, "
          "or allow more memory");
}

std::int32_t limit_in_cells(double max_distance, double resolution) {
  if (max_distance <= 0) return kBeyond - 1;
  // A limit of three cells means three cells, however 3 * resolution / resolution is rounded.
  const double cells = max_distance / resolution * (1 + 1e-12);
  return static_cast<std::int32_t>(std::min<double>(cells * cells, kBeyond - 1));
}

}  // namespace

void DistanceFieldOptions::check() const {
  require(std::isfinite(max_distance) && max_distance >= 0,
          "DistanceFieldOptions: expected max_distance of 0 m (no limit) or more, got ",
          max_distance);
}

std::size_t DistanceField::memory_needed(const CellBox& box) {
  return box.cells() * sizeof(std::int32_t) + ObstacleBits::memory_needed(box);
}

DistanceField::DistanceField(const OccupancyMap& map, const DistanceFieldOptions& options)
    : resolution_(map.resolution()) {
  options.check();
  box_ = chosen_box(map, options);
  require_size(box_, options.max_memory);
  const bool limited = options.max_distance > 0;
  limit_ = limited ? options.max_distance : std::numeric_limits<double>::infinity();
  const ObstacleBits obstacles(map, box_, options.unknown, options.num_threads);
  squared_ = signed_squared_distances(
      obstacles, limit_in_cells(options.max_distance, resolution_), options.num_threads);
  if (options.unknown == UnknownCells::kUnknown) mark_unknown(map, options.num_threads);
}

void DistanceField::mark_unknown(const OccupancyMap& map, int num_threads) {
  const auto rows = static_cast<std::size_t>(box_.size(1)) * static_cast<std::size_t>(box_.size(2));
  const auto columns = static_cast<std::size_t>(box_.size(0));
  const auto mark = [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      CellKey cell = {box_.low[0],
                      box_.low[1] + static_cast<int>(row) % box_.size(1),
                      box_.low[2] + static_cast<int>(row) / box_.size(1)};
      std::int32_t* line = squared_.data() + row * columns;
      for (; cell[0] <= box_.high[0]; cell[0] = (cell[0] | (kBrickEdge - 1)) + 1) {
        const LogOddsBrick* brick = map.bricks().find(brick_code(cell));
        const CellMask known = brick == nullptr ? CellMask() : brick->known();
        const int last = std::min(cell[0] | (kBrickEdge - 1), box_.high[0]);
        for (CellKey each = cell; each[0] <= last; ++each[0]) {
          if (!known.test(cell_in_brick(each))) line[each[0] - box_.low[0]] = kStaysUnknown;
        }
      }
    }
  };
  parallel_for(rows, mark, {.num_threads = num_threads, .chunk = 64});
}

double DistanceField::distance(std::int32_t squared) const {
  if (squared == kStaysUnknown) return std::numeric_limits<double>::quiet_NaN();
  const double sign = squared < 0 ? -1 : 1;
  const double size = sign * squared;
  return sign * (size >= kBeyond ? limit_ : std::min(limit_, resolution_ * std::sqrt(size)));
}

double DistanceField::at(const CellKey& cell) const {
  if (!box_.contains(cell)) return std::numeric_limits<double>::quiet_NaN();
  return distance(squared_[box_.index(cell)]);
}

std::optional<std::int32_t> DistanceField::squared_cells(const CellKey& cell) const {
  if (!box_.contains(cell)) return std::nullopt;
  const std::int32_t squared = squared_[box_.index(cell)];
  if (squared == kStaysUnknown || squared == kBeyond || squared == -kBeyond) return std::nullopt;
  return squared;
}

std::optional<DistanceField::Sample> DistanceField::sample(const Eigen::Vector3d& x) const {
  const auto holder = cell_of(x, resolution_);
  if (!holder || !box_.contains(*holder)) return std::nullopt;
  std::array<std::size_t, 3> step = {0, 0, 0};  // to the next cell, 0 where the box ends
  std::array<double, 3> part = {0, 0, 0};       // of the way to that cell's centre
  CellKey low = box_.low;
  for (std::size_t i = 0; i < 3; ++i) {
    const double centre_to_x = x[static_cast<Eigen::Index>(i)] / resolution_ + kCentreKey - 0.5;
    const double inside = std::clamp<double>(centre_to_x, box_.low[i], box_.high[i]);
    if (box_.size(i) == 1) continue;
    low[i] = std::min(static_cast<int>(inside), box_.high[i] - 1);
    part[i] = inside - low[i];
    const auto nx = static_cast<std::size_t>(box_.size(0));
    step[i] = i == 0 ? 1 : i == 1 ? nx : nx * static_cast<std::size_t>(box_.size(1));
  }
  const std::size_t first = box_.index(low);
  std::array<double, 8> corner{};
  for (std::size_t c = 0; c < 8; ++c) {
    const std::size_t place =
        first + (c & 1) * step[0] + (c >> 1 & 1) * step[1] + (c >> 2 & 1) * step[2];
    corner[c] = distance(squared_[place]);
    if (std::isnan(corner[c])) return std::nullopt;
    // Without a limit a field is infinite everywhere or nowhere.
    if (std::isinf(corner[c])) return Sample{corner[c], Eigen::Vector3d::Zero()};
  }
  const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
  const auto& [u, v, w] = part;
  const auto& d = corner;
  const std::array<double, 4> in_x = {
      mix(d[0], d[1], u), mix(d[2], d[3], u), mix(d[4], d[5], u), mix(d[6], d[7], u)};
  const double low_z = mix(in_x[0], in_x[1], v);
  const double high_z = mix(in_x[2], in_x[3], v);
  Sample sample;
  sample.distance = mix(low_z, high_z, w);
  sample.gradient = {mix(mix(d[1] - d[0], d[3] - d[2], v), mix(d[5] - d[4], d[7] - d[6], v), w),
                     mix(in_x[1] - in_x[0], in_x[3] - in_x[2], w),
                     high_z - low_z};
  sample.gradient /= resolution_;
  return sample;
}

std::size_t DistanceField::memory_usage() const {
  return sizeof *this + squared_.capacity() * sizeof(std::int32_t);
}

}  // namespace facula
