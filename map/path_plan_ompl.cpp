// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/map/clearance.hpp>
#include <facula/map/path_plan.hpp>
#include <facula/map/place_text.hpp>
#include <facula/map/reachable_cells.hpp>
#include <facula/map/short_ways.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

namespace facula {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kTreeStep = 1.5;            // longest branch of a tree [m]
constexpr double kReach = 1;                 // clearances beyond radius + this help no more [m]
constexpr std::size_t kMostPaths = 8;        // compared with each other
constexpr unsigned int kRounds = 4;          // of shortening
constexpr unsigned int kShortcuts = 200;     // tried per round
constexpr unsigned int kSmoothingSteps = 3;  // halvings of the corners

/// Keeps OMPL from printing while it lives.
class Silence {
 public:
  Silence() { ompl::msg::noOutputHandler(); }
  ~Silence() { ompl::msg::restorePreviousOutputHandler(); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
};

/// A plan's question: where a ball of `radius` may be.
struct Task {
  const Clearance* clearance = nullptr;
  const ReachableCells* reachable = nullptr;
  const std::vector<CellKey>* on_short_ways =
      nullptr;                   // where tries are made; empty: wherever it can
  double radius = 0;             // what is kept [m]
  std::optional<double> height;  // of all places, where it is fixed [m]
  Eigen::AlignedBox3d known;     // [m]

  /// Between two places that are looked at the clearance may be less by half a step.
  double asked_radius() const { return radius + clearance->step() / 2; }

  Eigen::Vector3d place(const ob::State* state) const {
    const auto* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    return {values[0], values[1], height ? *height : values[2]};
  }
};

class BallMotion : public ob::MotionValidator {
 public:
  BallMotion(const ob::SpaceInformationPtr& space, const Task& task)
      : ob::MotionValidator(space), task_(task) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return task_.clearance->holds_along(task_.place(a), task_.place(b), task_.asked_radius());
  }

  /// Only some planners ask for the last place that was fine: ours do not.
  bool checkMotion(const ob::State* a,
                   const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    const bool fine = checkMotion(a, b);
    last_valid.second = fine ? 1 : 0;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, fine ? b : a);
    return fine;
  }

 private:
  Task task_;
};

/// Draws places in the cells that the ball can reach: elsewhere they would be in vain. Most of
/// space would be so too where short ways are known.
class ReachableSampler : public ob::RealVectorStateSampler {
 public:
  ReachableSampler(const ob::StateSpace* space, const Task& task, std::uint32_t seed)
      : ob::RealVectorStateSampler(space), task_(task), random_(seed) {}

  void sampleUniform(ob::State* state) override {
    const CellKey cell = drawn_cell();
    const double edge = task_.clearance->query().resolution();
    const Eigen::Vector3d centre = centre_of(cell, edge);
    auto* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    for (unsigned int i = 0; i < space_->getDimension(); ++i) {
      values[i] = centre[i] + (random_.uniform() - 0.5) * edge;
    }
    space_->enforceBounds(state);
  }

 private:
  CellKey drawn_cell() {
    const std::vector<CellKey>& near = *task_.on_short_ways;
    if (!near.empty()) return near[random_.below(near.size())];
    return (*task_.reachable)[random_.below(task_.reachable->size())];
  }

  Task task_;
  Random random_;
};

ob::SpaceInformationPtr space_of(const Task& task, std::uint32_t seed) {
  const unsigned int dimensions = task.height ? 2 : 3;
  auto space = std::make_shared<ob::RealVectorStateSpace>(dimensions);
  ob::RealVectorBounds bounds(dimensions);
  for (unsigned int i = 0; i < dimensions; ++i) {
    bounds.setLow(i, task.known.min()[i]);
    bounds.setHigh(i, task.known.max()[i]);
  }
  space->setBounds(bounds);
  space->setStateSamplerAllocator([task, seed](const ob::StateSpace* sampled) {
    return std::make_shared<ReachableSampler>(sampled, task, seed);
  });
  auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker([task](const ob::State* state) {
    return task.clearance->holds(task.place(state), task.asked_radius());
  });
  information->setMotionValidator(std::make_shared<BallMotion>(information, task));
  information->setup();
  return information;
}

std::shared_ptr<ob::ProblemDefinition> problem_of(const ob::SpaceInformationPtr& space,
                                                  const Eigen::Vector3d& from,
                                                  const Eigen::Vector3d& to) {
  ob::ScopedState<> start(space);
  ob::ScopedState<> goal(space);
  for (unsigned int i = 0; i < space->getStateDimension(); ++i) {
    start[i] = from[i];
    goal[i] = to[i];
  }
  auto problem = std::make_shared<ob::ProblemDefinition>(space);
  problem->setStartAndGoalStates(start, goal, std::numeric_limits<double>::epsilon());
  return problem;
}

