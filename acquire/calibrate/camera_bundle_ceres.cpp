// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_bundle.hpp>

#include <array>
#include <cmath>
#include <utility>

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <glog/logging.h>

namespace facula {
namespace {

constexpr int kIntrinsics = 9;  // fx fy cx cy k1 k2 p1 p2 k3

using Intrinsics = std::array<double, kIntrinsics>;
using PoseStep = std::array<double, 6>;  // turn, then shift, in board axes

Intrinsics numbers_of(const Camera& c) {
  return {c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3};
}

void set_numbers(Camera& c, const Intrinsics& n, bool square_pixels) {
  c.fx = n[0];
  c.fy = square_pixels ? n[0] : n[1];
  c.cx = n[2];
  c.cy = n[3];
  c.k1 = n[4];
  c.k2 = n[5];
  c.p1 = n[6];
  c.p2 = n[7];
  c.k3 = n[8];
}

/// Image of a point of the board (see seen_at).
struct PointModel {
  Eigen::Vector3d on_board;
  double radius_squared;  ///< of the circle about the point, 0 for a corner [m^2]
  RigidTransform start;   ///< camera_from_board that the step starts from
  bool square_pixels;

  template <typename T>
  bool project(const T* intrinsics, const T* step, T* pixel) const {
    const Eigen::Matrix3d turn = start.rotation.toRotationMatrix();
    const auto to_camera = [&](const T* in_board, bool shift, T* in_camera) {
      T turned[3];
      ceres::AngleAxisRotatePoint(step, in_board, turned);
      for (int i = 0; i < 3 && shift; ++i) turned[i] += step[3 + i];
      for (int i = 0; i < 3; ++i) {
        in_camera[i] = turn(i, 0) * turned[0] + turn(i, 1) * turned[1] + turn(i, 2) * turned[2] +
                       (shift ? start.translation[i] : 0.0);
      }
    };
    const T point[3] = {T(on_board.x()), T(on_board.y()), T(on_board.z())};
    T x[3];
    to_camera(point, true, x);
    if (!(x[2] > 1e-6)) return false;
    if (radius_squared > 0) {
      const T ex[3] = {T(1), T(0), T(0)};
      const T ey[3] = {T(0), T(1), T(0)};
      T r1[3];
      T r2[3];
      to_camera(ex, false, r1);
      to_camera(ey, false, r2);
      const T factor = radius_squared / x[2];
      const T a = factor * r1[2];
      const T b = factor * r2[2];
      for (int i = 0; i < 3; ++i) x[i] -= a * r1[i] + b * r2[i];
    }
    distort(intrinsics, x[0] / x[2], x[1] / x[2], pixel);
    return true;
  }

  template <typename T>
  void distort(const T* k, const T& u, const T& v, T* pixel) const {
    const T r2 = u * u + v * v;
    const T radial = 1.0 + r2 * (k[4] + r2 * (k[5] + r2 * k[8]));
    pixel[0] = k[0] * (u * radial + 2.0 * k[6] * u * v + k[7] * (r2 + 2.0 * u * u)) + k[2];
    pixel[1] =
        k[square_pixels ? 0 : 1] * (v * radial + k[6] * (r2 + 2.0 * v * v) + 2.0 * k[7] * u * v) +
        k[3];
  }
};

struct PointError {
  PointModel model;
  Eigen::Vector2d seen;

  template <typename T>
  bool operator()(const T* intrinsics, const T* step, T* error) const {
    T pixel[2];
    if (!model.project(intrinsics, step, pixel)) return false;
    error[0] = pixel[0] - seen.x();
    error[1] = pixel[1] - seen.y();
    return true;
  }
};

std::vector<int> held_intrinsics(const BundleOptions& options) {
  std::vector<int> held;
  if (options.square_pixels) held.push_back(1);
  if (options.radial_terms < 1) held.push_back(4);
  if (options.radial_terms < 2) held.push_back(5);
  if (!options.tangential) held.insert(held.end(), {6, 7});
  if (options.radial_terms < 3) held.push_back(8);
  return held;
}

/// The problem and what it works on.
struct Fit {
  ceres::Problem problem;
  Intrinsics intrinsics{};
  std::vector<PoseStep> steps;
  std::size_t points = 0;

  Fit(const Board& board,
      const std::vector<BoardView>& views,
      const CameraBundle& start,
      const BundleOptions& options)
      : intrinsics(numbers_of(start.camera)), steps(views.size(), PoseStep{}) {
    const double radius_squared = board.circle_diameter * board.circle_diameter / 4;
    for (std::size_t v = 0; v < views.size(); ++v) {
      for (std::size_t i = 0; i < views[v].ids.size(); ++i) {
        PointModel model{
            board.point(views[v].ids[i]), radius_squared, start.poses[v], options.square_pixels};
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PointError, 2, kIntrinsics, 6>(
                                     new PointError{model, views[v].pixels[i]}),
                                 nullptr,
                                 intrinsics.data(),
                                 steps[v].data());
        ++points;
      }
    }
    const std::vector<int> held = held_intrinsics(options);
    if (options.fixed_camera) {
      problem.SetParameterBlockConstant(intrinsics.data());
    } else if (!held.empty()) {
      problem.SetManifold(intrinsics.data(), new ceres::SubsetManifold(kIntrinsics, held));
    }
  }

