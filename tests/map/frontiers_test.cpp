// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/coarse_map.hpp>
#include <facula/map/frontiers.hpp>
#include <facula/tests/map/drawn_map.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kCell = 0.1;

Floor floor_of(const OccupancyMap& map) {
  return find_floor(map);
}

/// A room of 6 m x 4 m x 2.5 m, known but for an alcove of `depth` cells, 1 m wide and 1 m high,
/// behind its wall at x = 6 m.
DrawnMap room_with_alcove(int depth) {
  DrawnMap drawn(kCell);
  drawn.occupy({{60, 14, 4}, {61 + depth, 26, 16}});
  drawn.room({{0, 0, 0}, {60, 40, 25}});
  drawn.forget({{60, 15, 5}, {60 + depth, 25, 15}});
  return drawn;
}

FrontierOptions fine_options() {
  FrontierOptions options;
  options.view_cell = kCell;
  options.range = 7;  // more than the room is long
  options.stand.spacing = 0.8;
  return options;
}

TEST(CoarseMap, IsOccupiedWhereAnyCellIsAndFreeWhereHalfAreKnown) {
  DrawnMap drawn(kCell);
  drawn.free({{0, 0, 0}, {2, 2, 1}});      // 4 of 8: free
  drawn.free({{2, 0, 0}, {4, 1, 1}});      // 2 of 8: unknown
  drawn.free({{4, 0, 0}, {6, 2, 2}});      // all but one
  drawn.occupy({{5, 1, 1}, {6, 2, 2}});    // and that one
  drawn.occupy({{-1, -1, 0}, {0, 0, 1}});  // alone in the cell below
  const CoarseMap coarse = coarse_map(drawn.map(), {.least_edge = 0.15, .margin = 0});
  EXPECT_NEAR(coarse.edge, 0.2, 1e-12);
  ASSERT_EQ(coarse.size, (std::array<int, 3>{4, 2, 1}));
  EXPECT_TRUE(is_near_point(coarse.corner, {-0.2, -0.2, 0}, 1e-9));
  const auto state = [&](int x, int y) { return coarse.cells[coarse.index({x, y, 0})]; };
  EXPECT_EQ(state(0, 0), CellState::kOccupied);
  EXPECT_EQ(state(1, 1), CellState::kFree);
  EXPECT_EQ(state(2, 1), CellState::kUnknown);
  EXPECT_EQ(state(3, 1), CellState::kOccupied);
  EXPECT_EQ(state(1, 0), CellState::kUnknown);
}

TEST(CoarseMap, RaysMeetTheCellsThatSmallStepsMeet) {
  DrawnMap drawn(kCell);
  drawn.free({{0, 0, 0}, {30, 20, 10}});
  const CoarseMap coarse = coarse_map(drawn.map(), {.least_edge = kCell, .margin = 0});
  const Eigen::Vector3d origin(1.234, 0.777, 0.513);
  for (const Eigen::Vector3d& along : {Eigen::Vector3d(1, 0, 0),
                                       Eigen::Vector3d(-0.3, 0.5, 0.2),
                                       Eigen::Vector3d(0.7, -0.6, -0.1),
                                       Eigen::Vector3d(0, 0, -1),
                                       Eigen::Vector3d(-0.9, -0.1, 0.05)}) {
    const Eigen::Vector3d direction = along.normalized();
    std::vector<std::size_t> met;
    walk_coarse(coarse, origin, direction, 1.5, [&](std::size_t cell) {
      met.push_back(cell);
      return true;
    });
    std::set<std::size_t> stepped;
    for (double at = 0; at <= 1.5; at += 1e-4) {
      const Eigen::Vector3d x = (origin + at * direction) / kCell;
      const std::array<int, 3> cell = {static_cast<int>(std::floor(x.x())),
                                       static_cast<int>(std::floor(x.y())),
                                       static_cast<int>(std::floor(x.z()))};
      if (coarse.holds(cell)) stepped.insert(coarse.index(cell));
    }
    EXPECT_EQ(std::set<std::size_t>(met.begin(), met.end()), stepped);
    EXPECT_EQ(met.size(), stepped.size()) << "a cell was met twice";
  }
}

