// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/coarse_map.hpp>
#include <facula/map/frontiers.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace facula {
namespace {

void require_positive(const char* field, double value) {
  require(std::isfinite(value) && value > 0,
          "FrontierOptions: expected ",
          field,
          " above 0 m, got ",
          value);
}

using Directions = std::vector<Eigen::Vector3d>;

/// How many times fewer rays search than count.
constexpr std::size_t kSearchShare = 8;

/// Directions spread evenly over the sphere (Fibonacci lattice, Gonzalez 2010).
Directions sphere(std::size_t count) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  Directions directions;
  directions.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<double>(i);
    const double z = 1 - (2 * k + 1) / static_cast<double>(count);
    const double radius = std::sqrt(1 - z * z);
    directions.emplace_back(
        radius * std::cos(golden_angle * k), radius * std::sin(golden_angle * k), z);
  }
  return directions;
}

/// As many rays as put one into every cell at the full range.
std::size_t ray_count(const FrontierOptions& options, double edge) {
  const double cells = 4 * std::numbers::pi * std::pow(options.range / edge, 2);
  return static_cast<std::size_t>(std::clamp(cells, 100.0, static_cast<double>(options.most_rays)));
}

/// An unknown cell and the region of the frontier through which it was seen.
struct SeenCell {
  std::size_t cell = 0;
  int region = FrontierRegions::kNone;
};

/// What there is to see, and what was crossed off.
struct Scene {
  const CoarseMap& map;
  const FrontierRegions& frontiers;
  Directions directions;  // a ray for every cell
  Directions few;         // enough to tell better places from worse ones
  double range = 0;
  std::vector<bool> crossed_off;

  /// The distinct unknown cells that rays from a place meet, but for those met already.
  std::vector<SeenCell> seen(const Eigen::Vector3d& position,
                             const Directions& along,
                             std::vector<bool> met) const {
    std::vector<SeenCell> seen;
    for (const Eigen::Vector3d& direction : along) {
      int region = FrontierRegions::kNone;
      walk_coarse(map, position, direction, range, [&](std::size_t cell) {
        const CellState state = map.cells[cell];
        if (state == CellState::kOccupied) return false;
        if (state == CellState::kFree) {
          region = frontiers.region_of[cell];
        } else if (!met[cell]) {
          met[cell] = true;
          seen.push_back({cell, region});
        }
        return true;
      });
    }
    return seen;
  }

  std::vector<SeenCell> seen_from(const Eigen::Vector3d& position) const {
    return seen(position, directions, crossed_off);
  }
  double volume_from(const Eigen::Vector3d& position, const Directions& along) const {
    return volume(seen(position, along, crossed_off).size());
  }

  /// What is seen from a place counts no more; returns its volume [m^3].
  double cross_off(const Eigen::Vector3d& position) {
    const std::vector<SeenCell> cells = seen_from(position);
    for (const SeenCell& cell : cells) crossed_off[cell.cell] = true;
    return volume(cells.size());
  }

  double volume(std::size_t cells) const {
    return static_cast<double>(cells) * map.edge * map.edge * map.edge;
  }
};

/// The suggestion for a place and what is seen from it.
ScanSuggestion describe(const Scene& scene,
                        const Eigen::Vector3d& position,
                        const std::vector<SeenCell>& seen) {
  std::vector<std::size_t> through(scene.frontiers.regions.size(), 0);
  for (const SeenCell& cell : seen) {
    if (cell.region != FrontierRegions::kNone) ++through[static_cast<std::size_t>(cell.region)];
  }
  ScanSuggestion suggestion;
  suggestion.position = position;
  suggestion.volume = scene.volume(seen.size());
  const auto most = std::max_element(through.begin(), through.end());
  if (most == through.end() || *most == 0) return suggestion;
  suggestion.region = scene.frontiers.regions[static_cast<std::size_t>(most - through.begin())];
  suggestion.region_volume = scene.volume(*most);
  return suggestion;
}

/// Unknown volume seen from every place [m^3].
std::vector<double> volumes_from(const Scene& scene,
                                 const StandArea& area,
                                 const std::vector<std::size_t>& places,
                                 const Directions& along,
                                 int num_threads) {
  std::vector<double> volumes(places.size(), 0);
  parallel_for(places.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   volumes[i] = scene.volume_from(area.position(places[i]), along);
                 }
               },
               {.num_threads = num_threads, .chunk = 1});
  return volumes;
}

