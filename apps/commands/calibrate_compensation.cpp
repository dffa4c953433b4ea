// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/compensation_fit.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/calibrate_compensation.hpp>
#include <facula/apps/commands/wall_table.hpp>

#include <cmath>
#include <memory>

namespace facula {
namespace {

struct CompensationArguments {
  std::filesystem::path table;
  std::filesystem::path rig;
  std::filesystem::path out;
  CompensationOptions options;
  WallStripe stripe;
};

void declare(Arguments& arguments, CompensationArguments& a) {
  arguments.input("WALLS.csv",
                  a.table,
                  "columns distance_mm and frame; or distance_mm, line, position_px; or true_m, "
                  "top_px, centre_px, bottom_px");
  arguments.required();
  arguments.input("--rig", a.rig, "the rig whose camera this is (rig.toml)");
  arguments.required();
  arguments.output("--out", a.out, "that rig with the table (.toml)");
  arguments.whole("--window-lines", a.options.window, "lines to both sides that are averaged");
  arguments.whole("--smooth-lines",
                  a.options.smooth,
                  "lines to both sides over which each wall's line is smoothed, 0 = not");
  declare_wall_stripe(arguments, a.stripe);
}

std::string millimetres(double distance) {
  return std::to_string(std::lround(1000 * distance)) + " mm";
}

void report(const CompensationFit& fit, const Rig& rig, Figures& figures) {
  figures.count("plane_count", "walls", fit.planes.size());
  figures.count("lines", "lines", static_cast<std::size_t>(fit.table.lines()));
  FigureTable table{"planes",
                    "Walls (left out: what the table of the others leaves of a wall):",
                    {{"wall", "wall", 0},
                     {"position_px", "position", 3},
                     {"largest_shift_px", "largest shift", 3},
                     {"scatter_px", "scatter", 3},
                     {"seen_lines", "lines seen", 0},
                     {"filled_lines", "filled", 0},
                     {"before_px", "rms before", 3},
                     {"held_out_px", "rms left out", 3},
                     {"before_mm", "rms before", 2},
                     {"held_out_mm", "rms left out", 2}},
                    {}};
  for (const CompensationPlane& p : fit.planes) {
    const double scale = rig.range && rig.range->depth(p.position)
                             ? 1000 * std::abs(rig.range->depth_per_px(p.position))
                             : std::nan("");
    table.rows.push_back({p.name,
                          p.position,
                          p.largest_shift,
                          p.scatter,
                          static_cast<long long>(p.seen),
                          static_cast<long long>(p.filled),
                          p.uncorrected_rms,
                          p.held_out_rms,
                          scale * p.uncorrected_rms,
                          scale * p.held_out_rms});
  }
  figures.table(std::move(table));
  for (const std::string& warning : fit.warnings) figures.note("Warning: " + warning + ".");
  if (!rig.range) {
    figures.note(
        "the rig has no range model, so nothing is said in mm; 'facula calibrate range' "
        "makes one from the same table");
  }
}

void run(const CompensationArguments& a, Session& session) {
  if (!a.out.empty()) check_output(a.out, {".toml"});
  require(a.options.window <= 1000, "--window-lines: expected 0 to 1000, got ", a.options.window);
  require(a.options.smooth == 0 || (a.options.smooth >= 2 && a.options.smooth <= 1000),
          "--smooth-lines: expected 0, or 2 to 1000, got ",
          a.options.smooth);
  a.options.check();
  Rig rig = read_rig(a.rig, RigParts::kCamera);
  std::vector<PlaneView> views;
  for (const Wall& wall : read_walls(a.table, rig, a.stripe)) {
    views.push_back({millimetres(wall.distance), wall.positions});
  }
  CompensationFit fit = fit_compensation(views, a.options);
  report(fit, rig, session.figures);
  if (a.out.empty()) return;
  rig.compensation = std::move(fit.table);
  write_rig(a.out, rig, RigParts::kCamera);
  session.figures.text("out", "written", a.out.string());
}

}  // namespace

Command calibrate_compensation_command() {
  const auto a = std::make_shared<CompensationArguments>();
  return {
      .name = "calibrate compensation",
      .summary = "flat walls -> table against tilt, bow and distortion",
      .description =
          "Builds the pixel compensation table of a head with a range model: the line on flat "
          "walls at several distances, square to the camera's axis, is brought to its position in "
          "the middle of the picture. Each wall is also corrected by the table of the others: that "
          "is what stays between the distances of the table.",
      .examples = {"facula calibrate range data/tables/curve_fit_fs1500.csv --rig "
                   "data/rigs/head_fs1500.toml --replace-laser --out range.toml",
                   "facula calibrate compensation data/tables/pixel_error_fs1500.csv --rig "
                   "range.toml --out rig.toml"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
