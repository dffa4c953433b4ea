// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/profile_figures.hpp>

#include <cmath>
#include <limits>
#include <optional>

namespace facula {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kParallel = 0.0873;  // 5 degrees

double angle_of(const ProfilePiece& piece) {
  return std::atan2(piece.direction.y(), piece.direction.x());
}

std::vector<FigureValue> row_of(std::size_t number,
                                const ProfilePiece& piece,
                                const StepMeasure& step,
                                const ProfileLength& side) {
  const auto points = static_cast<long long>(piece.span.last - piece.span.first);
  std::vector<FigureValue> row{static_cast<long long>(number), points};
  for (const double value : {1000 * piece.middle.x(),
                             1000 * piece.middle.y(),
                             angle_of(piece) / kDegrees.factor,
                             1000 * piece.scatter,
                             1000 * step.thickness,
                             1000 * step.sigma,
                             1000 * side.value,
                             1000 * side.sigma}) {
    row.emplace_back(value);
  }
  return row;
}

std::vector<double> millimetres(const Eigen::Vector3d& x) {
  return {1000 * x.x(), 1000 * x.y(), 1000 * x.z()};
}

void report_quality(const PrimitiveQuality& quality, Figures& figures) {
  figures.count("shape_points", "points on it", quality.points);
  figures.number("rms_mm", "rms", 1000 * quality.rms, 4);
  figures.number("peak_to_valley_mm", "peak to valley", 1000 * quality.peak_to_valley, 4);
  if (quality.chi_squared > 0 && quality.degrees_of_freedom > 0) {
    figures.number("chi_squared_per_degree",
                   "chi squared per degree of freedom",
                   quality.chi_squared / static_cast<double>(quality.degrees_of_freedom),
                   3);
  }
}

void report_diameter(double radius, double sigma, Figures& figures) {
  figures.number("diameter_mm", "diameter", 2000 * radius, 4);
  figures.number("diameter_sigma_mm", "sigma of the diameter", 2000 * sigma, 4);
}

}  // namespace

FigureTable piece_table(const std::vector<Eigen::Vector2d>& profile,
                        const std::vector<ProfilePiece>& pieces,
                        double gap) {
  FigureTable table{"pieces",
                    "Straight pieces of the section, from left to right:",
                    {{"piece", "piece", 0},
                     {"points", "points", 0},
                     {"across_mm", "across", 3},
                     {"height_mm", "height", 3},
                     {"angle_deg", "angle", 3},
                     {"scatter_mm", "scatter", 4},
                     {"step_mm", "step over base", 4},
                     {"step_sigma_mm", "sigma of step", 4},
                     {"side_mm", "side", 4},
                     {"side_sigma_mm", "sigma of side", 4}},
                    {}};
  const std::optional<std::size_t> base = base_piece(pieces);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const ProfilePiece& piece = pieces[i];
    StepMeasure step{.thickness = kUnknown, .sigma = kUnknown};
    if (base && i != *base && std::abs(angle_of(piece) - angle_of(pieces[*base])) < kParallel) {
      step = step_between(profile, pieces[*base], piece);
    }
    const ProfileLength side =
        side_length(profile, pieces, i, gap).value_or(ProfileLength{kUnknown, kUnknown});
    table.rows.push_back(row_of(i + 1, piece, step, side));
  }
  return table;
}

void report_circle(const CircleFit& fit, Figures& figures) {
  report_diameter(fit.radius, fit.radius_sigma, figures);
  figures.numbers(
      "center_mm", "centre (across, height)", {1000 * fit.center.x(), 1000 * fit.center.y()}, 3);
  report_quality(fit.quality, figures);
}

void report_cylinder(const CylinderFit& fit, Figures& figures) {
  const Eigen::Vector3d& a = fit.cylinder.axis;
  report_diameter(fit.cylinder.radius, fit.radius_sigma, figures);
  figures.numbers("axis", "axis", {a.x(), a.y(), a.z()}, 5);
  figures.number("axis_sigma_deg", "sigma of the axis", fit.axis_sigma / kDegrees.factor, 4);
  figures.numbers("point_mm", "middle of the axis", millimetres(fit.cylinder.point), 3);
  figures.number("length_mm", "length seen", 1000 * fit.length, 2);
  figures.number("covered_deg", "part of the turn seen", fit.covered / kDegrees.factor, 1);
  report_quality(fit.quality, figures);
}

void report_sphere(const SphereFit& fit, Figures& figures) {
  report_diameter(fit.sphere.radius, fit.radius_sigma, figures);
  figures.numbers("center_mm", "centre", millimetres(fit.sphere.center), 3);
  report_quality(fit.quality, figures);
}

}  // namespace facula
