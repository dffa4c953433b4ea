// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/data_folder.hpp>
#include <facula/apps/commands/demo/demo_mesh.hpp>
#include <facula/apps/commands/demo/map_error.hpp>
#include <facula/apps/commands/demo/plane_error.hpp>
#include <facula/apps/commands/demo/pose_error.hpp>
#include <facula/apps/commands/demo/range_error.hpp>
#include <facula/apps/commands/demo/room_demo.hpp>
#include <facula/apps/commands/demo/surface_error.hpp>
#include <facula/apps/commands/map_figures.hpp>
#include <facula/apps/commands/plane_figures.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/normals.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace facula {
namespace {

/// Where the head stood; data/scenes/furnished_room.toml says that there is room for it.
std::vector<RigidTransform> stations() {
  const auto station = [](double x, double y, double yaw_deg) {
    const Eigen::AngleAxisd turn(yaw_deg * kDegrees.factor, Eigen::Vector3d::UnitZ());
    return RigidTransform{Eigen::Quaterniond(turn), {x, y, 1.1}};
  };
  return {station(-1.5, -0.3, 0), station(0.2, 0.8, 120), station(1.7, -0.3, -75)};
}

/// Scans 2 and 3 are known only roughly, as if somebody had paced out where the head stood.
std::vector<RecordedScan> record_scans(const Scene& scene,
                                       const DemoSettings& settings,
                                       Session& session) {
  const Rig rig = read_rig(resolved_input("data/rigs/head_fs1500.toml"));
  std::vector<RecordedScan> scans;
  for (const RigidTransform& station : stations()) {
    const std::size_t number = scans.size() + 1;
    RecordedScan scan =
        record({"room_" + std::to_string(number), &scene, &rig, station, settings.room_step},
               settings,
               session);
    const RigidTransform known = number == 1 ? station : rough_pose(station, number, settings);
    scan.extracted.scan.world_from_scan = known;
    scan.clean.world_from_scan = known;
    write_scan(settings.folder / "scans" / (scan.name + ".pcd"), scan.extracted.scan);
    scans.push_back(std::move(scan));
  }
  return scans;
}

void report_scans(const std::vector<RecordedScan>& scans, Figures& figures) {
  RangeErrors raw;
  RangeErrors clean;
  std::size_t removed = 0;
  for (const RecordedScan& scan : scans) {
    raw.add(scan.extracted.scan, scan.truth);
    clean.add(scan.clean, scan.truth);
    removed += scan.mixed_removed;
  }
  report_range_errors(raw, figures.part("extract", "1 Extracting the room's three scans:"));
  Figures& filtered = figures.part("filter", "2 Removing mixed points:");
  filtered.count("mixed_removed", "points removed", removed);
  report_range_errors(clean, filtered);
}

void register_room(RoomDemo& demo, const DemoSettings& settings, Session& session) {
  for (const RecordedScan& scan : demo.scans) {
    demo.project.scans.push_back({scan.name,
                                  settings.folder / "scans" / (scan.name + ".pcd"),
                                  cloud_from_scan(scan.clean),
                                  scan.clean.world_from_scan,
                                  grid_from_scan(scan.clean)});
  }
  RegisterScansOptions options;
  options.start = ScanStart::kGiven;
  options.refinement.max_distance = 4 * settings.start_distance;
  options.num_threads = settings.num_threads;
  options.progress = session.progress("registering the room");
  const RegisterScansResult result = register_scans(demo.project, options);
  write_poses(settings.folder / "poses.toml", demo.project);
  report_pose_errors(demo.scans,
                     demo.project,
                     result,
                     session.figures.part("register", "3 Registering scans 2 and 3 to scan 1:"));
}

/// Thinned, with normals.
PointCloud cloud_for_planes(const PointCloud& points, const DemoSettings& settings) {
  PointCloud cloud = thin_by_voxel(points, settings.room_voxel() / 2);
  NormalOptions normals;
  normals.num_threads = settings.num_threads;
  estimate_normals(cloud, normals);
  return cloud;
}

void measure_planes(RoomDemo& demo,
                    const Scene& scene,
                    const DemoSettings& settings,
                    Session& session) {
  session.step("measuring planes", 1, 3);
  PlaneExtractionOptions options;
  options.seed = static_cast<unsigned>(settings.seed);
  options.num_threads = settings.num_threads;
  demo.planes_cloud = cloud_for_planes(demo.project.fused(), settings);
  demo.planes = extract_planes(demo.planes_cloud, options);
  write_planes_csv(settings.folder / "planes.csv", demo.planes);
  Figures& figures = session.figures.part("planes", "4 Planes against the room's walls:");
  report_plane_errors(demo.planes, true_walls(scene), figures);
  // A plane's uncertainty knows the noise of its points, not the error of the poses that joined
  // scans, so that is looked at within one scan.
  const PosedCloud& first = demo.project.scans.front();
  const PointCloud one =
      cloud_for_planes(transformed(first.cloud, first.world_from_scan), settings);
  report_angle_errors(extract_planes(one, options),
                      true_walls(scene),
                      figures.part("one_scan", "Angles between walls within the first scan:"));
}

void make_mesh(RoomDemo& demo, const Scene& scene, const DemoSettings& settings, Session& session) {
  session.step("meshing the room", 2, 3);
  Figures& figures = session.figures.part("room_mesh", "5 Mesh of the room:");
  demo.mesh = mesh_demo_scans(demo.project, settings, figures);
  write_mesh(settings.folder / "room_mesh.ply", demo.mesh);
  report_mesh_error(demo.mesh, scene, settings.num_threads, figures);
}

double median_sigma(const std::vector<RecordedScan>& scans) {
  std::vector<double> medians;
  medians.reserve(scans.size());
  for (const RecordedScan& scan : scans) medians.push_back(scan.extracted.median_point_sigma);
  std::sort(medians.begin(), medians.end());
  return medians[medians.size() / 2];
}

void make_map(RoomDemo& demo, const Scene& scene, const DemoSettings& settings, Session& session) {
  session.step("mapping the room", 3, 3);
  for (const PosedCloud& scan : demo.project.scans) {
    demo.map.insert(transformed(scan.cloud, scan.world_from_scan));
  }
  demo.map.write(settings.folder / "map.bt");
  demo.map.write(settings.folder / "map.ot");
  write_navigation_grid(settings.folder / "map.yaml", navigation_grid(demo.map));
  Figures& figures = session.figures.part("map", "6 Occupancy map of the room:");
  report_map(demo.map, figures);
  report_map_errors(demo.map, scene, 2 * median_sigma(demo.scans), settings.num_threads, figures);
}

}  // namespace

RoomDemo run_room_demo(const DemoSettings& settings, Session& session) {
  const Scene scene = read_scene(resolved_input("data/scenes/furnished_room.toml"));
  RoomDemo demo;
  demo.scans = record_scans(scene, settings, session);
  report_scans(demo.scans, session.figures);
  register_room(demo, settings, session);
  measure_planes(demo, scene, settings, session);
  make_mesh(demo, scene, settings, session);
  make_map(demo, scene, settings, session);
  session.end_steps();
  return demo;
}

}  // namespace facula
