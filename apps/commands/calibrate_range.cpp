// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/range_fit.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/calibrate_range.hpp>
#include <facula/apps/commands/wall_table.hpp>

#include <cmath>
#include <memory>

namespace facula {
namespace {

struct RangeArguments {
  std::filesystem::path table;
  std::filesystem::path rig;
  std::filesystem::path out;
  bool replace_laser = false;
  std::string terms = "auto";
  std::string minimise = "px";
  std::optional<double> centre;  ///< [px]
  WallStripe stripe;
};

void declare(Arguments& arguments, RangeArguments& a) {
  arguments.input("TABLE.csv",
                  a.table,
                  "columns distance_mm (or true_mm, ..._m) and position_px (or pixel_px), or "
                  "walls as 'facula calibrate compensation' takes them");
  arguments.required();
  arguments.input("--rig", a.rig, "the rig whose camera this is (rig.toml)");
  arguments.output("--out", a.out, "that rig with the range model (.toml)");
  arguments.flag(
      "--replace-laser",
      a.replace_laser,
      "take the laser planes out of the rig: the range model is used where there is none");
  arguments.choice("--terms",
                   a.terms,
                   {"auto", "plain", "bend", "origin"},
                   "what is fitted besides slope and vanishing position; auto = least error left "
                   "out");
  arguments.choice("--minimise", a.minimise, {"px", "mm"}, "whose squares are made least");
  arguments.number("--centre-px", a.centre, kPixels, "about which the bend counts");
  declare_wall_stripe(arguments, a.stripe);
}

std::vector<RangePoint> read_points(const RangeArguments& a, const std::optional<Rig>& rig) {
  const CsvTable csv = CsvTable::from_file(a.table);
  std::vector<RangePoint> points;
  if (csv.has("frame") || csv.has("line") || csv.has("centre_px")) {
    require(rig.has_value(), "a table of walls needs --rig, whose camera took them");
    for (const Wall& wall : read_walls(a.table, *rig, a.stripe)) {
      const double px = middle_position(wall);
      require(std::isfinite(px),
              "the line was not seen in the middle of the wall at ",
              1000 * wall.distance,
              " mm; give --sigma-px and --channel that suit it, or leave that wall out");
      points.push_back({px, wall.distance});
    }
    return points;
  }
  const std::vector<double> distances = csv.column(kDistanceColumns);
  const std::vector<double> positions = csv.column(kPositionColumns);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    points.push_back({positions[i], distances[i]});
  }
  return points;
}

RangeFitOptions options_of(const RangeArguments& a, const std::optional<Rig>& rig) {
  RangeFitOptions options;
  options.minimise = a.minimise == "px" ? RangeResidual::kPixels : RangeResidual::kDistances;
  for (const RangeTerms terms : {RangeTerms::kBend, RangeTerms::kOrigin}) {
    if (to_string(terms) == a.terms) options.terms = terms;
  }
  if (rig) {
    options.centre =
        rig->stripe_direction == StripeDirection::kPerRow ? rig->camera.cx : rig->camera.cy;
  }
  options.centre = a.centre.value_or(options.centre);
  return options;
}

void report_comparison(const std::vector<RangeFit>& fits, Figures& figures) {
  FigureTable table{"models",
                    "Models, the smallest error left out first:",
                    {{"model", "model", 0},
                     {"slope", "slope (px mm)", 0},
                     {"vanishing_px", "vanishing", 3},
                     {"bend", "bend (1/px^2)", 9},
                     {"origin_mm", "origin", 2},
                     {"rms_px", "rms", 3},
                     {"rms_mm", "rms", 2},
                     {"held_out_px", "left out", 3},
                     {"held_out_mm", "left out", 2}},
                    {}};
  for (const RangeFit& f : fits) {
    table.rows.push_back({to_string(f.terms),
                          1000 * f.model.slope,
                          f.model.vanishing,
                          f.model.bend,
                          1000 * f.origin,
                          f.rms_px,
                          1000 * f.rms,
                          f.held_out_rms_px,
                          1000 * f.held_out_rms});
  }
  figures.table(std::move(table));
}

void report_points(const std::vector<RangePoint>& points, const RangeFit& fit, Figures& figures) {
  FigureTable table{"points",
                    "Points (modelled - measured distance, measured - modelled position):",
                    {{"distance_mm", "distance", 1},
                     {"position_px", "position", 3},
                     {"residual_px", "residual", 3},
                     {"residual_mm", "residual", 2},
                     {"held_out_px", "left out", 3},
                     {"held_out_mm", "left out", 2},
                     {"tenth_px_mm", "0.1 px is", 2}},
                    {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    table.rows.push_back({1000 * points[i].distance,
                          points[i].px,
                          fit.residual_px[i],
                          1000 * fit.residual[i],
                          fit.held_out_px[i],
                          1000 * fit.held_out[i],
                          100 * std::abs(fit.model.depth_per_px(points[i].px))});
  }
  figures.table(std::move(table));
}

void report_fit(const RangeFit& fit, Figures& figures) {
  figures.text("terms", "model", to_string(fit.terms));
  figures.number("slope", "slope A (px mm)", 1000 * fit.model.slope, 1);
  figures.number("slope_sigma", "  1 sigma (px mm)", 1000 * fit.sigma[0], 1);
  figures.number("vanishing_px", "vanishing position", fit.model.vanishing, 4);
  figures.number("vanishing_sigma_px", "  1 sigma", fit.sigma[1], 4);
  if (fit.terms == RangeTerms::kBend) {
    figures.number("bend", "bend (1/px^2)", fit.model.bend, 10);
    figures.number("bend_sigma", "  1 sigma (1/px^2)", fit.sigma[2], 10);
  }
  if (fit.terms == RangeTerms::kOrigin) {
    figures.number("origin_mm", "distances count from", 1000 * fit.origin, 2);
    figures.number("origin_sigma_mm", "  1 sigma", 1000 * fit.sigma[2], 2);
  }
  figures.number("rms_px", "residual, rms", fit.rms_px, 4);
  figures.number("rms_mm", "residual, rms", 1000 * fit.rms, 3);
  figures.number("held_out_rms_px", "left out one by one, rms", fit.held_out_rms_px, 4);
  figures.number("held_out_rms_mm", "left out one by one, rms", 1000 * fit.held_out_rms, 3);
}

void run(const RangeArguments& a, Session& session) {
  require(a.out.empty() || !a.rig.empty(), "--out needs --rig: the model is written into a rig");
  if (!a.out.empty()) check_output(a.out, {".toml"});
  std::optional<Rig> rig;
  if (!a.rig.empty()) rig = read_rig(a.rig, RigParts::kCamera);
  const std::vector<RangePoint> points = read_points(a, rig);
  const RangeFitOptions options = options_of(a, rig);
  const std::vector<RangeFit> fits = compare_range_models(points, options);
  const RangeFit fit = a.terms == "auto" ? fits.front() : fit_range(points, options);
  session.figures.count("point_count", "points", points.size());
  report_fit(fit, session.figures);
  report_comparison(fits, session.figures);
  report_points(points, fit, session.figures);
  for (const std::string& warning : fit.warnings) session.figures.note("Warning: " + warning + ".");
  if (a.out.empty()) return;
  if (a.replace_laser) rig->lasers.clear();
  rig->range = fit.model;
  write_rig(a.out, *rig);
  session.figures.text("out", "written", a.out.string());
  if (!rig->lasers.empty()) {
    session.figures.note(
        "The rig keeps its laser planes, which go before the range model; "
        "--replace-laser takes them out.");
  }
}

}  // namespace

Command calibrate_range_command() {
  const auto a = std::make_shared<RangeArguments>();
  return {
      .name = "calibrate range",
      .summary = "positions at known distances -> d = A / (x0 - px)",
      .description =
          "Fits the ranging hyperbola to positions of the line at measured distances, for heads "
          "that have no board: d = A / (x0 - px), with a third-order bend or an origin of the "
          "distances where leaving out one point at a time says that it is worth it. Reports the "
          "residual in px and mm, every point, and what the points cannot decide.",
      .examples = {"facula calibrate range data/tables/curve_fit_fs1500.csv --minimise mm --terms "
                   "plain",
                   "facula calibrate range data/tables/curve_fit_fs760.csv --rig "
                   "data/rigs/head_fs760.toml --replace-laser --out rig.toml"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
