// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/register/global_registration.hpp>
#include <facula/tests/reconstruct/simulated_rooms.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

RigidTransform standing(double x, double y, double yaw) {
  RigidTransform pose;
  pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  pose.translation = {x, y, 1.5};
  return pose;
}

/// 7 m by 5 m by 2.8 m, with a cupboard, a table and a pillar.
std::vector<RoomBox> furnished_room() {
  return {{{0, 0, 0}, {7, 5, 2.8}},
          {{0.0, 3.0, 0}, {0.6, 4.5, 2.1}},
          {{4.0, 0.5, 0}, {5.6, 1.3, 0.75}},
          {{5.8, 3.6, 0}, {6.2, 4.0, 2.8}}};
}

std::vector<RoomBox> square_room() {
  return {{{-3, -3, 0}, {3, 3, 2.8}}};
}

ScanPyramid room_pyramid(const std::vector<RoomBox>& room,
                         const RigidTransform& pose,
                         std::uint64_t seed) {
  return build_pyramid(scan_of_room(room, {.world_from_scan = pose, .step = 0.025, .seed = seed}));
}

struct RoomPair {
  ScanPyramid source;
  ScanPyramid target;
  RigidTransform truth;
};

RoomPair furnished_pair() {
  const RigidTransform first = standing(2, 1.6, 0.3);
  const RigidTransform second = standing(4.8, 3, 2.4);
  return {room_pyramid(furnished_room(), second, 2),
          room_pyramid(furnished_room(), first, 1),
          first.inverse() * second};
}

void expect_room_found(GlobalMethod method) {
  const RoomPair pair = furnished_pair();
  for (const std::uint64_t seed : {1, 2}) {
    const GlobalResult result =
        register_without_guess(pair.source, pair.target, {.method = method, .seed = seed});
    EXPECT_EQ(result.verdict, Verdict::kAccepted) << result.reason;
    EXPECT_TRUE(is_near_pose(result.pair.target_from_source, pair.truth, 0.05 * kDegree, 0.003));
    EXPECT_LT(result.score.contradiction, 0.05);
    EXPECT_GT(result.score.overlap, 0.5);
  }
}

TEST(GlobalRegistration, FindsAFurnishedRoomByTriplesOfPlanes) {
  expect_room_found(GlobalMethod::kPlanes);
}

TEST(GlobalRegistration, FindsAFurnishedRoomByItsFeatures) {
  expect_room_found(GlobalMethod::kFeatures);
}

TEST(GlobalRegistration, CallsASquareEmptyRoomAmbiguousAndNamesTheOtherPoses) {
  const RigidTransform first = standing(1.1, 0.4, 0);
  const RigidTransform second = standing(-0.7, 0.9, 0.5);
  const GlobalResult result = register_without_guess(room_pyramid(square_room(), second, 2),
                                                     room_pyramid(square_room(), first, 1));
  EXPECT_EQ(result.verdict, Verdict::kAmbiguous) << result.reason;
  ASSERT_GE(result.rivals.size(), 3U) << result.reason;
  // The truth or one of its quarter turns about the room's middle, each once.
  const RigidTransform truth = first.inverse() * second;
  int true_ones = is_near_pose(result.pair.target_from_source, truth, kDegree, 0.01) ? 1 : 0;
  for (const PairResult& rival : result.rivals) {
    if (is_near_pose(rival.target_from_source, truth, kDegree, 0.01)) ++true_ones;
  }
  EXPECT_EQ(true_ones, 1);
}

/// A round pillar seen from all sides: any turn about its axis explains it.
TEST(GlobalRegistration, DoesNotAcceptACylinderWhoseTurnNothingShows) {
  Random random(3);
  const auto pillar = [&](double from) {
    PosedCloud scan;
    scan.name = "pillar";
    for (int i = 0; i < 6000; ++i) {
      const double angle = 2 * M_PI * random.uniform();
      const Eigen::Vector3f side(float(std::cos(angle)), float(std::sin(angle)), 0);
      const auto height = static_cast<float>(from + random.uniform());
      scan.cloud.points.emplace_back(0.2F * side + height * Eigen::Vector3f::UnitZ());
      scan.cloud.sensor_origin.emplace_back(3 * side + height * Eigen::Vector3f::UnitZ());
    }
    return build_pyramid(scan);
  };
  const GlobalResult result = register_without_guess(pillar(0), pillar(0));
  EXPECT_NE(result.verdict, Verdict::kAccepted) << result.reason;
}