TEST(FrontierRegions, AreTheFreeCellsBesideTheUnknownOnes) {
  const CoarseMap coarse =
      coarse_map(room_with_alcove(5).map(), {.least_edge = kCell, .margin = 0});
  const FrontierRegions found = frontier_regions(coarse, 10);
  EXPECT_EQ(found.cells, 100U);  // the mouth of the alcove
  ASSERT_EQ(found.regions.size(), 1U);
  EXPECT_EQ(found.regions[0].cells, 100U);
  EXPECT_NEAR(found.regions[0].area, 1.0, 1e-9);
  EXPECT_TRUE(is_near_point(found.regions[0].centre, {5.95, 2.0, 1.0}, 0.08));
  // Cut into halves until none is longer than half a metre: 4 pieces of 25 cells.
  const FrontierRegions cut = frontier_regions(coarse, 0.5);
  ASSERT_EQ(cut.regions.size(), 4U);
  for (const FrontierRegion& region : cut.regions) EXPECT_EQ(region.cells, 25U);
}

TEST(FrontierRegions, AreOneRegionPerOpening) {
  DrawnMap drawn = room_with_alcove(5);
  drawn.occupy({{20, 40, 4}, {27, 46, 16}});
  drawn.forget({{21, 40, 5}, {26, 45, 15}});
  const CoarseMap coarse = coarse_map(drawn.map(), {.least_edge = kCell, .margin = 0});
  const FrontierRegions found = frontier_regions(coarse, 10);
  ASSERT_EQ(found.regions.size(), 2U);
  EXPECT_EQ(found.regions[0].cells + found.regions[1].cells, 150U);
}

TEST(Frontiers, ExpectExactlyTheVolumeThatIsHidden) {
  // Shallow and straight ahead, so that some standpoint sees every cell of it.
  const OccupancyMap map = room_with_alcove(3).map();
  const Frontiers found = find_frontiers(map, floor_of(map), fine_options());
  EXPECT_EQ(found.cell, kCell);
  EXPECT_EQ(found.cells, 100U);
  ASSERT_EQ(found.suggestions.size(), 1U);
  const ScanSuggestion& best = found.suggestions[0];
  EXPECT_NEAR(best.volume, 0.3, 1e-9);
  EXPECT_NEAR(best.volume_alone, 0.3, 1e-9);
  EXPECT_NEAR(best.region_volume, 0.3, 1e-9);
  EXPECT_EQ(best.region.cells, 100U);
}

/// The unknown cells seen from a place, each asked for by a ray to its middle and corners.
std::size_t seen_by_cells(const CoarseMap& map, const Eigen::Vector3d& from, double range) {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (map.cells[i] != CellState::kUnknown) continue;
    bool visible = false;
    for (int corner = 0; corner < 9 && !visible; ++corner) {
      const Eigen::Vector3d offset(
          corner & 1 ? 0.45 : -0.45, corner & 2 ? 0.45 : -0.45, corner & 4 ? 0.45 : -0.45);
      const Eigen::Vector3d to =
          map.centre(i) + (corner == 8 ? Eigen::Vector3d::Zero().eval() : map.edge * offset);
      if ((to - from).norm() > range) continue;
      walk_coarse(map, from, (to - from).normalized(), range, [&](std::size_t cell) {
        visible = visible || cell == i;
        return !visible && map.cells[cell] != CellState::kOccupied;
      });
    }
    if (visible) ++seen;
  }
  return seen;
}

TEST(Frontiers, CountWhatRaysToEveryUnknownCellSay) {
  const OccupancyMap map = room_with_alcove(12).map();
  FrontierOptions options = fine_options();
  options.margin = 0;
  options.count = 1;
  const Frontiers found = find_frontiers(map, floor_of(map), options);
  ASSERT_EQ(found.suggestions.size(), 1U);
  const CoarseMap coarse = coarse_map(map, {.least_edge = kCell, .margin = 0});
  const auto expected =
      static_cast<double>(seen_by_cells(coarse, found.suggestions[0].position, options.range));
  EXPECT_GT(expected, 500);
  EXPECT_NEAR(found.suggestions[0].volume / (kCell * kCell * kCell), expected, 0.02 * expected);
}

/// A room of 8 m x 6 m x 2.5 m, parted by a wall at x = 4 m with a gap at y above 5 m.
struct PartedRoom {
  static constexpr double kWall = 4.0;
  static constexpr double kGap = 5.0;

