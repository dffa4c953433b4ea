// SPDX-License-Identifier: GPL-3.0-or-later
// Angles and distances of planes seen in several scans whose poses are wrong by what they state:
// the stated uncertainty against the spread over many drawn pose errors (GUM supplement 1).
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>
#include <facula/reconstruct/measure/pose_errors.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <functional>
#include <numeric>

#include <gtest/gtest.h>

namespace facula {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int kTrials = 1500;
// A chi-squared over 1 500 degrees of freedom divided by them lies within this of 1 in 999 of 1
// 000.
const double kBound = 3.29 * std::sqrt(2.0 / kTrials);

/// Points of a rectangle of 1 m by 0.6 m, from `from` to `to` of its length.
std::vector<Eigen::Vector3d> surface(const Eigen::Vector3d& middle,
                                     const Eigen::Vector3d& normal,
                                     double from = 0,
                                     double to = 1) {
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.normalized().cross(u);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k < 6; ++k) {
      points.emplace_back(middle + (from + (to - from) * i / 11 - 0.5) * u + 0.12 * (k - 2.5) * v);
    }
  }
  return points;
}

/// A covariance whose parts correlate: 2 mm and 1 mrad, about.
Matrix6 some_covariance(std::uint64_t seed) {
  Random random(seed);
  Matrix6 root;
  for (Eigen::Index i = 0; i < 36; ++i) root(i / 6, i % 6) = random.normal();
  root.topRows<3>() *= 0.001;
  root.bottomRows<3>() *= 0.0005;
  return root * root.transpose();
}

Vector6 draw(const Matrix6& covariance, Random& random) {
  Vector6 z;
  for (double& part : z) part = random.normal();
  const Matrix6 root = covariance.llt().matrixL();
  return root * z;
}

/// What was scanned: pieces of planes 0 and 1, by the scan that saw them.
struct Piece {
  std::uint32_t scan;
  int plane;
  std::vector<Eigen::Vector3d> points;  ///< where they truly are
};

/// The two planes as they are measured by scans with wrong poses, with the truth beside.
class Measurement {
 public:
  explicit Measurement(std::vector<Piece> pieces, double voxel = 0)
      : pieces_(std::move(pieces)), voxel_(voxel) {
    project_.scans.resize(3);
    for (std::size_t i = 0; i < 3; ++i) project_.scans[i].pose_covariance = some_covariance(i + 1);
  }

  /// The planes, once the poses are wrong by draws from their covariances times `size`.
  std::vector<PlaneFit> planes(Random& random, double size) {
    std::vector<RigidTransform> wrong;
    for (PosedCloud& scan : project_.scans) {
      scan.cloud.points.clear();
      // true pose = exp(e) estimate: what the estimate makes of the scan is off by exp(e)^-1.
      wrong.push_back(exp_se3(size * draw(scan.pose_covariance, random)).inverse());
    }
    std::vector<std::vector<int>> plane_of(3);
    for (const Piece& piece : pieces_) {
      for (const Eigen::Vector3d& x : piece.points) {
        const Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
        project_.scans[piece.scan].cloud.points.emplace_back(
            (wrong[piece.scan] * x + (size > 0 ? 1e-5 : 0) * noise).cast<float>());
        plane_of[piece.scan].push_back(piece.plane);
      }
    }
    std::vector<int> planes;
    for (const auto& of : plane_of) planes.insert(planes.end(), of.begin(), of.end());
    return fitted(planes);
  }

 private:
  std::vector<PlaneFit> fitted(std::vector<int> plane_of) const {
    PointCloud cloud = project_.fused();
    PoseErrors errors = pose_errors(project_);
    if (voxel_ > 0) {
      std::vector<std::uint32_t> voxel_of;
      cloud = thin_by_voxel(cloud, voxel_, &voxel_of);
      errors = thinned(errors, voxel_of, cloud.size());
      std::vector<int> of(cloud.size());
      for (std::size_t i = 0; i < voxel_of.size(); ++i) of[voxel_of[i]] = plane_of[i];
      plane_of = of;
    }
    std::vector<PlaneFit> fits;
    for (const int plane : {0, 1}) {
      std::vector<std::size_t> indices;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (plane_of[i] == plane) indices.push_back(i);
      }
      fits.push_back(fit_plane(cloud, indices, {.poses = &errors}));
    }
    return fits;
  }

  std::vector<Piece> pieces_;
  double voxel_;
  ScanProject project_;
};

using Relation = std::function<Measured(const PlaneFit&, const PlaneFit&)>;

/// Mean of (error / stated sigma)^2 over the trials: 1 for an honest sigma.
double chi_squared(Measurement measurement, const Relation& relation) {
  Random none(1);
  const std::vector<PlaneFit> exact = measurement.planes(none, 0);
  const double truth = relation(exact[0], exact[1]).value;
  Random random(5);
  double sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<PlaneFit> fits = measurement.planes(random, 1);
    const Measured m = relation(fits[0], fits[1]);
    sum += std::pow((m.value - truth) / m.sigma, 2);
  }
  return sum / kTrials;
}

Measured angle(const PlaneFit& a, const PlaneFit& b) {
  return measured_angle(a, b);
}

Measured distance(const PlaneFit& a, const PlaneFit& b) {
  return measured_distance(a, b);
}

Measured lean(const PlaneFit& a, const PlaneFit&) {
  return measured_angle_to(a, {0, 0, 1});
}

/// The same by the poses' part of the uncertainty alone.
Measured lean_by_poses(const PlaneFit& a, const PlaneFit& b) {
  PlaneFit of_poses = a;
  of_poses.covariance.setZero();
  return lean(of_poses, b);
}

