// SPDX-License-Identifier: GPL-3.0-or-later
// Set range/os3ds-rotating-lidar: one corner of a room, scanned again and again by a home-built
// scanner. Its notes give the angles of its planes over the scans, mean and standard deviation.
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>
#include <facula/reconstruct/register/pan_tilt_list.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

const std::vector<std::string> kScans = {"210716-1531-LiDAR-90-Moderate",
                                         "210716-1613-LiDAR-90-Moderate",
                                         "210716-1632-LiDAR-90-Moderate",
                                         "210716-1658-LiDAR-90-Moderate",
                                         "210716-1718-LiDAR-90-Fine",
                                         "210718-2226-LiDAR-90-Fine"};

/// The largest plane that looks along `axis`.
std::optional<PlaneFit> plane_along(const std::vector<ExtractedPlane>& planes,
                                    const Eigen::Vector3d& axis) {
  for (const ExtractedPlane& plane : planes) {
    if (plane.fit.plane.normal.dot(axis) > 0.95) return plane.fit;
  }
  return {};
}

struct Series {
  std::vector<double> values;
  double mean() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / double(values.size());
  }
  double spread() const {
    double squares = 0;
    for (const double v : values) squares += (v - mean()) * (v - mean());
    return std::sqrt(squares / double(values.size() - 1));
  }
};

struct Corner {
  Series ab, ac, bc, a, b, c;
};

/// Angles of the normals, as the notes give them (180 degrees less the corner's) [deg] and
/// distances [mm] of the two walls A, B and the ceiling C over the scans.
Corner corner_at(const std::filesystem::path& folder, double tilt_zero) {
  Corner corner;
  for (const std::string& name : kScans) {
    PointCloud cloud = posed_cloud(read_pan_tilt_list(folder / (name + ".csv")), tilt_zero).cloud;
    estimate_normals(cloud);
    // The notes' band of 15 mm.
    const auto planes = extract_planes(cloud, {.inlier_distance = 0.015, .min_points = 100});
    const auto a = plane_along(planes, Eigen::Vector3d::UnitX());
    const auto b = plane_along(planes, Eigen::Vector3d::UnitY());
    const auto c = plane_along(planes, Eigen::Vector3d::UnitZ());
    EXPECT_TRUE(a && b && c) << name;
    if (!a || !b || !c) continue;
    corner.ab.values.push_back(180 - measured_corner(*a, *b).value / kDegree);
    corner.ac.values.push_back(180 - measured_corner(*a, *c).value / kDegree);
    corner.bc.values.push_back(180 - measured_corner(*b, *c).value / kDegree);
    corner.a.values.push_back(1000 * a->plane.distance);
    corner.b.values.push_back(1000 * b->plane.distance);
    corner.c.values.push_back(1000 * c->plane.distance);
  }
  return corner;
}

TEST(CornerRealData, WallsStandAsTheNotesOfTheSetSay) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/os3ds-rotating-lidar");
  const Corner corner = corner_at(folder, 0);
  EXPECT_NEAR(corner.ab.mean(), 90.10, 0.35);
  EXPECT_LT(corner.ab.spread(), 0.45);  // six of the notes' twelve scans
  // Within 2 of the notes' standard deviations of 2.3 and 2.1 degrees.
  EXPECT_NEAR(corner.ac.mean(), 92.77, 4.7);
  EXPECT_NEAR(corner.bc.mean(), 92.95, 4.2);
  EXPECT_NEAR(corner.a.mean(), 1136.4, 3.5);
  EXPECT_NEAR(corner.b.mean(), 1668.0, 3.9);
  EXPECT_NEAR(corner.c.mean(), 1058.3, 8.6);
}

TEST(CornerRealData, IsSquareOnceTheTiltIsPutRight) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/os3ds-rotating-lidar");
  const Corner corner = corner_at(folder, -8 * kDegree);
  EXPECT_NEAR(corner.ab.mean(), 90.30, 0.35);
  EXPECT_LT(corner.ab.spread(), 0.45);
  EXPECT_NEAR(corner.ac.mean(), 89.66, 0.59);
  EXPECT_NEAR(corner.bc.mean(), 90.18, 0.53);
  EXPECT_NEAR(corner.a.mean(), 1136.3, 3.4);
  EXPECT_NEAR(corner.b.mean(), 1671.3, 5.2);
}

}  // namespace
}  // namespace facula
