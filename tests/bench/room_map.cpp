// SPDX-License-Identifier: GPL-3.0-or-later
// room_map [STEP_DEG [CELL_MM]]: the map of a furnished room from eight stations of the simulated
// head, whose scans are registered from nothing, against the scene itself; prints a table in
// Markdown.
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/simulate/simulate.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/tests/bench/room_stations.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <set>
#include <vector>

namespace facula {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// From nothing; laid onto the truth by the scan that stays.
std::vector<RigidTransform> registered_poses(const KnownProject& known) {
  ScanProject project = known.project;
  const RegisterScansResult result = register_scans(project, {.start = ScanStart::kNothing});
  require(result.placed == project.scans.size(), "a station was not placed");
  const RigidTransform world_from_found =
      known.truth[result.anchor] * project.scans[result.anchor].world_from_scan.inverse();
  std::vector<RigidTransform> poses;
  for (const PosedCloud& scan : project.scans) {
    poses.push_back(world_from_found * scan.world_from_scan);
  }
  return poses;
}

/// The cells that truly hold a surface which some station saw.
std::set<CellKey> true_surface(const Scene& scene, double step, double cell) {
  const Rig rig = read_rig(shipped_data("rigs/head_fs1500.toml"));
  std::vector<double> positions;
  for (double angle = 0; angle < 2 * std::numbers::pi - step / 2; angle += step) {
    positions.push_back(angle);
  }
  std::set<CellKey> cells;
  for (const RigidTransform& pose : room_stations()) {
    const PointCloud cloud = transformed(
        cloud_from_scan(true_scan(scene, rig, pose, positions, options_for(rig))), pose);
    for (const Eigen::Vector3f& x : cloud.points) cells.insert(*cell_of(x.cast<double>(), cell));
  }
  return cells;
}

bool occupied_within_one_cell(const OccupancyMap& map, const CellKey& key) {
  for (int i = 0; i < 27; ++i) {
    const CellKey near = {key[0] + i % 3 - 1, key[1] + i / 3 % 3 - 1, key[2] + i / 9 - 1};
    if (map.state_of_cell(near) == CellState::kOccupied) return true;
  }
  return false;
}

struct RoomFigures {
  std::size_t surface = 0;  ///< cells that truly hold a surface a station saw
  std::size_t found = 0;    ///< of these, with an occupied cell within one cell
  std::size_t free = 0;     ///< cells of the map that are truly free
  std::size_t wrongly = 0;  ///< of these, occupied in the map
  std::size_t wall = 0;     ///< surface cells of the room's own walls, floor and ceiling
  std::size_t holes = 0;    ///< of these, without an occupied cell within one cell
};

/// Truly free: no surface within half a diagonal of the cell's middle, and not inside matter.
void count_free(const OccupancyMap& map, const Scene& scene, RoomFigures& figures) {
  const double clear = std::sqrt(3.0) / 2 * map.resolution();
  std::vector<OccupancyMap::BrickView> bricks;
  map.for_each_brick([&](const OccupancyMap::BrickView& brick) { bricks.push_back(brick); });
  using Counts = std::pair<std::size_t, std::size_t>;
  const auto count = [&](std::size_t begin, std::size_t end) {
    Counts counts{0, 0};
    for (std::size_t b = begin; b < end; ++b) {
      for_each_cell(bricks[b].known, [&](std::size_t cell) {
        const CellKey& first = bricks[b].first;
        const CellKey key = {first[0] + static_cast<int>(cell & 7),
                             first[1] + static_cast<int>(cell >> 3 & 7),
                             first[2] + static_cast<int>(cell >> 6)};
        const Eigen::Vector3d middle = centre_of(key, map.resolution());
        if (scene.distance(middle) <= clear || scene.inside(middle)) return;
        ++counts.first;
        if (bricks[b].occupied.test(cell)) ++counts.second;
      });
    }
    return counts;
  };
  const auto sum = [](const Counts& a, const Counts& b) {
    return Counts{a.first + b.first, a.second + b.second};
  };
  const Counts total = parallel_reduce(bricks.size(), Counts{0, 0}, count, sum, {.chunk = 64});
  figures.free = total.first;
  figures.wrongly = total.second;
}

/// Whether the cell lies on the shell of all that was truly seen: the room's walls.
bool on_shell(const CellKey& key, const CellKey& low, const CellKey& high) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (key[i] <= low[i] + 1 || key[i] >= high[i] - 1) return true;
  }
  return false;
}

RoomFigures compared(const OccupancyMap& map,
                     const Scene& scene,
                     const std::set<CellKey>& surface) {
  RoomFigures figures;
  CellKey low = *surface.begin();
  CellKey high = low;
  for (const CellKey& key : surface) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], key[i]);
      high[i] = std::max(high[i], key[i]);
    }
  }
  for (const CellKey& key : surface) {
    const bool found = occupied_within_one_cell(map, key);
    ++figures.surface;
    figures.found += found ? 1 : 0;
    if (!on_shell(key, low, high)) continue;
    ++figures.wall;
    figures.holes += found ? 0 : 1;
    if (found) continue;
    const Eigen::Vector3d x = centre_of(key, map.resolution());
    std::fprintf(stderr, "hole at %.3f %.3f %.3f m\n", x.x(), x.y(), x.z());
  }
  count_free(map, scene, figures);
  return figures;
}

void print(const char* poses, const RoomFigures& f) {
  const auto percent = [](std::size_t part, std::size_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  };
  std::printf("| %s | %zu | %.2f %% | %zu | %.3f %% | %zu | %zu |\n",
              poses,
              f.surface,
              percent(f.found, f.surface),
              f.free,
              percent(f.wrongly, f.free),
              f.wall,
              f.holes);
}

OccupancyMap map_of(const KnownProject& known,
                    const std::vector<RigidTransform>& poses,
                    double cell) {
  OccupancyMap map({.resolution = cell});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    map.insert(transformed(known.project.scans[i].cloud, poses[i]));
  }
  return map;
}

void study(double step, double cell) {
  const Scene scene = read_scene(shipped_data("scenes/furnished_room.toml"));
  const KnownProject known = eight_stations(step);
  const std::set<CellKey> surface = true_surface(scene, step, cell);
  std::puts(
      "| poses | surface cells seen | with an occupied cell within one | free cells | "
      "wrongly occupied | of walls, floor, ceiling | holes in these |");
  std::puts("|---|---|---|---|---|---|---|");
  print("registered", compared(map_of(known, registered_poses(known), cell), scene, surface));
  print("true", compared(map_of(known, known.truth, cell), scene, surface));
}

}  // namespace
}  // namespace facula

int main(int argc, char** argv) {
  try {
    const double step = argc > 1 ? std::atof(argv[1]) : 1.2;
    const double cell = argc > 2 ? std::atof(argv[2]) : 50;
    facula::study(step * facula::kDegree, cell / 1000);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "room_map: %s\n", error.what());
    return 1;
  }
}
