// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/register/pose_graph.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace facula {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kDegree = M_PI / 180;

Vector6 normal_vector(Random& random) {
  Vector6 v;
  for (int k = 0; k < 6; ++k) v[k] = random.normal();
  return v;
}

/// A covariance with millimetres and milliradians on its diagonal, all entries filled.
Matrix6 random_covariance(Random& random) {
  Matrix6 a;
  for (int k = 0; k < 6; ++k) a.col(k) = normal_vector(random);
  return 1e-6 * (a * a.transpose() / 6 + 0.3 * Matrix6::Identity());
}

std::vector<RigidTransform> random_poses(std::size_t count, Random& random) {
  std::vector<RigidTransform> poses(count);
  for (std::size_t i = 1; i < count; ++i) poses[i] = exp_se3(1.5 * normal_vector(random));
  return poses;
}

RigidTransform relative(const std::vector<RigidTransform>& truth,
                        std::size_t from,
                        std::size_t to) {
  return truth[to].inverse() * truth[from];
}

/// An edge as measured: true = exp(e) * measured, e drawn from the covariance.
PoseEdge measured(const std::vector<RigidTransform>& truth,
                  std::size_t from,
                  std::size_t to,
                  Random& random) {
  const Matrix6 covariance = random_covariance(random);
  const Vector6 e = covariance.llt().matrixL() * normal_vector(random);
  return {from, to, exp_se3(-e) * relative(truth, from, to), covariance.inverse()};
}

/// A ring and chords: every scan with its next and second next.
std::vector<PoseEdge> ring(const std::vector<RigidTransform>& truth, Random& random) {
  std::vector<PoseEdge> edges;
  const std::size_t n = truth.size();
  for (std::size_t i = 0; i < n; ++i) {
    edges.push_back(measured(truth, i, (i + 1) % n, random));
    edges.push_back(measured(truth, (i + 2) % n, i, random));
  }
  return edges;
}

TEST(PoseGraph, ChainsEdgesWithoutLoopExactlyAndSaysThatNothingChecksThem) {
  Random random(3);
  const auto truth = random_poses(5, random);
  std::vector<PoseEdge> edges;
  for (std::size_t i = 0; i + 1 < 5; ++i) {
    edges.push_back({i + 1, i, relative(truth, i + 1, i), random_covariance(random).inverse()});
  }
  const auto result = solve_pose_graph(5, edges, std::vector<RigidTransform>(5));
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(is_near_pose(result.world_from_scan[i], truth[i], 1e-7, 1e-7)) << i;
    EXPECT_TRUE(result.connected[i]);
  }
  EXPECT_EQ(result.degrees_of_freedom, 0);
  for (const EdgeResidual& edge : result.edges) {
    EXPECT_FALSE(edge.outlier);
    EXPECT_NEAR(edge.redundancy, 0, 1e-6);
  }
}

TEST(PoseGraph, SharesTheGapOfALoopByVariance) {
  // Rotations are known far better than positions, so the loop is a levelling net along x: edge k
  // takes up gap * variance_k / sum of variances.
  const double variance[4] = {1e-6, 4e-6, 9e-6, 2e-6};
  const double gap = 0.016;
  std::vector<PoseEdge> edges;
  for (std::size_t k = 0; k < 4; ++k) {
    PoseEdge edge{(k + 1) % 4, k, {}, Matrix6::Identity()};
    edge.to_from_from.translation.x() = k < 3 ? 1.0 : -3.0 + gap;
    edge.information.topLeftCorner<3, 3>() *= 1 / variance[k];
    edge.information.bottomRightCorner<3, 3>() *= 1e12;
    edges.push_back(edge);
  }
  const auto result = solve_pose_graph(4, edges, std::vector<RigidTransform>(4), {.robust = false});
  for (std::size_t k = 0; k + 1 < 4; ++k) {
    const double length =
        result.world_from_scan[k + 1].translation.x() - result.world_from_scan[k].translation.x();
    EXPECT_NEAR(length, 1.0 - gap * variance[k] / 16e-6, 1e-9);
  }
  EXPECT_NEAR(result.chi2, gap * gap / 16e-6, 1e-6);
  EXPECT_EQ(result.degrees_of_freedom, 6);
  EXPECT_NEAR(result.covariance[1](0, 0), 1 / (1 / 1e-6 + 1 / 15e-6), 1e-12);
}

TEST(PoseGraph, AddsTheInformationOfTwoEdgesOfOnePair) {
  Random random(5);
  const Matrix6 a = random_covariance(random).inverse();
  const Matrix6 b = random_covariance(random).inverse();
  const RigidTransform pose = exp_se3(normal_vector(random));
  const auto result = solve_pose_graph(2, {{1, 0, pose, a}, {1, 0, pose, b}}, {{}, pose});
  const Matrix6 expected = (a + b).inverse();
  EXPECT_LT((result.covariance[1] - expected).norm(), 1e-6 * expected.norm());
  EXPECT_TRUE(result.covariance[0].isZero());
  EXPECT_NEAR(result.edges[0].redundancy + result.edges[1].redundancy, 1, 1e-6);
}

