// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/triangulate/sheet_table.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Lenses from none to worse than those of webcams; a plane and a cone.
std::vector<Rig> rigs() {
  std::vector<Rig> all;
  for (const double k1 : {0.0, -0.35, 0.2}) {
    for (const double bow : {0.0, 0.02}) {
      Rig rig;
      rig.camera = {.width = 640,
                    .height = 480,
                    .fx = 600,
                    .fy = 610,
                    .cx = 310.2,
                    .cy = 243.7,
                    .k1 = k1,
                    .k2 = -0.4 * k1,
                    .p1 = k1 * 0.01,
                    .p2 = -k1 * 0.02};
      rig.lasers = small_head().lasers;
      rig.lasers[0].bow = bow;
      all.push_back(rig);
    }
  }
  return all;
}

TEST(SheetTable, MeetsTheSheetWhereTriangulateDoesToAMillionthOfAPixel) {
  for (const Rig& rig : rigs()) {
    const SheetTable table(rig, 0);
    EXPECT_LE(table.ray_error(), 1e-7) << "spacing " << table.spacing();
    Random random(3, 0);
    double worst_point = 0;
    double worst_sigma = 0;
    for (int i = 0; i < 20000; ++i) {
      const int row = std::min(479, static_cast<int>(480 * random.uniform()));
      const double position = -0.5 + 640 * random.uniform();
      const auto fast = table.at(row, position, 0.1);
      const auto exact = triangulate(rig, 0, {position, static_cast<double>(row)}, 0.1);
      ASSERT_EQ(fast.has_value(), exact.has_value()) << position << " in row " << row;
      if (!exact || exact->x_in_camera.z() > 20) continue;
      // One pixel is sigma / 0.1 along the ray.
      worst_point = std::max(
          worst_point, (fast->x_in_camera - exact->x_in_camera).norm() / (exact->sigma / 0.1));
      // Depth goes as 1 / u, u pixels from where the sheet vanishes: the reference's difference
      // over one pixel is too large by (0.5 / u)^2, and u is the distance over its derivative.
      const double u = exact->x_in_camera.norm() / (exact->sigma / 0.1);
      const double expected = 1 + 0.25 / (u * u);
      worst_sigma = std::max(worst_sigma, std::abs(exact->sigma / fast->sigma / expected - 1));
    }
    EXPECT_LT(worst_point, 1e-6) << "k1 " << rig.camera.k1 << " bow " << rig.lasers[0].bow;
    EXPECT_LT(worst_sigma, 1e-3) << "k1 " << rig.camera.k1 << " bow " << rig.lasers[0].bow;
  }
}

/// sigma = |dx/du . ray| by a difference so small that its own error vanishes.
TEST(SheetTable, TakesSigmaFromTheDerivative) {
  const Rig rig = rigs()[3];
  const SheetTable table(rig, 0);
  for (const double position : {260.3, 390.6, 630.4}) {
    const double h = 1e-3;
    const auto here = table.at(100, position, 1);
    const auto before = triangulate(rig, 0, {position - h, 100}, 1);
    const auto after = triangulate(rig, 0, {position + h, 100}, 1);
    ASSERT_TRUE(here && before && after);
    const double slope =
        (after->x_in_camera - before->x_in_camera).dot(here->x_in_camera.normalized()) / (2 * h);
    EXPECT_NEAR(here->sigma / std::abs(slope), 1, 1e-6);
  }
}

TEST(SheetTable, AnswersForAStripePerColumnAndBeyondTheImage) {
  Rig rig = rigs()[3];
  rig.stripe_direction = StripeDirection::kPerColumn;
  std::swap(rig.lasers[0].normal.x(), rig.lasers[0].normal.y());
  const SheetTable table(rig, 0);
  for (const double position : {-3.0, 0.0, 100.25, 300.75, 479.5, 490.0}) {
    const auto fast = table.at(320, position, 0.1);
    const auto exact = triangulate(rig, 0, {320, position}, 0.1);
    ASSERT_EQ(fast.has_value(), exact.has_value()) << position;
    if (!exact) continue;
    EXPECT_LT((fast->x_in_camera - exact->x_in_camera).norm(), 1e-6 * exact->sigma / 0.1)
        << position;
  }
}

TEST(SheetTable, IsTheSameForAnyNumberOfThreads) {
  const Rig rig = rigs()[3];
  const SheetTable one(rig, 0, 1);
  const SheetTable many(rig, 0, 3);
  for (int row = 0; row < 480; row += 7) {
    const auto a = one.at(row, 323.4, 0.1);
    const auto b = many.at(row, 323.4, 0.1);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->x_in_camera, b->x_in_camera);
    EXPECT_EQ(a->sigma, b->sigma);
  }
}

}  // namespace
}  // namespace facula
