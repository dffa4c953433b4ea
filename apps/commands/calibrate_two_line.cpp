// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/two_line/two_line_fit.hpp>
#include <facula/acquire/two_line/two_line_frame.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/calibrate_two_line.hpp>
#include <facula/apps/commands/wall_table.hpp>

#include <cmath>
#include <memory>

namespace facula {
namespace {

struct TwoLineArguments {
  std::filesystem::path table;
  std::filesystem::path rig;
  std::filesystem::path out;
  bool parallel = false;
  double medium_index = 1;
  WallStripe stripe{.channel = "green-excess", .sigma = 2};
};

void declare(Arguments& arguments, TwoLineArguments& a) {
  arguments.input("TABLE.csv",
                  a.table,
                  "columns distance_mm and separation_px (undistorted) or frame (a picture of a "
                  "wall square to the camera's axis)");
  arguments.required();
  arguments.input("--rig", a.rig, "the rig whose camera this is (rig.toml)");
  arguments.required();
  arguments.output("--out", a.out, "that rig with the two-line head (.toml)");
  arguments.flag("--parallel", a.parallel, "take the sheets as parallel");
  arguments.number("--medium-index",
                   a.medium_index,
                   kPlainNumber,
                   "refractive index in front of a flat window, for a camera calibrated in air");
  declare_wall_stripe(arguments, a.stripe);
}

/// The mean separation over the segments of a frame.
double separation_in(const Image8& frame, const TwoLineArguments& a, const Rig& rig) {
  TwoLineOptions options;
  options.stripe.channel = channel_from_name(a.stripe.channel);
  options.stripe.sigma = a.stripe.sigma;
  double sum = 0;
  int count = 0;
  for (const TwoLineReading& r : read_two_lines(frame.view(), {}, rig, options)) {
    if (!r.failure.empty()) continue;
    sum += separation_of(r, rig);
    ++count;
  }
  return count == 0 ? std::nan("") : sum / count;
}

std::vector<TwoLinePoint> read_points(const TwoLineArguments& a, const Rig& rig) {
  const CsvTable csv = CsvTable::from_file(a.table);
  const std::vector<double> distances = csv.column(kDistanceColumns);
  std::vector<TwoLinePoint> points;
  if (!csv.has("frame")) {
    const std::vector<double> separations = csv.column({"separation_px"});
    for (std::size_t i = 0; i < distances.size(); ++i) {
      points.push_back({separations[i] / (rig.camera.fy * a.medium_index), distances[i]});
    }
    return points;
  }
  const std::vector<std::string> frames = csv.texts("frame");
  Rig reading = rig;  // any spacing: only the separations are used
  reading.two_line = TwoLineHead{.spacing = 1, .divergence = -0.99, .medium_index = a.medium_index};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double separation =
        separation_in(read_image(a.table.parent_path() / frames[i]), a, reading);
    require(std::isfinite(separation),
            "frame '",
            frames[i],
            "' shows no two lines; give --channel and --sigma-px that suit it");
    points.push_back({separation, distances[i]});
  }
  return points;
}

void report(const TwoLineFit& fit,
            const std::vector<TwoLinePoint>& points,
            double focal_length,
            Figures& figures) {
  figures.count("point_count", "distances", points.size());
  figures.number("spacing_mm", "spacing of the sheets", 1000 * fit.head.spacing, 3);
  figures.number("spacing_sigma_mm", "  1 sigma", 1000 * fit.spacing_sigma, 3);
  figures.number("divergence", "drift of the sheets (mm per m)", 1000 * fit.head.divergence, 3);
  figures.number("divergence_sigma", "  1 sigma (mm per m)", 1000 * fit.divergence_sigma, 3);
  figures.number("rms_px", "separations, rms", focal_length * fit.rms_separation, 3);
  figures.number("rms_mm", "distances, rms", 1000 * fit.rms, 2);
  figures.number("held_out_rms_mm", "left out one by one, rms", 1000 * fit.held_out_rms, 2);
  figures.number(
      "parallel_held_out_rms_mm", "  with parallel sheets", 1000 * fit.parallel_held_out_rms, 2);
  FigureTable table{"points",
                    "Distances:",
                    {{"distance_mm", "distance", 1},
                     {"separation_px", "separation", 3},
                     {"residual_mm", "residual", 2},
                     {"residual_percent", "residual", 3},
                     {"tenth_px_mm", "0.1 px is", 2}},
                    {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TwoLinePoint& p = points[i];
    table.rows.push_back({1000 * p.distance,
                          focal_length * p.separation,
                          1000 * fit.residual[i],
                          100 * fit.residual[i] / p.distance,
                          1000 * fit.head.depth_error(p.distance, 0.1 / focal_length)});
  }
  figures.table(std::move(table));
  for (const std::string& warning : fit.warnings) figures.note("Warning: " + warning + ".");
}

void run(const TwoLineArguments& a, Session& session) {
  if (!a.out.empty()) check_output(a.out, {".toml"});
  require(a.medium_index >= 1 && a.medium_index <= 3,
          "--medium-index: expected 1 (air) to 3, got ",
          a.medium_index);
  Rig rig = read_rig(a.rig, RigParts::kCamera);
  const std::vector<TwoLinePoint> points = read_points(a, rig);
  const TwoLineFit fit =
      fit_two_line(points, {.divergence = !a.parallel, .medium_index = a.medium_index});
  report(fit, points, rig.camera.fy * a.medium_index, session.figures);
  if (a.out.empty()) return;
  rig.two_line = fit.head;
  write_rig(a.out, rig);
  session.figures.text("out", "written", a.out.string());
}

}  // namespace

Command calibrate_two_line_command() {
  const auto a = std::make_shared<TwoLineArguments>();
  return {
      .name = "calibrate two-line",
      .summary = "two parallel lines at known distances -> rangefinder",
      .description =
          "Calibrates a head of two level lines, z = f dY / dy: the spacing of its sheets and, "
          "where "
          "leaving out one distance at a time says that it is worth it, their drift. Under water "
          "the "
          "camera must be calibrated there, or --medium-index says what stands before its window.",
      .examples = {"facula calibrate two-line data/tables/two_line_separations_simulated.csv --rig "
                   "data/rigs/two_line_air.toml --out rig.toml"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