TEST(PoseGraph, SquaredErrorsFollowTheirCovariances) {
  int inside = 0;
  int poses = 0;
  double chi2 = 0;
  int freedom = 0;
  int outliers = 0;
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    Random random(7, trial);
    const auto truth = random_poses(8, random);
    const auto result = solve_pose_graph(8, ring(truth, random), truth);
    chi2 += result.chi2;
    freedom += result.degrees_of_freedom;
    for (const EdgeResidual& edge : result.edges) outliers += edge.outlier ? 1 : 0;
    for (std::size_t i = 1; i < 8; ++i) {
      const Vector6 error = log_se3(truth[i] * result.world_from_scan[i].inverse());
      inside += error.dot(result.covariance[i].ldlt().solve(error)) < 12.592 ? 1 : 0;
      ++poses;
    }
  }
  EXPECT_EQ(freedom, 60 * (16 * 6 - 7 * 6));
  EXPECT_NEAR(chi2 / freedom, 1, 0.1);
  // 95 % of chi2 with six degrees of freedom.
  EXPECT_NEAR(double(inside) / poses, 0.95, 0.04);
  EXPECT_LE(outliers, 3);
}

TEST(PoseGraph, NamesExactlyTheWrongEdgesAndComesToTheSamePoses) {
  for (std::uint64_t trial = 0; trial < 10; ++trial) {
    Random random(11, trial);
    const auto truth = random_poses(10, random);
    std::vector<PoseEdge> edges = ring(truth, random);
    const auto clean = solve_pose_graph(10, edges, truth);
    for (int wrong = 0; wrong < 8; ++wrong) {
      const std::size_t from = random.below(10);
      const std::size_t to = (from + 1 + random.below(9)) % 10;
      edges.push_back({from, to, exp_se3(normal_vector(random)), edges[0].information});
    }
    // The start is that of a chain through the ring.
    std::vector<RigidTransform> start(10);
    for (std::size_t i = 1; i < 10; ++i) {
      start[i] = start[i - 1] * edges[2 * (i - 1)].to_from_from.inverse();
    }
    const auto result = solve_pose_graph(10, edges, start);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      EXPECT_EQ(result.edges[e].outlier, e >= 20) << "trial " << trial << " edge " << e;
    }
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_TRUE(is_near_pose(result.world_from_scan[i], clean.world_from_scan[i], 1e-6, 1e-6));
    }
  }
}

TEST(PoseGraph, CutsOffWhatOnlyWrongEdgesJoin) {
  Random random(13);
  const auto truth = random_poses(6, random);
  std::vector<PoseEdge> edges;
  for (const std::size_t base : {std::size_t{0}, std::size_t{3}}) {
    for (std::size_t a = 0; a < 3; ++a) {
      edges.push_back(measured(truth, base + a, base + (a + 1) % 3, random));
    }
  }
  const auto apart = solve_pose_graph(6, edges, truth);
  EXPECT_EQ(apart.component, (std::vector<std::size_t>{0, 0, 0, 3, 3, 3}));
  EXPECT_EQ(apart.connected, (std::vector<bool>{true, true, true, false, false, false}));
  EXPECT_EQ(apart.degrees_of_freedom, 12);
  EXPECT_TRUE(apart.covariance[3].isZero());

  // Two joints that contradict each other: one loses, and the loser is named.
  edges.push_back(measured(truth, 0, 3, random));
  edges.push_back(measured(truth, 1, 4, random));
  edges.push_back({2, 5, exp_se3(normal_vector(random)), edges[0].information});
  const auto joined = solve_pose_graph(6, edges, truth);
  EXPECT_TRUE(joined.connected[5]);
  EXPECT_TRUE(joined.edges.back().outlier);
}

TEST(PoseGraph, LeavesHugeVarianceWhereEdgesMeasureNothing) {
  PoseEdge edge{1, 0, {}, Matrix6::Zero()};
  edge.information.diagonal() << 1e6, 0, 1e6, 1e6, 1e6, 1e6;  // slides along y
  const auto result = solve_pose_graph(2, {edge}, {{}, exp_se3(Vector6::Constant(0.01))});
  EXPECT_GT(result.covariance[1](1, 1), 1e3);
  EXPECT_NEAR(result.covariance[1](0, 0), 1e-6, 1e-9);
  EXPECT_NEAR(result.world_from_scan[1].translation.x(), 0, 1e-6);
  EXPECT_GT(result.world_from_scan[1].translation.y(), 0.005) << "must stay where the guess is";
}

TEST(PoseGraph, KeepsTheAnchorWhereItIs) {
  Random random(17);
  const auto truth = random_poses(5, random);
  const auto result = solve_pose_graph(5, ring(truth, random), truth, {.anchor = 3});
  EXPECT_TRUE(is_near_pose(result.world_from_scan[3], truth[3], 1e-12, 1e-12));
  EXPECT_FALSE(is_near_pose(result.world_from_scan[0], truth[0], 1e-9, 1e-9));
}

TEST(PoseGraph, RefusesGraphsThatCannotBe) {
  const std::vector<RigidTransform> two(2);
  EXPECT_NE(error_of([&] {
              solve_pose_graph(2, {{0, 2, {}}}, two);
            }).find("scan 2 of 2"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              solve_pose_graph(2, {{1, 1, {}}}, two);
            }).find("two different"),
            std::string::npos);
  EXPECT_NE(error_of([&] { solve_pose_graph(3, {}, two); }).find("expected 3"), std::string::npos);
  PoseEdge negative{0, 1, {}, -Matrix6::Identity()};
  EXPECT_NE(error_of([&] { solve_pose_graph(2, {negative}, two); }).find("positive"),
            std::string::npos);
  PoseEdge broken{0, 1, {}, Matrix6::Identity()};
  broken.to_from_from.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of([&] { solve_pose_graph(2, {broken}, two); }).find("finite"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
