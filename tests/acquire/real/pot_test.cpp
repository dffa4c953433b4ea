// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace facula {
namespace {

struct TablePlane {
  Eigen::Vector3d centre;
  Eigen::Vector3d normal;
  double rms = 0;          ///< [m]
  std::size_t points = 0;  ///< [1]
};

/// Least squares over the points of the table, three rounds of leaving out what is over 3 RMS: the
/// pot's foot and crumbs stand on it.
TablePlane fit_table(std::vector<Eigen::Vector3d> points) {
  TablePlane plane;
  for (int round = 0; round < 4; ++round) {
    plane.centre.setZero();
    for (const auto& p : points) plane.centre += p / static_cast<double>(points.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& p : points) scatter += (p - plane.centre) * (p - plane.centre).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    plane.normal = solver.eigenvectors().col(0);
    if (plane.normal.z() < 0) plane.normal = -plane.normal;
    plane.rms = std::sqrt(solver.eigenvalues()[0] / static_cast<double>(points.size() - 3));
    plane.points = points.size();
    std::erase_if(points, [&](const Eigen::Vector3d& p) {
      return std::abs(plane.normal.dot(p - plane.centre)) > 3 * plane.rms;
    });
  }
  return plane;
}

TEST(PotSet, GivesAFlatTableAndTheRimAtItsHeight) {
  FACULA_REQUIRE_REAL_DATA(frames, "laser/caltag_turntable_pot");
  const Capture capture = read_capture(shipped_data("captures/caltag_turntable_pot"), frames);
  const ExtractResult result = extract_scan(capture);
  EXPECT_EQ(result.frames, 72U);
  EXPECT_GE(result.scan.valid_count(), 28000U);

  std::vector<Eigen::Vector3d> all;
  std::vector<Eigen::Vector3d> table;
  for (std::size_t i = 0; i < result.scan.valid.size(); ++i) {
    if (result.scan.valid[i] == 0) continue;
    all.push_back(result.scan.point[i].cast<double>());
    const Eigen::Vector3d& p = all.back();
    if (std::abs(p.z() + 0.005) < 0.006 && p.head<2>().norm() > 0.06) table.push_back(p);
  }
  const TablePlane plane = fit_table(table);
  RecordProperty("table_rms_um", static_cast<int>(plane.rms * 1e6));
  EXPECT_GT(plane.points, 8000U);
  EXPECT_LE(plane.rms, 0.55e-3);

  // The rim is the top: the highest half per cent of the points.
  std::vector<double> heights;
  for (const auto& p : all) heights.push_back(plane.normal.dot(p - plane.centre));
  const auto top = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() * 995 / 1000);
  std::nth_element(heights.begin(), top, heights.end());
  EXPECT_NEAR(*top, 0.121, 0.003);
  const auto in_the_air =
      std::count_if(heights.begin(), heights.end(), [](double h) { return h > 0.126; });
  EXPECT_LT(in_the_air, 20) << "points above the rim";
}

/// The two handles stand out of the body's circle on opposite sides, between 60 and 115 mm up.
TEST(PotSet, ShowsBothHandles) {
  FACULA_REQUIRE_REAL_DATA(frames, "laser/caltag_turntable_pot");
  const PolarScan scan =
      extract_scan(read_capture(shipped_data("captures/caltag_turntable_pot"), frames)).scan;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> ring;
  for (std::size_t i = 0; i < scan.valid.size(); ++i) {
    const Eigen::Vector3d p = scan.point[i].cast<double>();
    if (scan.valid[i] != 0 && p.z() > 0.075 && p.z() < 0.095) ring.emplace_back(p.x(), p.y());
  }
  ASSERT_GT(ring.size(), 1000U);
  for (const auto& p : ring) centre += p / static_cast<double>(ring.size());
  std::vector<double> reach(36, 0);
  for (const auto& p : ring) {
    const double yaw = std::atan2(p.y() - centre.y(), p.x() - centre.x());
    auto& r = reach[static_cast<std::size_t>((yaw + M_PI) / (2 * M_PI) * 35.999)];
    r = std::max(r, (p - centre).norm());
  }
  std::vector<double> sorted = reach;
  std::sort(sorted.begin(), sorted.end());
  const double body = sorted[18];
  int handles = 0;
  for (std::size_t k = 0; k < 36; ++k) {
    const bool out = reach[k] > body + 0.012;
    const bool out_before = reach[(k + 35) % 36] > body + 0.012;
    handles += out && !out_before ? 1 : 0;
  }
  EXPECT_EQ(handles, 2);
}

}  // namespace
}  // namespace facula