/// Climbs from a place of the lattice to a better one between, in steps that get shorter.
std::size_t climb(const Scene& scene, const StandArea& area, std::size_t place, int num_threads) {
  double volume = scene.volume_from(area.position(place), scene.few);
  for (int step = area.stride / 2; step >= 1 && step * area.resolution > scene.map.edge / 4;) {
    const std::vector<std::size_t> places = area.around(place, step);
    const std::vector<double> volumes = volumes_from(scene, area, places, scene.few, num_threads);
    const auto best = std::max_element(volumes.begin(), volumes.end());
    if (best == volumes.end() || *best <= volume) {
      step /= 2;
      continue;
    }
    volume = *best;
    place = places[static_cast<std::size_t>(best - volumes.begin())];
  }
  return place;
}

/// The index of the largest volume, each of which may have shrunk since it was taken: volumes only
/// shrink, so that one that was just taken anew and still is the largest is the largest.
std::size_t largest(const Scene& scene,
                    const StandArea& area,
                    const std::vector<std::size_t>& places,
                    const Directions& along,
                    std::vector<double>& volumes) {
  for (;;) {
    const auto best = std::max_element(volumes.begin(), volumes.end());
    const auto i = static_cast<std::size_t>(best - volumes.begin());
    const double volume = scene.volume_from(area.position(places[i]), along);
    if (volume >= std::exchange(*best, volume)) return i;
  }
}

/// Takes the best place, crosses off what it sees, and so on.
std::vector<std::size_t> choose(Scene scene,
                                const StandArea& area,
                                const FrontierOptions& options) {
  std::vector<double> volumes =
      volumes_from(scene, area, area.lattice, scene.few, options.num_threads);
  std::vector<std::size_t> places;
  while (places.size() < options.count) {
    const std::size_t best = largest(scene, area, area.lattice, scene.few, volumes);
    const std::size_t place = climb(scene, area, area.lattice[best], options.num_threads);
    const double seen = scene.cross_off(area.position(place));
    if (seen == 0 || seen < options.min_volume) break;
    places.push_back(place);
  }
  return places;
}

/// The chosen places in the order in which each shows most that the ones before do not: the climb
/// may have made a later one better.
std::vector<ScanSuggestion> ranked(Scene& scene,
                                   const StandArea& area,
                                   const std::vector<std::size_t>& places,
                                   const FrontierOptions& options) {
  const std::vector<double> alone =
      volumes_from(scene, area, places, scene.directions, options.num_threads);
  std::vector<double> volumes = alone;
  std::vector<ScanSuggestion> suggestions;
  while (suggestions.size() < places.size()) {
    const std::size_t best = largest(scene, area, places, scene.directions, volumes);
    if (volumes[best] < options.min_volume) break;
    const Eigen::Vector3d position = area.position(places[best]);
    suggestions.push_back(describe(scene, position, scene.seen_from(position)));
    suggestions.back().volume_alone = alone[best];
    scene.cross_off(position);
    volumes[best] = -1;
  }
  return suggestions;
}

}  // namespace

void FrontierOptions::check() const {
  stand.check();
  require_positive("range", range);
  require_positive("view_cell", view_cell);
  require_positive("region_length", region_length);
  require(std::isfinite(margin) && margin >= 0,
          "FrontierOptions: expected margin of 0 m or more, got ",
          margin);
  require(std::isfinite(min_volume) && min_volume >= 0,
          "FrontierOptions: expected min_volume of 0 m^3 or more, got ",
          min_volume);
  require(count >= 1 && count <= 1000,
          "FrontierOptions: expected a count of 1 to 1000 suggestions, got ",
          count);
  require(most_rays >= 100, "FrontierOptions: expected most_rays of 100 or more, got ", most_rays);
}

Frontiers find_frontiers(const OccupancyMap& map,
                         const Floor& floor,
                         const FrontierOptions& options) {
  options.check();
  const CoarseMap coarse =
      coarse_map(map, {.least_edge = options.view_cell, .margin = options.margin});
  const FrontierRegions regions = frontier_regions(coarse, options.region_length);
  const StandArea area = find_standpoints(map, floor, options.stand);
  Scene scene{.map = coarse,
              .frontiers = regions,
              .directions = sphere(ray_count(options, coarse.edge)),
              .few = sphere(ray_count(options, coarse.edge) / kSearchShare),
              .range = options.range,
              .crossed_off = std::vector<bool>(coarse.cells.size(), false)};
  Frontiers result{.cell = coarse.edge,
                   .cells = regions.cells,
                   .regions = regions.regions.size(),
                   .standpoints = area.lattice.size(),
                   .rays = scene.directions.size(),
                   .suggestions = {}};
  result.suggestions = ranked(scene, area, choose(scene, area, options), options);
  return result;
}

}  // namespace facula
