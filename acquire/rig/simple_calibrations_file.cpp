// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/rig/simple_calibrations_file.hpp>

#include <utility>
#include <vector>

namespace facula {
namespace {

// Of the covariance of slope, vanishing position and bend: in the file the slope counts in px mm.
Eigen::DiagonalMatrix<double, 3> in_millimetres() {
  return Eigen::Vector3d(1000, 1, 1).asDiagonal();
}

Eigen::Matrix3d matrix3(const std::vector<double>& values, const std::string& where) {
  require(values.size() == 9, where, ": expected 9 numbers, row by row, got ", values.size());
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

RangeModel read_range(TomlTable table) {
  RangeModel model;
  model.slope = 1e-3 * table.number("slope_px_mm");
  model.vanishing = table.number("vanishing_px");
  model.bend = table.number_if("bend_per_px2").value_or(0);
  model.centre = table.number_if("centre_px").value_or(0);
  if (table.has("fitted_px")) {
    const std::vector<double> fitted = table.numbers("fitted_px");
    require(fitted.size() == 2, table.where("fitted_px"), ": expected lowest and highest position");
    model.lowest_px = fitted[0];
    model.highest_px = fitted[1];
  }
  if (table.has("covariance")) {
    const Eigen::DiagonalMatrix<double, 3> unit = in_millimetres().inverse();
    model.covariance =
        unit * matrix3(table.numbers("covariance"), table.where("covariance")) * unit;
  }
  table.finish();
  return model;
}

CompensationTable read_compensation(TomlTable table) {
  const int window = table.integer("window_lines");
  std::vector<CompensationTable::Plane> planes;
  for (TomlTable& plane : table.tables("plane")) {
    planes.push_back({plane.number("position_px"), plane.numbers("measured_px")});
    plane.finish();
  }
  table.finish();
  return {std::move(planes), window};
}

ProfilePolynomial read_polynomial(TomlTable table) {
  ProfilePolynomial polynomial;
  polynomial.coefficients = table.numbers("coefficients_mm");
  for (double& c : polynomial.coefficients) c *= 1e-3;
  polynomial.centre = table.number("centre_px");
  polynomial.scale = table.number("scale_px");
  const std::vector<double> fitted = table.numbers("fitted_px");
  require(fitted.size() == 2, table.where("fitted_px"), ": expected lowest and highest position");
  polynomial.lowest_px = fitted[0];
  polynomial.highest_px = fitted[1];
  table.finish();
  return polynomial;
}

SheetProjection read_projection(TomlTable table) {
  SheetProjection projection;
  projection.image_from_sheet =
      matrix3(table.numbers("image_from_sheet_mm"), table.where("image_from_sheet_mm"));
  projection.image_from_sheet.leftCols<2>() *= 1000;
  table.finish();
  return projection;
}

TwoLineHead read_two_line(TomlTable table) {
  TwoLineHead head;
  head.spacing = 1e-3 * table.number("spacing_mm");
  head.divergence = table.number_if("divergence").value_or(0);
  head.medium_index = table.number_if("medium_index").value_or(1);
  table.finish();
  return head;
}

/// Shortest text that gives back the same numbers.
template <typename Numbers>
void write_list(std::ostream& out, const char* key, const Numbers& values) {
  out << key << " = [";
  const char* comma = "";
  for (const double value : values) {
    out << comma << number_text(value);
    comma = ", ";
  }
  out << "]\n";
}

void write_matrix(std::ostream& out, const char* key, const Eigen::Matrix3d& m) {
  const Eigen::Matrix3d rows = m.transpose();
  write_list(out, key, std::vector<double>(rows.data(), rows.data() + 9));
}

void write_range(std::ostream& out, const RangeModel& model) {
  out << "\n[range]\nslope_px_mm = " << 1000 * model.slope << "\nvanishing_px = " << model.vanishing
      << "\n";
  if (model.bend != 0) {
    out << "bend_per_px2 = " << model.bend << "\ncentre_px = " << model.centre << "\n";
  }
  write_list(out, "fitted_px", std::vector<double>{model.lowest_px, model.highest_px});
  const Eigen::DiagonalMatrix<double, 3> unit = in_millimetres();
  if (!model.covariance.isZero(0)) {
    out << "# of slope, vanishing, bend\n";
    write_matrix(out, "covariance", unit * model.covariance * unit);
  }
}

void write_compensation(std::ostream& out, const CompensationTable& table) {
  out << "\n[compensation]\nwindow_lines = " << table.window() << "\n";
  for (const CompensationTable::Plane& plane : table.planes()) {
    out << "\n[[compensation.plane]]\nposition_px = " << number_text(plane.position) << "\n";
    write_list(out, "measured_px", plane.measured);
  }
}

void write_profile(std::ostream& out, const Rig& rig) {
  if (rig.profile_polynomial) {
    const ProfilePolynomial& p = *rig.profile_polynomial;
    std::vector<double> coefficients = p.coefficients;
    for (double& c : coefficients) c *= 1000;
    out << "\n[profile.polynomial]\n";
    write_list(out, "coefficients_mm", coefficients);
    out << "centre_px = " << p.centre << "\nscale_px = " << p.scale << "\n";
    write_list(out, "fitted_px", std::vector<double>{p.lowest_px, p.highest_px});
  }
  if (rig.profile_projection) {
    Eigen::Matrix3d m = rig.profile_projection->image_from_sheet;
    m.leftCols<2>() /= 1000;
    out << "\n[profile.projection]\n";
    write_matrix(out, "image_from_sheet_mm", m);
  }
}

}  // namespace

void read_simple_calibrations(TomlTable& table, Rig& rig) {
  if (auto range = table.table_if("range")) rig.range = read_range(std::move(*range));
  if (auto compensation = table.table_if("compensation")) {
    rig.compensation = read_compensation(std::move(*compensation));
  }
  if (auto profile = table.table_if("profile")) {
    if (auto p = profile->table_if("polynomial"))
      rig.profile_polynomial = read_polynomial(std::move(*p));
    if (auto p = profile->table_if("projection"))
      rig.profile_projection = read_projection(std::move(*p));
    profile->finish();
  }
  if (auto head = table.table_if("two_line")) rig.two_line = read_two_line(std::move(*head));
}

void write_simple_calibrations(std::ostream& out, const Rig& rig) {
  if (rig.range) write_range(out, *rig.range);
  if (rig.compensation) write_compensation(out, *rig.compensation);
  write_profile(out, rig);
  if (rig.two_line) {
    out << "\n[two_line]\nspacing_mm = " << 1000 * rig.two_line->spacing
        << "\ndivergence = " << rig.two_line->divergence
        << "\nmedium_index = " << rig.two_line->medium_index << "\n";
  }
}

}  // namespace facula
