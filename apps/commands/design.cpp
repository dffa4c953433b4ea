// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/range_design.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/design.hpp>
#include <facula/apps/commands/design_plot.hpp>
#include <facula/apps/report/png.hpp>

#include <memory>
#include <utility>

namespace facula {
namespace {

constexpr Unit kSquareMillimetres{"mm2", 1e-6};
constexpr Unit kMicrometres{"um", 1e-6};

struct DesignArguments {
  RangeDesign design{.fs = 760e-6};
  double focal_length = 6e-3;     ///< [m]
  double distance = 6;            ///< [m]
  double error = 0.030;           ///< [m]
  std::optional<double> nearest;  ///< [m]
  std::filesystem::path plot;
};

void declare(Arguments& arguments, DesignArguments& a) {
  arguments.number("--fs-mm2", a.design.fs, kSquareMillimetres, "focal length times baseline");
  arguments.number("--pixel-um", a.design.pixel_size, kMicrometres, "side of a pixel");
  arguments.whole("--width-px", a.design.width, "pixels of the picture, across the line");
  arguments.number(
      "--precision-px", a.design.spot_precision, kPixels, "to which the line is located");
  arguments.number("--focal-length-mm", a.focal_length, kMillimetres, "f, to take f s apart");
  arguments.number("--distance-mm", a.distance, kMillimetres, "farthest distance that matters");
  arguments.number("--error-mm", a.error, kMillimetres, "wanted resolution there");
  arguments.number("--nearest-mm", a.nearest, kMillimetres, "wanted nearest distance");
  arguments.output("--plot", a.plot, "the curves over f s as a picture (.png)");
}

void report_wanted(const DesignArguments& a, Figures& figures) {
  const double wanted = a.design.fs_for(a.error, a.distance);
  RangeDesign other = a.design;
  other.fs = wanted;
  Figures& part = figures.part(
      "wanted",
      "For " + std::to_string(1000 * a.error).substr(0, 5) + " mm at the farthest distance:");
  part.number("fs_mm2", "f s at least", 1e6 * wanted, 1);
  part.number("baseline_mm", "  baseline", 1000 * wanted / a.focal_length, 1);
  part.number("nearest_mm", "  nearest distance then", 1000 * other.nearest(), 1);
  if (!a.nearest) return;
  const double most = a.design.fs_for_nearest(*a.nearest);
  part.number("fs_most_mm2", "f s at most, for the nearest distance", 1e6 * most, 1);
  if (most < wanted) {
    part.note(
        "both cannot be had: the nearest distance asks for a smaller f s than the error; a "
        "wider picture, smaller pixels or a better located line bring them together");
  }
}

void require_above_zero(const DesignArguments& a) {
  const std::pair<const char*, double> typed[] = {{"--fs-mm2", 1e6 * a.design.fs},
                                                  {"--pixel-um", 1e6 * a.design.pixel_size},
                                                  {"--width-px", a.design.width},
                                                  {"--precision-px", a.design.spot_precision},
                                                  {"--focal-length-mm", 1000 * a.focal_length},
                                                  {"--distance-mm", 1000 * a.distance},
                                                  {"--error-mm", 1000 * a.error},
                                                  {"--nearest-mm", 1000 * a.nearest.value_or(1)}};
  for (const auto& [option, value] : typed)
    require(value > 0, option, ": expected a number above 0, got ", value);
}

void run(const DesignArguments& a, Session& session) {
  if (!a.plot.empty()) check_output(a.plot, {".png"});
  require_above_zero(a);
  a.design.check();
  Figures& figures = session.figures;
  figures.number("fs_mm2", "focal length times baseline", 1e6 * a.design.fs, 1);
  figures.number("baseline_mm", "baseline", 1000 * a.design.fs / a.focal_length, 1);
  figures.number("slope", "slope A = f s / p (px mm)", 1000 * a.design.slope(), 0);
  figures.number("nearest_mm", "nearest distance", 1000 * a.design.nearest(), 1);
  figures.number("laser_angle_deg",
                 "sheet to baseline, infinity on the edge",
                 a.design.laser_angle(a.focal_length) / kDegrees.factor,
                 2);
  figures.number("farthest_mm",
                 "farthest distance at the wanted error",
                 1000 * a.design.distance_of(a.error),
                 0);
  FigureTable table{"resolution",
                    "One step of the line's precision:",
                    {{"distance_mm", "distance", 0},
                     {"resolution_mm", "resolution", 3},
                     {"resolution_percent", "resolution", 3}},
                    {}};
  for (int i = 1; i <= 8; ++i) {
    const double distance = a.distance * i / 8;
    const double step = a.design.resolution(distance);
    table.rows.push_back({1000 * distance, 1000 * step, 100 * step / distance});
  }
  figures.table(std::move(table));
  report_wanted(a, figures);
  if (!a.plot.empty()) write_png(a.plot, design_plot(a.design, a.distance));
}

}  // namespace

Command design_command() {
  const auto a = std::make_shared<DesignArguments>();
  return {
      .name = "design",
      .summary = "what focal length times baseline buys",
      .description =
          "The design curves of a triangulating head: the nearest distance f s / (width p), what "
          "one "
          "step of the line's precision is worth at a distance, p e q^2 / (f s), and the f s that "
          "a "
          "wanted error needs. p is the pixel, e the precision. The sources' own tables show a "
          "pixel "
          "of about 10 um where they state 6: fit the slope once the head is built.",
      .examples = {"facula design --fs-mm2 760 --distance-mm 6000 --error-mm 30 --plot design.png",
                   "facula design --fs-mm2 1500 --distance-mm 4000 --error-mm 10 --nearest-mm 300"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