  bool solve() {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.num_threads = 1;
    solver.max_num_iterations = 200;
    solver.function_tolerance = 1e-14;
    solver.parameter_tolerance = 1e-12;
    solver.gradient_tolerance = 1e-12;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    return summary.IsSolutionUsable();
  }
};

/// Covariance of the intrinsics for pixel noise of 1 px; none when they are not determined.
std::optional<Eigen::MatrixXd> camera_covariance(Fit& fit) {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  options.num_threads = 1;
  options.min_reciprocal_condition_number = 1e-16;
  ceres::Covariance covariance(options);
  const double* block = fit.intrinsics.data();
  const std::vector<std::pair<const double*, const double*>> wanted{{block, block}};
  // Ceres would print about boards that leave parameters open; the caller says it in a sentence.
  const int printed_from = std::exchange(FLAGS_minloglevel, google::GLOG_FATAL);
  const bool determined = covariance.Compute(wanted, &fit.problem);
  FLAGS_minloglevel = printed_from;
  if (!determined) return std::nullopt;
  Eigen::Matrix<double, kIntrinsics, kIntrinsics, Eigen::RowMajor> values;
  if (!covariance.GetCovarianceBlock(block, block, values.data())) return std::nullopt;
  if (!values.allFinite()) return std::nullopt;
  return Eigen::MatrixXd(values);
}

/// Covariance of one view's step for pixel noise of 1 px, the camera held.
std::optional<Eigen::Matrix<double, 6, 6>> step_covariance(const Board& board,
                                                           const BoardView& view,
                                                           const CameraBundle& bundle,
                                                           std::size_t v,
                                                           const BundleOptions& options) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  const Intrinsics intrinsics = numbers_of(bundle.camera);
  using Jet = ceres::Jet<double, 6>;
  for (const int id : view.ids) {
    const PointModel model{board.point(id),
                           board.circle_diameter * board.circle_diameter / 4,
                           bundle.poses[v],
                           options.square_pixels};
    std::array<Jet, kIntrinsics> k;
    std::array<Jet, 6> step;
    for (std::size_t i = 0; i < k.size(); ++i) k[i] = Jet(intrinsics[i]);
    for (std::size_t i = 0; i < step.size(); ++i) step[i] = Jet(0.0, static_cast<int>(i));
    std::array<Jet, 2> pixel;
    if (!model.project(k.data(), step.data(), pixel.data())) return std::nullopt;
    for (const Jet& p : pixel) normal += p.v * p.v.transpose();
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal);
  if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
  return solver.solve(Eigen::Matrix<double, 6, 6>::Identity());
}

RigidTransform stepped(const RigidTransform& start, const PoseStep& step) {
  const Eigen::Vector3d turn(step[0], step[1], step[2]);
  RigidTransform moved;
  if (turn.norm() > 0) {
    moved.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  }
  moved.translation = Eigen::Vector3d(step[3], step[4], step[5]);
  RigidTransform result = start * moved;
  result.rotation.normalize();
  return result;
}

}  // namespace

Eigen::Vector2d seen_at(const CameraBundle& bundle,
                        std::size_t view,
                        const Eigen::Vector3d& on_board,
                        double circle_diameter) {
  const PointModel model{
      on_board, circle_diameter * circle_diameter / 4, bundle.poses[view], false};
  const Intrinsics intrinsics = numbers_of(bundle.camera);
  const PoseStep step{};
  Eigen::Vector2d pixel = Eigen::Vector2d::Constant(std::nan(""));
  model.project(intrinsics.data(), step.data(), pixel.data());
  return pixel;
}

std::optional<BundleResult> fit_bundle(const Board& board,
                                       const std::vector<BoardView>& views,
                                       const CameraBundle& start,
                                       const BundleOptions& options) {
  Fit fit(board, views, start, options);
  if (!fit.solve()) return std::nullopt;
  BundleResult result;
  result.bundle.camera = start.camera;
  if (!options.fixed_camera) {
    set_numbers(result.bundle.camera, fit.intrinsics, options.square_pixels);
  }
  double squares = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    result.bundle.poses.push_back(stepped(start.poses[v], fit.steps[v]));
    double sum = 0;
    for (std::size_t i = 0; i < views[v].ids.size(); ++i) {
      const Eigen::Vector2d at =
          seen_at(result.bundle, v, board.point(views[v].ids[i]), board.circle_diameter);
      sum += (at - views[v].pixels[i]).squaredNorm();
    }
    squares += sum;
    result.rms.push_back(std::sqrt(sum / static_cast<double>(views[v].ids.size())));
  }
  const int free_intrinsics =
      options.fixed_camera ? 0 : kIntrinsics - static_cast<int>(held_intrinsics(options).size());
  const double freedom = 2.0 * static_cast<double>(fit.points) - free_intrinsics -
                         6.0 * static_cast<double>(views.size());
  if (!std::isfinite(squares) || !(freedom > 0)) return std::nullopt;
  result.variance = squares / freedom;
  if (!options.fixed_camera) {
    auto covariance = camera_covariance(fit);
    if (!covariance) return std::nullopt;
    result.camera_covariance = result.variance * *covariance;
    if (options.square_pixels) {
      result.camera_covariance.row(1) = result.camera_covariance.row(0);
      result.camera_covariance.col(1) = result.camera_covariance.col(0);
    }
  }
  for (std::size_t v = 0; v < views.size(); ++v) {
    const auto covariance = step_covariance(board, views[v], result.bundle, v, options);
    if (!covariance) return std::nullopt;
    result.pose_covariance.push_back(result.variance * *covariance);
  }
  return result;
}

}  // namespace facula