  /// How far one sees from `x` along the unit vector `d`.
  static double range(const Eigen::Vector3d& x, const Eigen::Vector3d& d) {
    const Eigen::Vector3d high(8, 6, 2.5);
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      if (d[i] != 0) nearest = std::min(nearest, ((d[i] > 0 ? high[i] : 0) - x[i]) / d[i]);
    }
    const double to_wall = (kWall - x.x()) / d.x();
    if (to_wall > 0 && x.y() + to_wall * d.y() < kGap) nearest = std::min(nearest, to_wall);
    return nearest;
  }

  static void scan(OccupancyMap& map, const Eigen::Vector3d& station) {
    PointCloud cloud;
    for (int row = 0; row < 300; ++row) {
      for (int col = 0; col < 600; ++col) {
        const double elevation = M_PI * ((row + 0.5) / 300 - 0.5);
        const double azimuth = 2 * M_PI * col / 600;
        const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
        cloud.points.push_back((station + range(station, d) * d).cast<float>());
        cloud.sensor_origin.push_back(station.cast<float>());
      }
    }
    map.insert(cloud);
  }

  static OccupancyMap scanned_from(const Eigen::Vector3d& station) {
    OccupancyMap map({.resolution = 0.05});
    scan(map, station);
    return map;
  }
};

double known_volume(const OccupancyMap& map) {
  const MapStatistics statistics = map.statistics();
  return static_cast<double>(statistics.free_cells + statistics.occupied_cells) *
         std::pow(map.resolution(), 3);
}

TEST(Frontiers, SendTheScannerToWhereTheHiddenPartOfARoomComesIntoView) {
  const Eigen::Vector3d station(1.5, 1.5, 1.3);
  OccupancyMap map = PartedRoom::scanned_from(station);
  const Floor floor = floor_of(map);
  EXPECT_NEAR(floor.height, 0, 0.05);
  const Frontiers found = find_frontiers(map, floor, {});
  ASSERT_FALSE(found.suggestions.empty());
  const ScanSuggestion& best = found.suggestions[0];
  EXPECT_NEAR(best.position.z(), floor.height + 1.2, 1e-9);
  // A point low in the hidden half, which the wall keeps from the station.
  const Eigen::Vector3d hidden(5.0, 2.0, 1.0);
  const auto sees = [&](const Eigen::Vector3d& from) {
    const Eigen::Vector3d way = hidden - from;
    return PartedRoom::range(from, way.normalized()) > way.norm();
  };
  ASSERT_FALSE(sees(station));
  EXPECT_EQ(map.state(hidden), CellState::kUnknown);
  EXPECT_TRUE(sees(best.position)) << best.position.transpose();
  // Half of the room is 60 m^3, of which the first scan saw a wedge through the gap; the surfaces
  // around it are unknown too, a layer of cells of 0.2 m at most.
  EXPECT_GT(best.volume, 20);
  EXPECT_LT(best.volume, 80);

  // A scan from there brings what was expected, and leaves little to see.
  const double before = known_volume(map);
  PartedRoom::scan(map, best.position);
  EXPECT_NE(map.state(hidden), CellState::kUnknown);
  EXPECT_NEAR(known_volume(map) - before, best.volume, 0.2 * best.volume);
  const Frontiers next = find_frontiers(map, floor, {});
  const double left = next.suggestions.empty() ? 0 : next.suggestions[0].volume;
  EXPECT_LT(left, 0.2 * best.volume);
}

TEST(Frontiers, CrossOffWhatEarlierSuggestionsSee) {
  DrawnMap drawn = room_with_alcove(3);
  drawn.occupy({{-7, 14, 4}, {-1, 26, 16}});
  drawn.forget({{-6, 15, 5}, {0, 25, 15}});
  const OccupancyMap map = drawn.map();
  FrontierOptions options = fine_options();
  options.min_volume = 0.01;
  const Frontiers found = find_frontiers(map, floor_of(map), options);
  double sum = 0;
  double last = found.suggestions.at(0).volume;
  for (const ScanSuggestion& suggestion : found.suggestions) {
    sum += suggestion.volume;
    EXPECT_LE(suggestion.volume, std::exchange(last, suggestion.volume));
    EXPECT_LE(suggestion.volume, suggestion.volume_alone);
  }
  EXPECT_LE(sum, 0.3 + 0.6 + 1e-9);
  EXPECT_GT(sum, 0.85);
}

