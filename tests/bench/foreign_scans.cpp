// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/simulate/simulate.hpp>
#include <facula/tests/bench/foreign_scans.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace facula {
namespace {

/// Height above z = 0 of what is seen at (x, y), all in millimetres; NaN where nothing is.
template <typename Height>
PosedCloud seen_from_above(const std::string& name, const Height& height) {
  PosedCloud scan;
  scan.name = name;
  Random random(7, name.size());
  for (int row = -160; row <= 160; ++row) {
    for (int column = -160; column <= 160; ++column) {
      const double x = 0.5 * column;
      const double y = 0.5 * row;
      const double z = height(x, y);
      if (!std::isfinite(z)) continue;
      const Eigen::Vector3d p(x, y, z + 0.1 * random.normal());
      scan.cloud.points.emplace_back((0.001 * p).cast<float>());
      scan.cloud.sensor_origin.emplace_back(scan.cloud.points.back() + Eigen::Vector3f::UnitZ());
    }
  }
  return scan;
}

PosedCloud seen_by_head(const std::string& name, const Scene& scene) {
  static const Rig rig = read_rig(shipped_data("rigs/head_fs1500.toml"));
  std::vector<double> positions;
  for (int k = 0; k < 150; ++k) positions.push_back(2 * std::numbers::pi * k / 150);
  const RigidTransform pose{Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ())),
                            {0.4, 0.2, 1.1}};
  const PolarScan scan = true_scan(scene, rig, pose, positions, options_for(rig));
  PosedCloud seen;
  seen.name = name;
  seen.cloud = cloud_from_scan(scan);
  seen.grid = grid_from_scan(scan);
  Random random(8, name.size());
  for (std::size_t i = 0; i < seen.cloud.size(); ++i) {
    Eigen::Vector3f& p = seen.cloud.points[i];
    const Eigen::Vector3f ray = (p - seen.cloud.sensor_origin[i]).normalized();
    p += static_cast<float>(0.001 * random.normal()) * ray;
  }
  return seen;
}

PosedCloud scaled(PosedCloud scan, const std::string& name, float factor) {
  scan.name = name;
  for (Eigen::Vector3f& p : scan.cloud.points) p *= factor;
  for (Eigen::Vector3f& p : scan.cloud.sensor_origin) p *= factor;
  return scan;
}

PosedCloud furnished() {
  return seen_by_head("furnished", read_scene(shipped_data("scenes/furnished_room.toml")));
}

}  // namespace

std::vector<PosedCloud> foreign_objects() {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  return {
      seen_from_above("ball", [](double x, double y) { return std::sqrt(3600 - x * x - y * y); }),
      seen_from_above(
          "can",
          [](double x, double y) { return std::abs(y) > 60 ? kNothing : std::sqrt(1225 - x * x); }),
      seen_from_above("board",
                      [](double x, double y) {
                        return std::max(std::abs(x), std::abs(y)) > 60 ? kNothing : 0.3 * x;
                      }),
      seen_from_above("box corner",
                      [](double x, double y) {
                        const double z = -std::max({x, -0.5 * x + 0.87 * y, -0.5 * x - 0.87 * y});
                        return z < -50 ? kNothing : z;
                      }),
      seen_from_above("vase",
                      [](double x, double y) {
                        const double r = 35 + 12 * std::sin(0.06 * y) + 5 * std::sin(0.15 * y + 1);
                        return std::abs(y) > 70 ? kNothing : std::sqrt(r * r - x * x);
                      }),
      scaled(furnished(), "small room", 0.03F),
  };
}

std::vector<PosedCloud> foreign_rooms() {
  const TemporaryFolder folder;
  const auto scene = [&](const std::string& text) {
    return read_scene(folder.write("scene.toml", text));
  };
  return {
      seen_by_head("another hall",
                   scene("[[object]]\nname = 'hall'\nshape = 'room'\n"
                         "size_mm = [3100, 9300, 4200]\nposition_mm = [0, 0, 2100]\n"
                         "[[object]]\nname = 'tank'\nshape = 'sphere'\nradius_mm = 900\n"
                         "position_mm = [300, 2500, 1200]\n")),
      scaled(furnished(), "the room, a quarter larger", 1.25F),
      seen_by_head("the room, empty",
                   scene("[[object]]\nname = 'room'\nshape = 'room'\n"
                         "size_mm = [6000, 4500, 2600]\nposition_mm = [0, 0, 1300]\n")),
  };
}

}  // namespace facula