const Eigen::Vector3d kWall(1, 0.2, 0.1);
const Eigen::Vector3d kOther(0.2, 1, -0.1);

TEST(PoseErrors, AreInTheAngleOfPlanesOfTwoScans) {
  const Measurement measurement(
      {{0, 0, surface({3, 0, 1}, kWall)}, {2, 1, surface({1, 4, 0.5}, kOther)}});
  EXPECT_NEAR(chi_squared(measurement, angle), 1, kBound);
  EXPECT_NEAR(chi_squared(measurement, lean), 1, kBound);
}

TEST(PoseErrors, AreInTheDistanceOfPlanesOfTwoScans) {
  const Measurement measurement(
      {{0, 0, surface({3, 0, 1}, kWall)}, {1, 1, surface({-1, 2, 0.5}, kWall)}});
  EXPECT_NEAR(chi_squared(measurement, distance), 1, kBound);
}

TEST(PoseErrors, CancelWithinOneScan) {
  Measurement measurement(
      {{1, 0, surface({3, 0, 1}, kWall)}, {1, 1, surface({1, 4, 0.5}, kOther)}});
  // What is left is the noise of the points.
  EXPECT_NEAR(chi_squared(measurement, angle), 69.0 / 67, kBound);  // Student
  Random random(2);
  const std::vector<PlaneFit> fits = measurement.planes(random, 1);
  const double told = measured_angle(fits[0], fits[1]).sigma;
  EXPECT_LT(told, 3e-5);
  std::vector<PlaneFit> exact = fits;
  for (PlaneFit& fit : exact) fit.pose_response.resize(3, 0);
  EXPECT_NEAR(told, measured_angle(exact[0], exact[1]).sigma, 1e-3 * told);
  // Against the world they do not.
  EXPECT_GT(lean(fits[0], fits[0]).sigma, 2e-4);
}

TEST(PoseErrors, AreSharedByTheScansOfOnePlane) {
  const Measurement measurement({{0, 0, surface({3, 0, 1}, kWall, 0, 0.5)},
                                 {1, 0, surface({3, 0, 1}, kWall, 0.4, 1)},
                                 {1, 1, surface({1, 4, 0.5}, kOther)}});
  EXPECT_NEAR(chi_squared(measurement, lean_by_poses), 1, kBound);
  // What the poses tear apart shows in the points' scatter too and counts there once more.
  EXPECT_LT(chi_squared(measurement, lean), 1);
  EXPECT_GT(chi_squared(measurement, lean), 0.6);
  EXPECT_NEAR(chi_squared(measurement, angle), 1, kBound);
}

TEST(PoseErrors, SurviveThinning) {
  // Voxels of 0.2 m: most hold points of both scans.
  const Measurement measurement({{0, 0, surface({3, 0, 1}, kWall, 0, 0.8)},
                                 {1, 0, surface({3, 0, 1}, kWall, 0.2, 1)},
                                 {2, 1, surface({1, 4, 0.5}, kOther)}},
                                0.2);
  EXPECT_NEAR(chi_squared(measurement, angle), 1, kBound);
}

TEST(PoseErrors, GiveEveryThinnedPointItsScansByTheirPoints) {
  ScanProject project;
  project.scans.resize(2);
  project.scans[0].cloud.points = {{0.1F, 0, 0}, {0.2F, 0, 0}, {1.5F, 0, 0}};
  project.scans[1].cloud.points = {{0.3F, 0, 0}, {NAN, 0, 0}};
  EXPECT_TRUE(pose_errors(project).empty());
  project.scans[1].pose_covariance = some_covariance(1);
  std::vector<std::uint32_t> voxel_of;
  const PointCloud cloud = thin_by_voxel(project.fused(), 1.0, &voxel_of);
  EXPECT_EQ(voxel_of, (std::vector<std::uint32_t>{0, 0, 1, 0, kNoVoxel}));
  const PoseErrors errors = thinned(pose_errors(project), voxel_of, cloud.size());
  EXPECT_EQ(errors.first, (std::vector<std::size_t>{0, 2, 3}));
  ASSERT_EQ(errors.shares.size(), 3U);
  EXPECT_EQ(errors.shares[0].scan, 0U);
  EXPECT_NEAR(errors.shares[0].share, 2.0 / 3, 1e-6);
  EXPECT_EQ(errors.shares[1].scan, 1U);
  EXPECT_NEAR(errors.shares[1].share, 1.0 / 3, 1e-6);
  EXPECT_EQ(errors.shares[2].share, 1);
  EXPECT_TRUE((errors.root[1] * errors.root[1].transpose()).isApprox(some_covariance(1), 1e-12));
}

TEST(PoseErrors, RefuseWhatDoesNotFit) {
  ScanProject project;
  project.scans.resize(1);
  project.scans[0].cloud.points = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  project.scans[0].pose_covariance = some_covariance(1);
  const PoseErrors errors = pose_errors(project);
  EXPECT_NE(error_of([&] { thinned(errors, {0}, 1); }).find("every one of 3"), std::string::npos);
  PointCloud more = project.scans[0].cloud;
  more.points.emplace_back(1, 1, 1);
  EXPECT_NE(error_of([&] { fit_plane(more, {.poses = &errors}); }).find("3 points"),
            std::string::npos);
  project.scans[0].pose_covariance(0, 0) = NAN;
  EXPECT_NE(error_of([&] { pose_errors(project); }).find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace facula