TEST(GlobalRegistration, RefusesScansOfDifferentPlaces) {
  const std::vector<RoomBox> other{{{0, 0, 0}, {3.1, 9, 4.1}}, {{1, 2, 0}, {2, 5, 1.2}}};
  const GlobalResult result =
      register_without_guess(room_pyramid(other, standing(1.5, 6.5, 0), 2),
                             room_pyramid(furnished_room(), standing(2, 1.6, 0), 1));
  EXPECT_EQ(result.verdict, Verdict::kRefused) << result.reason;
  EXPECT_FALSE(result.reason.empty());
  EXPECT_EQ(result.reason.find('\n'), std::string::npos);
}

TEST(GlobalRegistration, GivesTheSameBitsForOneAndTwoThreads) {
  const RoomPair pair = furnished_pair();
  const auto run = [&](int threads) {
    return register_without_guess(pair.source, pair.target, {.seed = 5, .num_threads = threads});
  };
  const GlobalResult one = run(1);
  const GlobalResult two = run(2);
  EXPECT_EQ(one.pair.target_from_source.matrix(), two.pair.target_from_source.matrix());
  EXPECT_EQ(one.pair.covariance, two.pair.covariance);
  EXPECT_EQ(one.score.overlap, two.score.overlap);
  EXPECT_EQ(one.score.inlier_rms, two.score.inlier_rms);
  EXPECT_EQ(one.reason, two.reason);
}

TEST(GlobalRegistration, JudgesTheTruthAboveAPoseInFreeSpace) {
  const RoomPair pair = furnished_pair();
  const PoseScore truth = score_pose(pair.source, pair.target, pair.truth);
  EXPECT_GT(truth.overlap, 0.7);
  EXPECT_LT(truth.contradiction, 0.02);
  EXPECT_LT(truth.inlier_rms, 0.01);
  // The wrong corner of the room: half of it stands where the other scan looked through.
  RigidTransform wrong = pair.truth;
  wrong.translation += Eigen::Vector3d(1.5, 1.2, 0);
  const PoseScore off = score_pose(pair.source, pair.target, wrong);
  EXPECT_GT(off.contradiction, 0.2);
}

TEST(GlobalRegistration, RefusesOptionsAndScansItCannotUse) {
  const ScanPyramid scan = room_pyramid(square_room(), standing(0, 0, 0), 1);
  EXPECT_THROW(register_without_guess(scan, scan, {.min_overlap = 0}), Error);
  EXPECT_THROW(register_without_guess(scan, scan, {.min_overlap = NAN}), Error);
  EXPECT_THROW(register_without_guess(scan, scan, {.max_candidates = 1}), Error);
  EXPECT_THROW(register_without_guess(scan, scan, {.num_threads = -1}), Error);
  EXPECT_THROW(register_without_guess(ScanPyramid{}, scan), Error);
  EXPECT_THROW(score_pose(ScanPyramid{}, scan, {}), Error);
  EXPECT_THROW(register_without_guess(GlobalFeatures{}, GlobalFeatures{}), Error);
  EXPECT_THROW(find_global_features(scan, {.voxel = -1}), Error);
  EXPECT_THROW(find_global_features(scan, {.voxel = 100}), Error);
  const GlobalFeatures fine = find_global_features(scan, {.voxel = 0.2});
  const GlobalFeatures coarse = find_global_features(scan, {.voxel = 0.3});
  EXPECT_THROW(register_without_guess(fine, coarse), Error);
}

/// A single wall leaves two shifts and a turn open; it must not be taken for a pose.
TEST(GlobalRegistration, DoesNotAcceptASinglePlane) {
  Random random(8);
  const auto wall = [&] {
    PosedCloud scan;
    scan.name = "wall";
    add_patch(scan.cloud, {{0, -1, -1}, {0, 2, 0}, {0, 0, 2}}, 5000, 0.001, random);
    scan.cloud.sensor_origin.assign(scan.cloud.size(), Eigen::Vector3f(2, 0, 0));
    return build_pyramid(scan);
  };
  const GlobalResult result = register_without_guess(wall(), wall());
  EXPECT_NE(result.verdict, Verdict::kAccepted) << result.reason;
}

}  // namespace
}  // namespace facula