/// Everything after the first path: in numbers of steps, so that no clock decides.
void shorten(og::PathGeometric& path, const ob::SpaceInformationPtr& space) {
  og::PathSimplifier simplifier(space);
  for (unsigned int round = 0; round < kRounds; ++round) {
    simplifier.reduceVertices(path);
    simplifier.shortcutPath(path, kShortcuts, kShortcuts);
    simplifier.collapseCloseVertices(path);
  }
  simplifier.smoothBSpline(path, kSmoothingSteps);
}

Eigen::AlignedBox3d metres_of(const CellBox& cells, double resolution) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(resolution / 2);
  return {centre_of(cells.low, resolution) - half, centre_of(cells.high, resolution) + half};
}

void require_place(const char* name, const Eigen::Vector3d& x, const Task& task) {
  require(x.allFinite() && task.known.contains(x),
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
                                   const Task& task,
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

PathPlan plan_of(og::PathGeometric& path, const Task& task, double max_clearance) {
  PathPlan plan;
  for (const ob::State* state : path.getStates()) {
    const Eigen::Vector3d x = task.place(state);
    if (!plan.corners.empty()) plan.length += (x - plan.corners.back()).norm();
    plan.corners.push_back(x);
  }
  plan.samples = samples_of(plan.corners, task, max_clearance);
  plan.least_clearance = plan.samples.front().clearance;
  for (const PathSample& sample : plan.samples) {
    plan.least_clearance = std::min(plan.least_clearance, sample.clearance);
  }
  return plan;
}

/// RRT-Connect from both ends and shortening, again and again while tries are left.
PathPlan search(const Task& task,
                const Eigen::Vector3d& from,
                const Eigen::Vector3d& to,
                const PathPlanOptions& options) {
  // OMPL's source of seeds belongs to the whole process.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const Silence silence;
  ompl::RNG::setSeed(options.seed);
  const ob::SpaceInformationPtr space = space_of(task, options.seed);
  const auto problem = problem_of(space, from, to);
  og::RRTConnect planner(space);
  planner.setRange(kTreeStep);
  planner.setProblemDefinition(problem);
  std::size_t tries = 0;
  std::size_t limit = options.max_tries;
  std::size_t paths = 0;
  std::shared_ptr<og::PathGeometric> best;
  do {
    planner.clear();
    problem->clearSolutionPaths();
    planner.solve(ob::PlannerTerminationCondition([&] { return ++tries > limit; }));
    if (!problem->hasExactSolution()) break;
    auto path =
        std::make_shared<og::PathGeometric>(*problem->getSolutionPath()->as<og::PathGeometric>());
    shorten(*path, space);
    if (!best || path->length() < best->length()) best = path;
    ++paths;
    limit = options.more_tries;
  } while (tries < limit && paths < kMostPaths);
  require(
      best != nullptr,
      "expected a path that keeps ",
      task.radius,
      " m from obstacles, found none in ",
      options.max_tries,
      " random tries though the cells between start and goal hang together; passages may be too "
      "narrow: try a smaller radius, or more tries");
  PathPlan plan = plan_of(*best, task, options.max_clearance);
  plan.tries = tries;
  plan.paths = paths;
  return plan;
}

/// The cells that the ball may be in: those of the known box, or of one height.
CellBox roaming_box(const CellBox& known, const CellKey& start, bool flat) {
  CellBox box = known;
  if (flat) box.low[2] = box.high[2] = start[2];
  return box;
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
  require(from.allFinite() && to.allFinite(),
          "expected a start and a goal of finite numbers, got ",
          place_text(from),
          " m and ",
          place_text(to),
          " m");
  require(!options.flat || from.z() == to.z(),
          "expected a start and a goal of the same height for a flat path, got ",
          from.z(),
          " m and ",
          to.z(),
          " m");
  const auto height = options.flat ? std::optional<double>(from.z()) : std::nullopt;
  const Clearance clearance(map,
                            {.unknown = options.unknown,
                             .height = height,
                             .reach = options.radius + kReach,
                             .max_memory = options.max_memory,
                             .num_threads = options.num_threads});
  const CellBox known = clearance.query().known().value();
  Task task{.clearance = &clearance,
            .radius = options.radius,
            .height = height,
            .known = metres_of(known, map.resolution())};
  require_place("start", from, task);
  require_place("goal", to, task);
  const std::array<CellKey, 2> ends = {cell_of(from, map.resolution()).value(),
                                       cell_of(to, map.resolution()).value()};
  const CellBox box = roaming_box(known, ends[0], options.flat);
  const double radius = task.asked_radius();
  const ReachableCells reachable(clearance, box, ends[0], radius, options.num_threads);
  require(reachable.contains(ends[1]),
          "expected a way from start to goal for a ball of ",
          options.radius,
          " m, but there is none",
          options.unknown == UnknownCells::kOccupied ? " through cells known to be free" : "",
          "; give another goal, a smaller radius, or let unknown cells count as free");
  const std::vector<CellKey> on_short_ways = cells_of_short_ways(
      clearance, box, ends, {.radius = radius, .num_threads = options.num_threads});
  task.reachable = &reachable;
  task.on_short_ways = &on_short_ways;
  return search(task, from, to, options);
}

}  // namespace facula
