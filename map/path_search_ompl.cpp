// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/map/path_search.hpp>

#include <limits>
#include <memory>
#include <mutex>
#include <utility>

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

Eigen::Vector3d place_of(const PathTask& task, const ob::State* state) {
  const auto* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  return {values[0], values[1], task.height ? *task.height : values[2]};
}

class BallMotion : public ob::MotionValidator {
 public:
  BallMotion(const ob::SpaceInformationPtr& space, const PathTask& task)
      : ob::MotionValidator(space), task_(task) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return task_.clearance->holds_along(
        place_of(task_, a), place_of(task_, b), task_.asked_radius());
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
  PathTask task_;
};

/// Draws places in the cells that the ball can reach: elsewhere they would be in vain. Most of
/// space would be so too where short ways are known.
class ReachableSampler : public ob::RealVectorStateSampler {
 public:
  ReachableSampler(const ob::StateSpace* space, const PathTask& task, std::uint32_t seed)
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

  PathTask task_;
  Random random_;
};

ob::SpaceInformationPtr space_of(const PathTask& task, std::uint32_t seed) {
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
    return task.clearance->holds(place_of(task, state), task.asked_radius());
  });
  information->setMotionValidator(std::make_shared<BallMotion>(information, task));
  information->setup();
  return information;
}

std::shared_ptr<ob::ProblemDefinition> problem_of(const ob::SpaceInformationPtr& space,
                                                  const std::array<Eigen::Vector3d, 2>& ends) {
  ob::ScopedState<> start(space);
  ob::ScopedState<> goal(space);
  for (unsigned int i = 0; i < space->getStateDimension(); ++i) {
    start[i] = ends[0][i];
    goal[i] = ends[1][i];
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

std::vector<Eigen::Vector3d> corners_of(og::PathGeometric& path, const PathTask& task) {
  std::vector<Eigen::Vector3d> corners;
  for (const ob::State* state : path.getStates()) corners.push_back(place_of(task, state));
  return corners;
}

}  // namespace

FoundPath search_path(const PathTask& task,
                      const std::array<Eigen::Vector3d, 2>& ends,
                      const PathSearchOptions& options) {
  // OMPL's source of seeds belongs to the whole process.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const Silence silence;
  ompl::RNG::setSeed(options.seed);
  const ob::SpaceInformationPtr space = space_of(task, options.seed);
  const auto problem = problem_of(space, ends);
  og::RRTConnect planner(space);
  planner.setRange(kTreeStep);
  planner.setProblemDefinition(problem);
  FoundPath found;
  std::size_t limit = options.max_tries;
  double least = std::numeric_limits<double>::infinity();
  do {
    planner.clear();
    problem->clearSolutionPaths();
    planner.solve(ob::PlannerTerminationCondition([&] { return ++found.tries > limit; }));
    if (!problem->hasExactSolution()) break;
    og::PathGeometric path = *problem->getSolutionPath()->as<og::PathGeometric>();
    shorten(path, space);
    ++found.paths;
    if (path.length() < least) {
      least = path.length();
      found.corners = corners_of(path, task);
    }
    limit = options.more_tries;
  } while (found.tries < limit && found.paths < kMostPaths);
  return found;
}

}  // namespace facula