TEST(Frontiers, AreTheSameForEveryNumberOfThreads) {
  const OccupancyMap map = PartedRoom::scanned_from({1.5, 1.5, 1.3});
  FrontierOptions one;
  one.num_threads = 1;
  one.stand.most = 50;
  FrontierOptions two = one;
  two.num_threads = 2;
  const TemporaryFolder folder;
  write_frontiers_csv(folder / "1.csv", find_frontiers(map, floor_of(map), one));
  write_frontiers_csv(folder / "2.csv", find_frontiers(map, floor_of(map), two));
  EXPECT_EQ(read_whole_file(folder / "1.csv"), read_whole_file(folder / "2.csv"));
}

TEST(Frontiers, SuggestNothingWhereEverythingIsKnown) {
  DrawnMap drawn(kCell);
  drawn.room({{0, 0, 0}, {30, 30, 25}});
  const OccupancyMap map = drawn.map();
  const Frontiers found = find_frontiers(map, floor_of(map), fine_options());
  EXPECT_EQ(found.cells, 0U);
  EXPECT_EQ(found.regions, 0U);
  EXPECT_TRUE(found.suggestions.empty());
}

TEST(Standpoints, KeepTheirDistanceAndStayInTheLargestArea) {
  DrawnMap drawn(kCell);
  drawn.room({{0, 0, 0}, {40, 30, 25}});
  drawn.room({{60, 0, 0}, {70, 10, 25}});    // another room, seen through a window
  drawn.occupy({{20, 15, 0}, {21, 16, 8}});  // a stool
  drawn.occupy({{5, 5, 20}, {10, 10, 21}});  // a lamp, higher than the scanner
  const OccupancyMap map = drawn.map();
  const StandArea area = find_standpoints(
      map, floor_of(map), {.scanner_height = 1.2, .clearance = 0.35, .spacing = 0.1, .most = 9999});
  ASSERT_FALSE(area.lattice.empty());
  bool under_lamp = false;
  for (const std::size_t cell : area.lattice) {
    const Eigen::Vector3d x = area.position(cell);
    EXPECT_NEAR(x.z(), -0.05 + 1.2, 1e-9);
    EXPECT_GT(x.x(), 0.3);
    EXPECT_LT(x.x(), 3.7);
    EXPECT_GT((x.head<2>() - Eigen::Vector2d(2.05, 1.55)).norm(), 0.35);
    under_lamp = under_lamp || (x.head<2>() - Eigen::Vector2d(0.75, 0.75)).norm() < 0.1;
  }
  EXPECT_TRUE(under_lamp);
  EXPECT_LE(find_standpoints(map, floor_of(map), {.most = 7}).lattice.size(), 7U);
}

TEST(Frontiers, SayWhatIsMissing) {
  const OccupancyMap map = room_with_alcove(3).map();
  const Floor floor = floor_of(map);
  const auto with = [&](const FrontierOptions& options) {
    return error_of([&] { find_frontiers(map, floor, options); });
  };
  EXPECT_NE(with({.stand = {.scanner_height = 9}}).find("no place for a tripod"),
            std::string::npos);
  EXPECT_NE(with({.range = 0}).find("range"), std::string::npos);
  EXPECT_NE(with({.count = 0}).find("count"), std::string::npos);
  EXPECT_NE(with({.count = 1001}).find("1001"), std::string::npos);
  EXPECT_NE(with({.most_rays = 3}).find("most_rays"), std::string::npos);
  EXPECT_NE(error_of([&] { find_frontiers(OccupancyMap{}, floor, {}); }).find("empty"),
            std::string::npos);
}

TEST(FrontiersFile, HasARowPerSuggestion) {
  const TemporaryFolder folder;
  Frontiers frontiers;
  frontiers.suggestions.push_back({.position = {1.5, -2, 1.25},
                                   .volume = 0.5,
                                   .volume_alone = 0.75,
                                   .region = {.centre = {3, 4, 5}, .cells = 12, .area = 0.48},
                                   .region_volume = 0.25});
  write_frontiers_csv(folder / "next.csv", frontiers);
  EXPECT_EQ(read_whole_file(folder / "next.csv"),
            "rank,x_m,y_m,z_m,volume_m3,volume_alone_m3,region_x_m,region_y_m,region_z_m,"
            "region_cells,region_area_m2,region_volume_m3\n"
            "1,1.5,-2,1.25,0.5,0.75,3,4,5,12,0.48,0.25\n");
}

}  // namespace
}  // namespace facula
