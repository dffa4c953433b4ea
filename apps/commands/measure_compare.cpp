// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/deviation_figures.hpp>
#include <facula/apps/commands/measure_compare.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/apps/report/deviation_map.hpp>
#include <facula/apps/report/png.hpp>
#include <facula/reconstruct/filter/distinct_points.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/principal_frame.hpp>
#include <facula/reconstruct/mesh/mesh_exchange.hpp>

#include <memory>

namespace facula {
namespace {

struct CompareArguments {
  std::vector<std::filesystem::path> points;
  std::filesystem::path reference;
  std::filesystem::path out;
  std::filesystem::path picture;
  std::filesystem::path csv;
  std::optional<double> max_distance;
  std::optional<double> color_limit;
};

void declare(Arguments& arguments, CompareArguments& a) {
  arguments.inputs("POINTS", a.points, "a scan, several, a cloud, a mesh's vertices, or a project");
  arguments.required();
  arguments.input("--to", a.reference, "a mesh, or a cloud or scan, to measure from");
  arguments.required();
  arguments.number("--max-mm", a.max_distance, kMillimetres, "leave out points farther away");
  arguments.number("--color-mm", a.color_limit, kMillimetres, "deviation of the last colour");
  arguments.output("--out", a.out, "the points in the colours of their deviations (.ply)");
  arguments.output("--picture", a.picture, "colour map with legend and histogram (.png)");
  arguments.output("--csv", a.csv, "the histogram as a table (.csv)");
}

/// Points as they were measured: nothing is filtered away, for that would flatter them.
PointCloud points_of(const std::vector<std::filesystem::path>& paths) {
  PointCloud cloud = read_posed_scans(paths, false).project.fused();
  cloud.colors.clear();
  return cloud;
}

void write_pictures(const CompareArguments& a, PointCloud cloud, const Deviations& deviations) {
  const ColorScale scale =
      deviation_scale(deviations.values, deviations.has_sign, a.color_limit.value_or(0));
  if (!a.picture.empty()) write_png(a.picture, deviation_map(cloud, deviations.values, scale));
  if (a.out.empty()) return;
  cloud.colors = deviation_colors(deviations.values, scale);
  write_cloud(a.out, cloud);
}

void run(const CompareArguments& a, Session& session) {
  if (!a.out.empty()) check_output(a.out, {".ply"});
  if (!a.picture.empty()) check_output(a.picture, {".png"});
  if (!a.csv.empty()) check_output(a.csv, {".csv"});
  require(!a.color_limit || *a.color_limit > 0,
          "expected --color-mm above 0, got ",
          1000 * a.color_limit.value_or(0),
          "; leave it out to have it chosen");
  DeviationOptions options;
  options.num_threads = session.num_threads;
  if (a.max_distance) options.max_distance = *a.max_distance;
  options.check();
  session.step("reading", 1, 3);
  const PointCloud cloud = points_of(a.points);
  session.step("measuring", 2, 3);
  const Deviations deviations = deviations_from_file(cloud.points, a.reference, options);
  require(deviations.too_far < cloud.size(),
          "expected points within ",
          1000 * options.max_distance,
          " mm of the reference, got none of ",
          cloud.size(),
          "; raise --max-mm, or align the two first");
  session.step("writing", 3, 3);
  write_pictures(a, cloud, deviations);
  FigureTable table = deviation_table(deviations);
  if (!a.csv.empty()) write_table_csv(a.csv, table);
  session.figures.text("reference",
                       "measured from",
                       file_kind(a.reference) == FileKind::kMesh ? "a mesh" : "points");
  report_deviations(deviations, session.figures);
  session.figures.table(std::move(table));
}

}  // namespace

Deviations deviations_from_file(const std::vector<Eigen::Vector3f>& points,
                                const std::filesystem::path& reference,
                                const DeviationOptions& options) {
  if (file_kind(reference) == FileKind::kMesh) {
    return deviations_from_mesh(points, read_any_mesh(reference), options);
  }
  PointCloud cloud = read_posed_scans({reference}).project.fused();
  // Twenty points in one place would be all the neighbours that a normal is estimated from.
  cloud = selected(cloud, distinct_points(cloud.points));
  // Turned to the sensor; a cloud that knows none counts as seen from its frame's origin.
  if (cloud.normals.empty() && !cloud.sensor_origin.empty() && spans_surface(cloud)) {
    estimate_normals(cloud, {.num_threads = options.num_threads});
  }
  return deviations_from_cloud(points, cloud, options);
}

Command measure_compare_command() {
  const auto a = std::make_shared<CompareArguments>();
  return {.name = "measure compare",
          .summary = "deviations of points from a mesh or a cloud",
          .description =
              "Measures how far points lie from a mesh (outside positive) or from another cloud "
              "(towards its sensor positive, where it knows one), and writes colour maps. Both "
              "must be in one frame; nothing is aligned.",
          .examples = {"facula simulate data/scenes/turntable_object.toml --rig "
                       "data/rigs/ciclop_turntable.toml --step-deg 15 --out object",
                       "facula extract object --out object.pcd",
                       "facula mesh object.pcd --voxel-mm 3 --out object.ply",
                       "facula measure compare object.pcd --to object.ply --out colored.ply "
                       "--picture deviations.png"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
