// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_layers.hpp>
#include <facula/map/find_floor.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>
#include <vector>

namespace facula {
namespace {

using BrickView = OccupancyMap::BrickView;

/// Columns of cells, 64 of a brick in a word.
class ColumnSet {
 public:
  void add(const CellKey& first, std::uint64_t columns) {
    words_[static_cast<std::uint32_t>(first[0] / kBrickEdge) << 16 |
           static_cast<std::uint32_t>(first[1] / kBrickEdge)] |= columns;
  }
  std::size_t size() const {
    std::size_t count = 0;
    for (const auto& [place, word] : words_) count += static_cast<std::size_t>(std::popcount(word));
    return count;
  }

 private:
  std::unordered_map<std::uint32_t, std::uint64_t> words_;
};

/// Calls visit(brick, cells) for every brick with occupied cells under a free one.
void for_each_upward_face(const OccupancyMap& map,
                          const std::function<void(const BrickView&, const CellMask&)>& visit) {
  map.for_each_brick([&](const BrickView& brick) {
    const CellMask free = brick.known & ~brick.occupied;
    CellMask faces;
    for (std::size_t z = 0; z < 7; ++z)
      faces.words[z] = brick.occupied.words[z] & free.words[z + 1];
    const CellKey above = {brick.first[0], brick.first[1], brick.first[2] + kBrickEdge};
    if (brick.occupied.words[7] != 0 && above[2] < kKeyLimit) {
      const LogOddsBrick* next = map.bricks().find(brick_code(above));
      if (next != nullptr) {
        faces.words[7] = brick.occupied.words[7] & (next->known() & ~next->occupied()).words[0];
      }
    }
    if (!faces.none()) visit(brick, faces);
  });
}

/// Upward faces per layer.
std::vector<std::size_t> faces_per_layer(const OccupancyMap& map) {
  std::vector<std::size_t> faces(kKeyLimit, 0);
  for_each_upward_face(map, [&](const BrickView& brick, const CellMask& cells) {
    for (std::size_t z = 0; z < 8; ++z) {
      faces[static_cast<std::size_t>(brick.first[2]) + z] +=
          static_cast<std::size_t>(std::popcount(cells.words[z]));
    }
  });
  return faces;
}

/// Sums over runs of `length` layers, by their lowest layer.
std::vector<std::size_t> run_sums(const std::vector<std::size_t>& faces, std::size_t length) {
  std::vector<std::size_t> sums(faces.size() - length + 1, 0);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    for (std::size_t k = 0; k < length; ++k) sums[i] += faces[i + k];
  }
  return sums;
}

/// The lowest layer of the floor's run.
std::size_t floor_layer(const std::vector<std::size_t>& sums,
                        const OccupancyMap& map,
                        const FloorOptions& options) {
  const double cell_area = map.resolution() * map.resolution();
  const auto most = std::max_element(sums.begin(), sums.end());
  const double most_area = static_cast<double>(*most) * cell_area;
  require(most_area >= options.min_area,
          "the map has no floor: its largest level surface with free space above is ",
          most_area,
          " m^2, expected ",
          options.min_area,
          " m^2 or more; scan the floor, or give its height yourself");
  const double enough =
      std::max(options.min_area / cell_area, options.min_share * static_cast<double>(*most));
  auto run = std::find_if(sums.begin(), sums.end(), [&](std::size_t sum) {
    return static_cast<double>(sum) >= enough;
  });
  // The first run to hold enough may catch the floor's lower edge only.
  const auto end = sums.end() - run > options.layers ? run + options.layers + 1 : sums.end();
  return static_cast<std::size_t>(std::max_element(run, end) - sums.begin());
}

std::size_t columns_with_face(const OccupancyMap& map, const CellLayers& layers) {
  ColumnSet columns;
  for_each_upward_face(map, [&](const BrickView& brick, const CellMask& cells) {
    columns.add(brick.first, columns_of(cells & mask_of(layers, brick.first[2])));
  });
  return columns.size();
}

std::size_t known_columns(const OccupancyMap& map) {
  ColumnSet columns;
  map.for_each_brick(
      [&](const BrickView& brick) { columns.add(brick.first, columns_of(brick.known)); });
  return columns.size();
}

/// Mean and deviation of the keys of layers, each as often as it has faces.
struct HeightSums {
  int lowest = kKeyLimit;
  int highest = 0;
  double count = 0;
  double sum = 0;
  double squares = 0;  // about the lowest layer, so that nothing cancels

  void add(std::size_t layer, std::size_t faces) {
    if (faces == 0) return;
    lowest = std::min(lowest, static_cast<int>(layer));
    highest = std::max(highest, static_cast<int>(layer));
    const auto weight = static_cast<double>(faces);
    const double above = static_cast<int>(layer) - lowest;  // layers come in ascending order
    count += weight;
    sum += weight * above;
    squares += weight * above * above;
  }
  double mean() const { return lowest + sum / count; }
  double deviation() const {
    return std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
  }
};

}  // namespace

void FloorOptions::check() const {
  require(std::isfinite(min_area) && min_area > 0,
          "FloorOptions: expected min_area above 0 m^2, got ",
          min_area);
  require(min_share >= 0 && min_share <= 1,
          "FloorOptions: expected min_share between 0 and 1, got ",
          min_share);
  require(layers >= 1 && layers <= 16, "FloorOptions: expected 1 to 16 layers, got ", layers);
}

Floor find_floor(const OccupancyMap& map, const FloorOptions& options) {
  options.check();
  const std::vector<std::size_t> faces = faces_per_layer(map);
  const auto length = static_cast<std::size_t>(options.layers);
  const std::size_t first = floor_layer(run_sums(faces, length), map, options);

  const std::size_t fullest =
      *std::max_element(faces.begin() + static_cast<std::ptrdiff_t>(first),
                        faces.begin() + static_cast<std::ptrdiff_t>(first + length));
  HeightSums sums;
  for (std::size_t layer = first; layer < first + length; ++layer) {
    if (10 * faces[layer] >= fullest) sums.add(layer, faces[layer]);
  }
  const CellLayers layers = {sums.lowest, sums.highest + 1};
  const double resolution = map.resolution();
  const auto area = static_cast<double>(columns_with_face(map, layers));
  return {.height = (sums.mean() - kCentreKey + 0.5) * resolution,
          .top = (layers.end - kCentreKey) * resolution,
          .area = area * resolution * resolution,
          .share = area / static_cast<double>(known_columns(map)),
          .spread = sums.deviation() * resolution};
}

}  // namespace facula
