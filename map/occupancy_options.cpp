// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/largest_cell.hpp>
#include <facula/map/occupancy_map.hpp>

#include <cmath>
#include <utility>

namespace facula {
namespace {

void require_between(const char* field, double value, std::pair<double, double> bounds) {
  require(value > bounds.first && value < bounds.second,
          "OccupancyOptions: expected ",
          field,
          " between ",
          bounds.first,
          " and ",
          bounds.second,
          ", got ",
          value);
}

/// In float, as OctoMap keeps it.
float log_odds_of(double probability) {
  return static_cast<float>(std::log(probability / (1 - probability)));
}

}  // namespace

void OccupancyOptions::check() const {
  require(std::isfinite(resolution) && resolution > 0,
          "OccupancyOptions: expected a resolution above 0 m, got ",
          resolution);
  require(resolution <= kLargestCell,
          "OccupancyOptions: expected a resolution of at most ",
          kLargestCell,
          " m, got ",
          resolution);
  require(std::isfinite(max_range) && max_range >= 0,
          "OccupancyOptions: expected max_range of 0 m (no limit) or more, got ",
          max_range);
  require_between("hit", hit, {0.5, 1});
  require_between("miss", miss, {0, 0.5});
  require_between("clamp_min", clamp_min, {0, 0.5});
  require_between("clamp_max", clamp_max, {0.5, 1});
}

LogOddsModel OccupancyOptions::model() const {
  return {.hit = log_odds_of(hit),
          .miss = log_odds_of(miss),
          .min = log_odds_of(clamp_min),
          .max = log_odds_of(clamp_max)};
}

CastOptions OccupancyOptions::cast() const {
  return {.resolution = resolution,
          .max_range = max_range,
          .discretize = discretize,
          .weigh_sigma = weigh_sigma,
          .box = box,
          .num_threads = num_threads};
}

}  // namespace facula
