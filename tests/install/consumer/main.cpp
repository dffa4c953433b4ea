// SPDX-License-Identifier: GPL-3.0-or-later
// A program outside the tree: a wall seen by a scan becomes a file, a plane and a map.
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/version.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/reconstruct/measure/plane.hpp>

#include <cmath>
#include <iostream>

namespace {

/// The wall x = 2 m on a grid of 5 cm.
facula::PolarScan scan_of_wall() {
  facula::PolarScan scan = facula::PolarScan::empty(20, 30);
  for (int col = 0; col < scan.cols; ++col) {
    for (int row = 0; row < scan.rows; ++row) {
      scan.set(scan.index(row, col), {2, 0.05 * col, 0.05 * row}, 1.0F, 0.001F);
    }
  }
  return scan;
}

int failed(const char* what) {
  std::cerr << "consumer: " << what << '\n';
  return 1;
}

}  // namespace

int main() {
  facula::write_scan("wall.pcd", scan_of_wall());
  const facula::PolarScan scan = facula::read_scan("wall.pcd");
  if (scan.valid_count() != 600) return failed("the scan did not come back whole");

  const facula::PointCloud cloud = facula::cloud_from_scan(scan);
  const facula::PlaneFit wall = facula::fit_plane(cloud);
  if (std::abs(wall.plane.distance - 2) > 1e-6) return failed("the wall is not 2 m away");

  facula::OccupancyMap map({.resolution = 0.1});
  map.insert(cloud);
  if (map.state({1, 0.2, 0.2}) != facula::CellState::kFree) return failed("the way is not free");
  if (map.state({2, 0.4, 0.4}) != facula::CellState::kOccupied) return failed("there is no wall");

  std::cout << "Facula " << facula::version() << " found the wall\n";
  return 0;
}
