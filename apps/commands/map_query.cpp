// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/csv_table.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/map_query.hpp>
#include <facula/apps/commands/map_query_figures.hpp>

#include <memory>
#include <string>

namespace facula {
namespace {

struct QueryArguments {
  std::filesystem::path map;
  std::optional<Eigen::Vector3d> at;
  std::optional<double> radius;
  std::optional<Eigen::Vector3d> from;
  std::optional<Eigen::Vector3d> to;
  double max_range = 0;
  std::optional<Eigen::Vector3d> low;
  std::optional<Eigen::Vector3d> high;
  std::filesystem::path points;
  std::filesystem::path rays;
  std::string unknown = "blocked";
  std::filesystem::path csv;
};

void declare(Arguments& arguments, QueryArguments& a) {
  arguments.input("MAP", a.map, "a map (.bt, .ot, .fmap)");
  arguments.required();
  arguments.vector("--at-m", a.at, kMetres, "a place: free, occupied or unknown?");
  arguments.number(
      "--radius-m", a.radius, kMetres, "with places: also the nearest obstacle within this ball");
  arguments.vector("--from-m", a.from, kMetres, "a ray's origin: which cell stops it?");
  arguments.vector("--to-m", a.to, kMetres, "a place the ray goes towards, and beyond");
  arguments.number("--max-range-m", a.max_range, kMetres, "of rays, 0 = no limit");
  arguments.vector("--low-m", a.low, kMetres, "a box's lower corner: how many cells are what?");
  arguments.vector("--high-m", a.high, kMetres, "its upper corner");
  arguments.input(
      "--points",
      a.points,
      "many places in the map's frame: .csv (x y z in metres, then anything), .xyz, .ply, .pcd; "
      "those that are no numbers are left out");
  arguments.input("--rays",
                  a.rays,
                  "many rays: a .csv with the columns x_m, y_m, z_m and to_x_m, to_y_m, to_z_m");
  arguments.choice("--unknown",
                   a.unknown,
                   {"blocked", "free"},
                   "whether cells nobody has seen stop rays and are obstacles");
  arguments.output("--csv", a.csv, "answers for --points or --rays, a line each (.csv)");
}

void check(const QueryArguments& a) {
  if (!a.csv.empty()) check_output(a.csv, {".csv"});
  if (a.from.has_value() != a.to.has_value()) fail_usage("--from-m and --to-m belong together");
  if (a.low.has_value() != a.high.has_value()) fail_usage("--low-m and --high-m belong together");
  const bool places = a.at.has_value() || !a.points.empty();
  if (a.radius && !places) fail_usage("--radius-m belongs to --at-m or --points");
  if (!places && !a.from && !a.low && a.rays.empty()) {
    fail_usage(
        "expected a question: --at-m, --from-m and --to-m, --low-m and --high-m, --points or "
        "--rays; see --help");
  }
  if (!a.points.empty() && !a.rays.empty()) {
    fail_usage("--points and --rays exclude each other; ask twice");
  }
  if (!a.csv.empty() && a.points.empty() && a.rays.empty()) {
    fail_usage("--csv belongs to --points or --rays");
  }
}

std::vector<Eigen::Vector3d> places_of(const std::filesystem::path& path) {
  std::vector<Eigen::Vector3d> places;
  for (const Eigen::Vector3f& x : read_cloud(path).points) places.push_back(x.cast<double>());
  return places;
}

std::vector<QueryRay> rays_of(const std::filesystem::path& path) {
  const CsvTable table = CsvTable::from_file(path);
  std::vector<QueryRay> rays(table.rows());
  const auto fill = [&](const char* name, const auto& number) {
    const std::vector<double> column = table.column({name});
    for (std::size_t i = 0; i < rays.size(); ++i) number(rays[i]) = column[i];
  };
  fill("x_m", [](QueryRay& ray) -> double& { return ray.from.x(); });
  fill("y_m", [](QueryRay& ray) -> double& { return ray.from.y(); });
  fill("z_m", [](QueryRay& ray) -> double& { return ray.from.z(); });
  fill("to_x_m", [](QueryRay& ray) -> double& { return ray.to.x(); });
  fill("to_y_m", [](QueryRay& ray) -> double& { return ray.to.y(); });
  fill("to_z_m", [](QueryRay& ray) -> double& { return ray.to.z(); });
  return rays;
}

void run(const QueryArguments& a, Session& session) {
  check(a);
  const OccupancyMap map = OccupancyMap::read(a.map);
  const MapAnswers answers{
      .map = map,
      .query = MapQuery(map, session.num_threads),
      .unknown = a.unknown == "free" ? UnknownCells::kFree : UnknownCells::kOccupied,
      .radius = a.radius,
      .max_range = a.max_range};
  if (a.at) report_place(answers, *a.at, session.figures.part("place", "Place:"));
  if (a.from) report_ray(answers, {*a.from, *a.to}, session.figures.part("ray", "Ray:"));
  if (a.low) {
    const MapBox box{a.low->cast<float>(), a.high->cast<float>()};
    report_box(answers, box, session.figures.part("box", "Box:"));
  }
  if (!a.points.empty()) {
    const FigureTable table = table_of_places(answers, places_of(a.points), session.figures);
    if (!a.csv.empty()) write_table_csv(a.csv, table);
  }
  if (!a.rays.empty()) {
    const FigureTable table = table_of_rays(answers, rays_of(a.rays), session.figures);
    if (!a.csv.empty()) write_table_csv(a.csv, table);
  }
}

}  // namespace

Command map_query_command() {
  const auto a = std::make_shared<QueryArguments>();
  return {
      .name = "map query",
      .summary = "ask a map about places, rays, boxes and balls",
      .description =
          "Says what an occupancy map knows: whether a place is free, occupied or unknown and "
          "how surely; which cell stops a ray and where (OctoMap's castRay); how many cells of "
          "a box are what; the obstacle nearest to a place. --points and --rays ask about many "
          "at once.",
      .examples = {"facula simulate data/scenes/furnished_room.toml --rig "
                   "data/rigs/head_fs1500.toml --step-deg 12 "
                   "--position-mm -1500 -300 1100 --out room",
                   "facula extract room --out room.pcd",
                   "facula map room.pcd --resolution-mm 100 --out room.bt",
                   "facula map query room.bt --at-m -1.3 -0.3 1.1 --radius-m 1 --unknown "
                   "free",
                   "facula map query room.bt --from-m -1.5 -0.3 1.1 --to-m 3 -0.3 1.1 --unknown "
                   "free",
                   "facula map query room.bt --low-m -1 -1 0 --high-m 1 1 2",
                   "facula map plan room.bt --from-m -1.3 -0.3 1.1 --to-m 0.5 -0.5 1.4 "
                   "--unknown free --csv path.csv",
                   "facula map query room.bt --points path.csv --radius-m 0.5 --unknown free "
                   "--csv states.csv"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
