// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/map_query_figures.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace facula {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string word(CellState state) {
  if (state == CellState::kUnknown) return "unknown";
  return state == CellState::kFree ? "free" : "occupied";
}

std::string word(RayHit::End end) {
  if (end == RayHit::End::kNothing) return "nothing";
  return end == RayHit::End::kUnknown ? "unknown" : "occupied";
}

std::vector<double> numbers(const Eigen::Vector3d& x) {
  return {x.x(), x.y(), x.z()};
}

double log_odds_at(const MapAnswers& answers, const Eigen::Vector3d& x) {
  const auto value = answers.map.log_odds(x);
  return value ? static_cast<double>(*value) : kNone;
}

double probability(double log_odds) {
  return 1 - 1 / (1 + std::exp(log_odds));
}

RayHit hit_of(const MapAnswers& answers, const QueryRay& ray) {
  return answers.query.cast_ray(ray.from.cast<float>(),
                                (ray.to - ray.from).cast<float>(),
                                {.max_range = answers.max_range, .unknown = answers.unknown});
}

std::optional<NearCell> nearest_to(const MapAnswers& answers, const Eigen::Vector3d& x) {
  return answers.query.nearest_obstacle(x, answers.radius.value(), answers.unknown);
}

}  // namespace

void report_place(const MapAnswers& answers, const Eigen::Vector3d& x, Figures& figures) {
  figures.numbers("at_m", "at", numbers(x), 3);
  const CellState state = answers.query.state(x);
  figures.text("state", "state", word(state));
  if (state != CellState::kUnknown) {
    const double log_odds = log_odds_at(answers, x);
    figures.number("log_odds", "log-odds", log_odds, 3);
    figures.number("probability", "probability of being occupied", probability(log_odds), 3);
  }
  if (!answers.radius) return;
  const auto nearest = nearest_to(answers, x);
  figures.flag("obstacle_within", "obstacle within the radius", nearest.has_value());
  if (!nearest) return;
  const Eigen::Vector3d centre = centre_of(nearest->cell, answers.query.resolution());
  figures.number("obstacle_distance_m", "distance of the nearest", nearest->distance, 3);
  figures.numbers("obstacle_centre_m", "its cell's centre", numbers(centre), 3);
}

void report_ray(const MapAnswers& answers, const QueryRay& ray, Figures& figures) {
  const RayHit hit = hit_of(answers, ray);
  figures.text("end", "ended by", word(hit.end));
  if (hit.end == RayHit::End::kNothing) return;
  const Eigen::Vector3d centre = centre_of(hit.cell, answers.query.resolution());
  figures.number("distance_m", "distance", hit.distance, 3);
  figures.numbers("point_m", "enters the cell at", numbers(hit.point), 3);
  figures.numbers("centre_m", "the cell's centre", numbers(centre), 3);
}

void report_box(const MapAnswers& answers, const MapBox& box, Figures& figures) {
  const CellCounts counts = answers.query.count(cell_box(box, answers.query.resolution()));
  figures.count("free_cells", "free cells", counts.free);
  figures.count("occupied_cells", "occupied cells", counts.occupied);
  figures.count("unknown_cells", "unknown cells", counts.unknown);
}

FigureTable table_of_places(const MapAnswers& answers,
                            const std::vector<Eigen::Vector3d>& places,
                            Figures& figures) {
  FigureTable table{"places",
                    "Places:",
                    {{"x_m", "x", 3},
                     {"y_m", "y", 3},
                     {"z_m", "z", 3},
                     {"state", "state", 0},
                     {"log_odds", "log-odds", 3}},
                    {}};
  if (answers.radius) table.columns.push_back({"obstacle_distance_m", "nearest obstacle", 3});
  const std::vector<CellState> states = answers.query.states(places);
  std::array<std::size_t, 3> counts{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector3d& x = places[i];
    ++counts[static_cast<std::size_t>(states[i])];
    table.rows.push_back({x.x(), x.y(), x.z(), word(states[i]), log_odds_at(answers, x)});
    if (!answers.radius) continue;
    const auto nearest = nearest_to(answers, x);
    table.rows.back().emplace_back(nearest ? nearest->distance : kNone);
  }
  figures.count("places", "places", places.size());
  figures.count("free_places", "in free cells", counts[1]);
  figures.count("occupied_places", "in occupied cells", counts[2]);
  figures.count("unknown_places", "in unknown cells", counts[0]);
  return table;
}

FigureTable table_of_rays(const MapAnswers& answers,
                          const std::vector<QueryRay>& rays,
                          Figures& figures) {
  FigureTable table{"rays",
                    "Rays:",
                    {{"end", "ended by", 0},
                     {"distance_m", "distance", 3},
                     {"x_m", "x", 3},
                     {"y_m", "y", 3},
                     {"z_m", "z", 3}},
                    {}};
  std::size_t stopped = 0;
  for (const QueryRay& ray : rays) {
    const RayHit hit = hit_of(answers, ray);
    const bool nothing = hit.end == RayHit::End::kNothing;
    const Eigen::Vector3d x = nothing ? Eigen::Vector3d::Constant(kNone) : hit.point;
    stopped += hit.end == RayHit::End::kOccupied ? 1 : 0;
    table.rows.push_back({word(hit.end), nothing ? kNone : hit.distance, x.x(), x.y(), x.z()});
  }
  figures.count("rays", "rays", rays.size());
  figures.count("stopped_rays", "stopped by occupied cells", stopped);
  return table;
}

}  // namespace facula
