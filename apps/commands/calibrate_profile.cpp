// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/profile/profile_polynomial_fit.hpp>
#include <facula/acquire/profile/sheet_projection_fit.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/calibrate_profile.hpp>
#include <facula/apps/commands/wall_table.hpp>

#include <memory>

namespace facula {
namespace {

struct ProfileArguments {
  std::filesystem::path table;
  std::filesystem::path rig;
  std::filesystem::path out;
  int degree = 0;  ///< 0 = chosen
  int max_degree = 6;
};

void declare(Arguments& arguments, ProfileArguments& a) {
  arguments.input("POINTS.csv",
                  a.table,
                  "columns position_px and size_mm: a polynomial; or across_mm, height_mm, x_px, "
                  "y_px: the projection of the sheet");
  arguments.required();
  arguments.input("--rig", a.rig, "the rig whose camera this is (rig.toml)");
  arguments.output("--out", a.out, "that rig with the calibration (.toml)");
  arguments.whole("--degree", a.degree, "of the polynomial, 0 = the one that leaves out best");
  arguments.whole("--max-degree", a.max_degree, "highest degree that is tried");
}

ProfilePolynomial calibrate_polynomial(const ProfileArguments& a,
                                       const CsvTable& csv,
                                       Figures& figures) {
  const std::vector<double> px = csv.column(kPositionColumns);
  const std::vector<double> sizes = csv.column({"size_mm", "diameter_mm", "height_mm"});
  std::vector<ProfilePoint> points;
  for (std::size_t i = 0; i < px.size(); ++i) points.push_back({px[i], sizes[i]});
  ProfilePolynomialOptions options;
  require(a.max_degree >= 1 && a.max_degree <= 12,
          "--max-degree: expected 1 to 12, got ",
          a.max_degree);
  require(a.degree <= 12, "--degree: expected 1 to 12, or 0 to have it chosen, got ", a.degree);
  options.max_degree = a.max_degree;
  if (a.degree > 0) options.degree = a.degree;
  const ProfilePolynomialFit fit = fit_profile_polynomial(points, options);
  figures.text("method", "method", "polynomial");
  figures.count("degree", "degree", static_cast<std::size_t>(fit.polynomial.degree()));
  std::vector<double> plain = fit.polynomial.plain_coefficients();
  for (double& c : plain) c *= 1000;
  figures.numbers("coefficients", "coefficients, lowest first (mm/px^i)", plain, 9);
  figures.number("lowest_px", "from", fit.polynomial.lowest_px, 2);
  figures.number("highest_px", "to", fit.polynomial.highest_px, 2);
  figures.number("rms_mm", "residual, rms", 1000 * fit.rms, 4);
  figures.number("held_out_rms_mm", "left out one by one, rms", 1000 * fit.held_out_rms, 4);
  FigureTable trials{
      "degrees",
      "Degrees:",
      {{"degree", "degree", 0}, {"rms_mm", "rms", 4}, {"held_out_mm", "left out", 4}},
      {}};
  for (const PolynomialTrial& t : fit.trials) {
    trials.rows.push_back({static_cast<long long>(t.degree), 1000 * t.rms, 1000 * t.held_out_rms});
  }
  figures.table(std::move(trials));
  for (const std::string& warning : fit.warnings) figures.note("Warning: " + warning + ".");
  return fit.polynomial;
}

SheetProjection calibrate_projection(const CsvTable& csv,
                                     const std::optional<Rig>& rig,
                                     Figures& figures) {
  const std::vector<double> across = csv.column({"across_mm"});
  const std::vector<double> height = csv.column({"height_mm"});
  const std::vector<double> x = csv.column({"x_px"});
  const std::vector<double> y = csv.column({"y_px"});
  std::vector<SheetPoint> points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    Eigen::Vector2d pixel(x[i], y[i]);
    if (rig) {  // The projection is that of a camera without distortion.
      const Camera& c = rig->camera;
      const auto normalized = c.undistort(pixel);
      require(normalized.has_value(), "the pixel ", x[i], ", ", y[i], " cannot be undistorted");
      pixel = {c.fx * normalized->x() + c.cx, c.fy * normalized->y() + c.cy};
    }
    points.push_back({{across[i], height[i]}, pixel});
  }
  const SheetProjectionFit fit = fit_sheet_projection(points);
  figures.text("method", "method", "projection of the sheet");
  figures.count("point_count", "points", points.size());
  figures.number("rms_px", "residual, rms", fit.rms_px, 4);
  figures.number("rms_mm", "residual, rms", 1000 * fit.rms, 4);
  figures.number("held_out_rms_px", "left out one by one, rms", fit.held_out_rms_px, 4);
  figures.number("held_out_rms_mm", "left out one by one, rms", 1000 * fit.held_out_rms, 4);
  for (const std::string& warning : fit.warnings) figures.note("Warning: " + warning + ".");
  return fit.projection;
}

void run(const ProfileArguments& a, Session& session) {
  require(a.out.empty() || !a.rig.empty(), "--out needs --rig: the fit is written into a rig");
  if (!a.out.empty()) check_output(a.out, {".toml"});
  std::optional<Rig> rig;
  if (!a.rig.empty()) rig = read_rig(a.rig, RigParts::kCamera);
  const CsvTable csv = CsvTable::from_file(a.table);
  if (csv.has("across_mm")) {
    const SheetProjection projection = calibrate_projection(csv, rig, session.figures);
    if (rig) rig->profile_projection = projection;
  } else {
    const ProfilePolynomial polynomial = calibrate_polynomial(a, csv, session.figures);
    if (rig) rig->profile_polynomial = polynomial;
  }
  if (a.out.empty()) return;
  write_rig(a.out, *rig);
  session.figures.text("out", "written", a.out.string());
}

}  // namespace

Command calibrate_profile_command() {
  const auto a = std::make_shared<ProfileArguments>();
  return {.name = "calibrate profile",
          .summary = "known pieces -> polynomial or projection of the sheet",
          .description =
              "Calibrates a bench that measures profiles. From pieces of known size: a polynomial "
              "of the "
              "line's position, its degree chosen by leaving out one piece at a time. From known "
              "points "
              "in the sheet of light: its projection matrix, least squares in the picture.",
          .examples =
              {"facula calibrate profile data/tables/rods_of_polynomial.csv --rig "
               "data/rigs/profile_bench.toml --out bench.toml",
               "facula calibrate profile data/tables/profile_grid_simulated.csv --rig bench.toml "
               "--out rig.toml"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
