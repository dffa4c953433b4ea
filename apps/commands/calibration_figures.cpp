// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/rig/rig_parameters.hpp>
#include <facula/apps/commands/calibration_figures.hpp>

namespace facula {
namespace {

void report_residuals(const JointCalibration& result, Figures& figures) {
  const auto part = [&](const std::string& key, const std::string& label, const JointFigures& f) {
    figures.number(key + "_point_rms_px", label + ", board points, rms", f.point_rms, 3);
    figures.number(key + "_point_median_px", label + ", board points, middle", f.point_median, 3);
    if (result.line_points == 0) return;
    figures.number(key + "_line_rms_px", label + ", laser lines, rms", f.line_rms, 3);
    figures.number(
        key + "_line_rms_mm", label + ", laser lines off the sheet, rms", f.line_rms_mm, 3);
  };
  if (result.held_out) part("held_out", "held out", *result.held_out);
  part("fit", "fitted", result.fit);
  figures.count("views", "views", result.views.size());
  figures.count("points", "board points", result.points);
  figures.count("wrong_points", "  left out of the fit", result.wrong_points);
  figures.count("line_points", "line points", result.line_points);
  figures.count("wrong_line_points", "  left out of the fit", result.wrong_line_points);
  figures.number("point_sigma_px", "noise of a board point", result.point_sigma, 3);
  figures.number(
      "line_sigma_ratio", "lines scatter, times their sigmas", result.line_sigma_ratio, 2);
  figures.number("reduced_chi_squared", "reduced chi squared", result.reduced_chi_squared, 3);
  if (result.fold_scatter > 0) {
    figures.number(
        "fold_scatter", "parts of the views scatter, times the sigmas", result.fold_scatter, 2);
  }
}

void report_views(const JointCalibration& result, Figures& figures) {
  FigureTable table{"views_table",
                    "Views (held out where not said otherwise):",
                    {{"view", "view"},
                     {"points", "points"},
                     {"wrong", "wrong"},
                     {"fit_rms_px", "fit rms", 3},
                     {"held_out_rms_px", "rms", 3},
                     {"line_points", "line"},
                     {"line_rms_px", "line rms", 3},
                     {"line_mean_mm", "line mean", 3}},
                    {}};
  for (const JointViewResidual& v : result.views) {
    table.rows.push_back({v.name,
                          static_cast<long long>(v.points),
                          static_cast<long long>(v.wrong_points),
                          v.point_rms,
                          v.held_out_point_rms,
                          static_cast<long long>(v.line_points),
                          v.held_out_line_rms,
                          v.held_out_line_mean_mm});
  }
  figures.table(std::move(table));
}

void report_parameters(const Rig& rig, Figures& figures) {
  if (!rig.covariance) return;
  FigureTable table{
      "parameters", "Parameters and their sigma:", {{"name", "name"}, {"sigma", "sigma", 6}}, {}};
  for (const std::string& name : rig.covariance->parameters) {
    table.rows.push_back({name, parameter_sigma(rig, name)});
  }
  figures.table(std::move(table));
}

}  // namespace

void report_calibration(const JointCalibration& result, Figures& figures) {
  report_residuals(result, figures);
  for (const BoardScale& scale : result.scales) {
    const std::string key = "board_" + std::to_string(scale.board + 1) + "_size";
    if (!scale.decided) continue;
    figures.number(key, "size of board " + std::to_string(scale.board + 1), scale.factor, 5);
    figures.number(key + "_sigma", "  sigma", scale.sigma, 5);
    figures.flag(key + "_conflict", "  contradicts board 1", scale.conflict);
  }
  report_views(result, figures);
  report_parameters(result.rig, figures);
  for (const std::string& sentence : result.rejected) figures.note("Not used: " + sentence + ".");
  for (const std::string& sentence : result.warnings) figures.note("Warning: " + sentence + ".");
}

}  // namespace facula
