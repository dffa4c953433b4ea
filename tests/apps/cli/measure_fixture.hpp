// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {

using Json = nlohmann::json;

constexpr float kNoise = 0.001F;  // along every ray [m]

/// A plate of `side` squared points, seen from the origin, noisy along its rays where asked.
inline void add_plate(PointCloud& cloud,
                      const Eigen::Vector3d& corner,
                      const Eigen::Matrix<double, 3, 2>& edges,
                      Random& random,
                      float noise = kNoise) {
  constexpr int kSide = 60;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Eigen::Vector3d x = corner + edges * Eigen::Vector2d(i, j) / (kSide - 1);
      const Eigen::Vector3d noisy = x + noise * random.normal() * x.normalized();
      cloud.points.emplace_back(noisy.cast<float>());
      cloud.sigma.push_back(noise);
      cloud.sensor_origin.emplace_back(0, 0, 0);
    }
  }
}

inline Eigen::Matrix<double, 3, 2> edges(const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  Eigen::Matrix<double, 3, 2> both;
  both << u, v;
  return both;
}

/// A floor, a step 100 mm above it, a wall square to both and a ramp of 30 degrees.
inline PointCloud made_room() {
  Random random(4);
  PointCloud cloud;
  const double slope = std::tan(std::acos(-1.0) / 6);
  add_plate(cloud, {1.0, -1.5, -1.0}, edges({2, 0, 0}, {0, 2.0, 0}), random);
  add_plate(cloud, {1.0, 0.8, -0.9}, edges({1.6, 0, 0}, {0, 1.4, 0}), random);
  add_plate(cloud, {3.3, -1.5, -0.8}, edges({0, 3, 0}, {0, 0, 2}), random);
  add_plate(cloud, {1.2, -3.0, -0.9}, edges({1.2, 0, 0}, {0, -1, slope}), random);
  return cloud;
}

/// Three steps of 4.69, 9.63 and 14.55 mm over a bed, as a section along x sees them.
inline PointCloud made_stairs() {
  Random random(5);
  PointCloud cloud;
  for (int i = 0; i < 8000; ++i) {
    const double x = 0.08 * i / 8000;
    const double height = x < 0.02 ? 0 : x < 0.04 ? 0.00469 : x < 0.06 ? 0.00963 : 0.01455;
    cloud.points.emplace_back(Eigen::Vector3d(x, 0, height + 5e-5 * random.normal()).cast<float>());
  }
  return cloud;
}

constexpr const char* kNoPoints =
    "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 0\nDATA ascii\n";

inline PointCloud points_alone(std::vector<Eigen::Vector3f> points) {
  PointCloud cloud;
  cloud.points = std::move(points);
  return cloud;
}

class Measure : public testing::Test {
 protected:
  ProgramRun run(const std::string& line) const { return run_line(line, folder_.path()); }

  Json figures_of(const std::string& line) const {
    const ProgramRun measured = run("facula measure " + line + " --json -");
    EXPECT_EQ(measured.code, 0) << line << '\n' << measured.err;
    EXPECT_EQ(measured.err, "") << line;
    const Json figures = Json::parse(measured.out, nullptr, false);
    EXPECT_FALSE(figures.is_discarded()) << measured.out;
    return figures;
  }

  /// One sentence on standard error, nothing else, and no file left.
  void expect_refused(const std::string& line, const std::string& words) const {
    const ProgramRun refused = run("facula " + line);
    EXPECT_EQ(refused.code, 1) << line << '\n' << refused.out;
    EXPECT_EQ(refused.err.rfind("facula ", 0), 0U) << line << '\n' << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_NE(refused.err.find(words), std::string::npos) << line << '\n' << refused.err;
    EXPECT_EQ(refused.out, "") << line;
    EXPECT_FALSE(has_file_like(folder_.path(), "result")) << line;
  }

  void write(const std::string& name, const PointCloud& cloud) const {
    write_cloud(folder_ / name, cloud);
  }

  void write_text(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  void write_mesh_text(const std::string& name,
                       const std::string& vertices,
                       const std::string& face) const {
    write_text(name,
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face " +
                   std::string(face.empty() ? "0" : "1") +
                   "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + face);
  }

  TemporaryFolder folder_;
};

const Json& row_of(const Json& rows, int plane, int other) {
  static const Json none;
  for (const Json& row : rows) {
    if (row.at("plane") == plane && row.at("other") == other) return row;
  }
  ADD_FAILURE() << "no row of planes " << plane << " and " << other;
  return none;
}

/// The number of the plane whose points are the `n`-th made plate: by normal and distance.
inline int plane_like(const Json& planes, const Eigen::Vector3d& normal, double distance_mm) {
  for (const Json& row : planes) {
    const Eigen::Vector3d found(row.at("normal_x"), row.at("normal_y"), row.at("normal_z"));
    const double along = found.dot(normal);
    if (std::abs(along) < 0.999) continue;
    if (std::abs(std::copysign(row.at("distance_mm").get<double>(), along) - distance_mm) < 30) {
      return row.at("plane");
    }
    if (std::abs(row.at("distance_mm").get<double>() * along - distance_mm) < 30) {
      return row.at("plane");
    }
  }
  ADD_FAILURE() << "no plane like " << normal.transpose() << " at " << distance_mm << " mm";
  return 0;
}

}  // namespace facula
