// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/path_plan.hpp>
#include <facula/map/path_search.hpp>
#include <facula/map/place_text.hpp>
#include <facula/map/short_ways.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace facula {
namespace {

constexpr double kReach = 1;  // clearances beyond radius + this help the search no more [m]

Eigen::AlignedBox3d metres_of(const CellBox& cells, double resolution) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(resolution / 2);
  return {centre_of(cells.low, resolution) - half, centre_of(cells.high, resolution) + half};
}

void require_place(const char* name, const Eigen::Vector3d& x, const PathTask& task) {
  const MapQuery& query = task.clearance->query();
  const auto cell = cell_of(x, query.resolution());
  require(cell && query.known()->contains(*cell),
          "expected the ",
          name,
          " within the map, which is known from ",
          place_text(task.known.min()),
          " m to ",
          place_text(task.known.max()),
          " m, got ",
          place_text(x),
          " m; give a place in between");
  const double needed = task.asked_radius();
  const double clearance = task.clearance->exact(x, needed);
  require(clearance > 0,
          "expected the ",
          name,
          " in free space, got ",
          place_text(x),
          " m inside an obstacle (clearance 0 m); give another place");
  require(clearance >= needed,
          "expected the ",
          name,
          " at least ",
          needed,
          " m (the radius and a sixteenth of a cell) from obstacles, but ",
          place_text(x),
          " m has a clearance of ",
          clearance,
          " m; give another place or a smaller radius");
}

/// Places along the path, at most half a cell apart, each measured in the map itself.
std::vector<PathSample> samples_of(const std::vector<Eigen::Vector3d>& corners,
                                   const PathTask& task,
                                   double max_clearance) {
  std::vector<PathSample> samples;
  const auto add = [&](const Eigen::Vector3d& x) {
    samples.push_back({x, task.clearance->exact(x, std::max(max_clearance, task.radius))});
    if (samples.back().clearance >= task.radius) return;
    fail("expected a path that keeps ",
         task.radius,
         " m from obstacles, but the one found comes as near as ",
         samples.back().clearance,
         " m at ",
         place_text(x),
         " m: a fault of the planner, please report it");
  };
  add(corners.front());
  const double spacing = task.clearance->query().resolution() / 2;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Eigen::Vector3d way = corners[i] - corners[i - 1];
    const auto pieces = std::max(1, static_cast<int>(std::ceil(way.norm() / spacing)));
    for (int k = 1; k <= pieces; ++k) {
      add(k == pieces ? corners[i]
                      : Eigen::Vector3d(corners[i - 1] + static_cast<double>(k) / pieces * way));
    }
  }
  return samples;
}

/// The cells that the ball may be in: those of the known box, or of one height.
CellBox roaming_box(const CellBox& known, const CellKey& start, bool flat) {
  CellBox box = known;
  if (flat) box.low[2] = box.high[2] = start[2];
  return box;
}

/// The path that was found, measured in the map itself.
PathPlan measured(FoundPath found, const PathTask& task, double max_clearance) {
  PathPlan plan;
  plan.corners = std::move(found.corners);
  plan.tries = found.tries;
  plan.paths = found.paths;
  for (std::size_t i = 1; i < plan.corners.size(); ++i) {
    plan.length += (plan.corners[i] - plan.corners[i - 1]).norm();
  }
  plan.samples = samples_of(plan.corners, task, max_clearance);
  plan.least_clearance = plan.samples.front().clearance;
  for (const PathSample& sample : plan.samples) {
    plan.least_clearance = std::min(plan.least_clearance, sample.clearance);
  }
  return plan;
}

void require_ends(const Eigen::Vector3d& from, const Eigen::Vector3d& to, bool flat) {
  require(from.allFinite() && to.allFinite(),
          "expected a start and a goal of finite numbers, got ",
          place_text(from),
          " m and ",
          place_text(to),
          " m");
  require(!flat || from.z() == to.z(),
          "expected a start and a goal of the same height for a flat path, got ",
          from.z(),
          " m and ",
          to.z(),
          " m");
}

/// The straight line where it is free. Says with certainty where there is no way; tries are made
/// along short ways where there are such.
FoundPath found_path(PathTask task,
                     const std::array<Eigen::Vector3d, 2>& ends,
                     const PathPlanOptions& options) {
  const Clearance& clearance = *task.clearance;
  const double radius = task.asked_radius();
  if (clearance.holds_along(ends[0], ends[1], radius)) {
    return {.corners = {ends[0], ends[1]}, .tries = 0, .paths = 1};
  }
  const double cell = clearance.query().resolution();
  const std::array<CellKey, 2> cells = {cell_of(ends[0], cell).value(),
                                        cell_of(ends[1], cell).value()};
  const CellBox box = roaming_box(clearance.query().known().value(), cells[0], options.flat);
  const ReachableCells reachable(clearance, box, cells[0], radius, options.num_threads);
  require(reachable.contains(cells[1]),
          "expected a way from start to goal for a ball of ",
          options.radius,
          " m, but there is none",
          options.unknown == UnknownCells::kOccupied ? " through cells known to be free" : "",
          "; give another goal, a smaller radius, or let unknown cells count as free");
  const std::vector<CellKey> on_short_ways = cells_of_short_ways(
      clearance, box, cells, {.radius = radius, .num_threads = options.num_threads});
  task.reachable = &reachable;
  task.on_short_ways = &on_short_ways;
  FoundPath found = search_path(
      task,
      ends,
      {.seed = options.seed, .max_tries = options.max_tries, .more_tries = options.more_tries});
  require(
      !found.corners.empty(),
      "expected a path that keeps ",
      options.radius,
      " m from obstacles, found none in ",
      options.max_tries,
      " random tries though the cells between start and goal hang together; passages may be too "
      "narrow: try a smaller radius, or more tries");
  return found;
}

}  // namespace

void PathPlanOptions::check() const {
  require(std::isfinite(radius) && radius > 0,
          "PathPlanOptions: expected a radius above 0 m, got ",
          radius);
  require(std::isfinite(max_clearance) && max_clearance > 0,
          "PathPlanOptions: expected max_clearance above 0 m, got ",
          max_clearance);
  require(seed > 0, "PathPlanOptions: expected a seed above 0, got 0");
  require(max_tries > 0, "PathPlanOptions: expected max_tries above 0, got 0");
}

PathPlan plan_path(const OccupancyMap& map,
                   const Eigen::Vector3d& from,
                   const Eigen::Vector3d& to,
                   const PathPlanOptions& options) {
  options.check();
  require_ends(from, to, options.flat);
  const auto height = options.flat ? std::optional<double>(from.z()) : std::nullopt;
  const Clearance clearance(map,
                            {.unknown = options.unknown,
                             .height = height,
                             .reach = options.radius + kReach,
                             .max_memory = options.max_memory,
                             .num_threads = options.num_threads});
  const CellBox known = clearance.query().known().value();
  const PathTask task{.clearance = &clearance,
                      .known = metres_of(known, map.resolution()),
                      .radius = options.radius,
                      .height = height};
  require_place("start", from, task);
  require_place("goal", to, task);
  return measured(found_path(task, {from, to}, options), task, options.max_clearance);
}

}  // namespace facula
