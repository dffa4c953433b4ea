// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/cell_colors.hpp>
#include <facula/map/ray_walk.hpp>

#include <algorithm>
#include <bit>
#include <utility>

namespace facula {
namespace {

/// Place of a cell's sum among those of its brick.
std::size_t rank_of(const CellMask& cells, std::size_t cell) {
  std::size_t rank = 0;
  for (std::size_t word = 0; word < cell >> 6; ++word) {
    rank += static_cast<std::size_t>(std::popcount(cells.words[word]));
  }
  const std::uint64_t below = (std::uint64_t{1} << (cell & 63)) - 1;
  return rank + static_cast<std::size_t>(std::popcount(cells.words[cell >> 6] & below));
}

/// The sum of a cell, made where there is none.
ColorSum& sum_of(ColorBrick& brick, std::size_t cell) {
  const auto place = brick.sums.begin() + static_cast<std::ptrdiff_t>(rank_of(brick.cells, cell));
  if (brick.cells.test(cell)) return *place;
  brick.cells.set(cell);
  return *brick.sums.insert(place, ColorSum());
}

/// Forgets cells that no point is left of.
void drop_empty(ColorBrick& brick) {
  CellMask left;
  std::size_t rank = 0;
  for_each_cell(brick.cells, [&](std::size_t cell) {
    if (brick.sums[rank++].count > 0) left.set(cell);
  });
  brick.cells = left;
  std::erase_if(brick.sums, [](const ColorSum& sum) { return sum.count == 0; });
}

bool has(const MapBox& box, const Eigen::Vector3f& x) {
  return (x.array() >= box.min.array()).all() && (x.array() <= box.max.array()).all();
}

/// The cell that a point gives its colour to.
std::optional<CellKey> colored_cell(const PointCloud& cloud,
                                    std::size_t i,
                                    const CastOptions& options) {
  Eigen::Vector3f end = cloud.points[i];
  if (options.discretize) {
    const auto cell = cell_of(end.cast<double>(), options.resolution);
    if (!cell) return std::nullopt;
    end = centre_of(*cell, options.resolution).cast<float>();
  }
  const CellRay ray = make_ray(cloud.sensor_origin[i], end, options.resolution, options.max_range);
  if (!ray.first || !ray.last || ray.cut) return std::nullopt;
  if (options.box && !has(*options.box, ray.end)) return std::nullopt;
  return ray.last;
}

/// A cell's place in space as one number, and a colour there.
struct Colored {
  std::uint64_t place;
  Color color;
};

}  // namespace

Color ColorSum::mean() const {
  if (count == 0) return {};
  const auto part = [&](std::size_t i) {
    return static_cast<std::uint8_t>((2 * sum[i] + count) / (2 * count));
  };
  return {part(0), part(1), part(2)};
}

void ColorSum::add(const ColorSum& more) {
  count += more.count;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more.sum[i];
}

void ColorSum::subtract(const ColorSum& less) {
  count -= std::min(count, less.count);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] -= std::min(sum[i], less.sum[i]);
}

std::vector<ColorBrick> colors_of_scan(const PointCloud& cloud, const CastOptions& options) {
  std::vector<Colored> colored;
  for (std::size_t i = 0; i < cloud.colors.size(); ++i) {
    const auto cell = colored_cell(cloud, i, options);
    if (cell) colored.push_back({brick_code(*cell) << 9 | cell_in_brick(*cell), cloud.colors[i]});
  }
  std::sort(colored.begin(), colored.end(), [](const Colored& a, const Colored& b) {
    return a.place < b.place;
  });
  std::vector<ColorBrick> bricks;
  for (const auto& [place, color] : colored) {
    if (bricks.empty() || bricks.back().code != place >> 9) bricks.emplace_back().code = place >> 9;
    ColorBrick& brick = bricks.back();
    if (!brick.cells.test(place & 511)) brick.sums.emplace_back();
    brick.cells.set(place & 511);
    brick.sums.back().add({1, {color[0], color[1], color[2]}});
  }
  return bricks;
}

void CellColors::add(std::span<const ColorBrick> bricks) {
  for (const ColorBrick& more : bricks) {
    bool added = false;
    const std::size_t place = index_.find_or_add(more.code, bricks_.size(), &added);
    if (added) {
      bricks_.push_back(more);
      continue;
    }
    std::size_t rank = 0;
    for_each_cell(more.cells,
                  [&](std::size_t cell) { sum_of(bricks_[place], cell).add(more.sums[rank++]); });
  }
}

void CellColors::subtract(std::span<const ColorBrick> bricks) {
  for (const ColorBrick& less : bricks) {
    const std::size_t place = index_.find(less.code);
    if (place == BrickIndex::kNone) continue;
    ColorBrick& brick = bricks_[place];
    std::size_t rank = 0;
    for_each_cell(less.cells, [&](std::size_t cell) {
      const ColorSum& sum = less.sums[rank++];
      if (brick.cells.test(cell)) sum_of(brick, cell).subtract(sum);
    });
    drop_empty(brick);
    if (!brick.cells.none()) continue;
    index_.erase(less.code);
    if (place + 1 != bricks_.size()) {
      brick = std::move(bricks_.back());
      index_.move(brick.code, place);
    }
    bricks_.pop_back();
  }
}

std::optional<Color> CellColors::color(const CellKey& cell) const {
  const std::size_t place = index_.find(brick_code(cell));
  if (place == BrickIndex::kNone) return std::nullopt;
  const ColorBrick& brick = bricks_[place];
  const std::size_t in_brick = cell_in_brick(cell);
  if (!brick.cells.test(in_brick)) return std::nullopt;
  return brick.sums[rank_of(brick.cells, in_brick)].mean();
}

std::vector<const ColorBrick*> CellColors::sorted() const {
  std::vector<const ColorBrick*> order;
  order.reserve(bricks_.size());
  for (const ColorBrick& brick : bricks_) order.push_back(&brick);
  std::sort(order.begin(), order.end(), [](const ColorBrick* a, const ColorBrick* b) {
    return a->code < b->code;
  });
  return order;
}

std::size_t CellColors::memory_usage() const {
  std::size_t bytes = bricks_.capacity() * sizeof(ColorBrick) + index_.memory_usage();
  for (const ColorBrick& brick : bricks_) bytes += brick.sums.capacity() * sizeof(ColorSum);
  return bytes;
}

}  // namespace facula
