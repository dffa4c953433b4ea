// SPDX-License-Identifier: GPL-3.0-or-later
//
// Source D: a laser from above, a camera at 45 degrees: thickness of a stack, sides of polygons
// from their height, diameters of rods from a polynomial.
#include <facula/acquire/profile/profile_polynomial_fit.hpp>
#include <facula/acquire/profile/sheet_projection_fit.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/reconstruct/measure/profile_measures.hpp>
#include <facula/tests/bench/accuracy/error_statistics.hpp>
#include <facula/tests/bench/accuracy/exact_stripe.hpp>
#include <facula/tests/bench/accuracy/studies.hpp>
#include <facula/tests/bench/accuracy/table_file.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace facula {
namespace {

constexpr double kNoise = 0.1;  // [px]
constexpr double kGround =
    -0.025;  // where the work lies, so that 40 mm of height stay in the picture
using Profile = std::vector<Eigen::Vector2d>;
using Outline = std::vector<Eigen::Vector2d>;

/// A convex body's outline (across, height), counter-clockwise, drawn out along the work's way, on
/// the ground, in the camera frame of the bench.
SurfaceHit prism_on_plane(const Rig& rig, const Outline& outline) {
  const RigidTransform scan_from_camera = rig.axis.scan_from_camera;
  return [=](const Eigen::Vector3d& ray) -> std::optional<Eigen::Vector3d> {
    const Eigen::Vector3d o = scan_from_camera.translation;
    const Eigen::Vector3d d = scan_from_camera.rotation * ray;
    if (!(d.z() < 0)) return std::nullopt;
    double enter = 0;
    double leave = 1e9;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d edge = outline[(i + 1) % outline.size()] - outline[i];
      const Eigen::Vector2d outward(edge.y(), -edge.x());
      const double away = outward.dot(Eigen::Vector2d(o.x(), o.z() - kGround) - outline[i]);
      const double approach = -outward.dot(Eigen::Vector2d(d.x(), d.z()));
      if (approach > 0) enter = std::max(enter, away / approach);
      if (approach < 0) leave = std::min(leave, away / approach);
      if (approach == 0 && away > 0) leave = -1;
    }
    const double ground = (kGround - o.z()) / d.z();
    return (!outline.empty() && enter < leave ? std::min(enter, ground) : ground) * ray;
  };
}

Outline regular_polygon(int sides, double side) {
  const double radius = side / (2 * std::sin(std::numbers::pi / sides));
  Outline outline;
  for (int i = 0; i < sides; ++i) {
    const double angle = -std::numbers::pi / 2 + std::numbers::pi / sides * (2 * i + 1);
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  const double low =
      outline.front().y() < outline.back().y() ? outline.front().y() : outline.back().y();
  for (Eigen::Vector2d& corner : outline) corner.y() -= low;
  return outline;
}

Outline box(double width, double height) {
  return {{-width / 2, 0}, {width / 2, 0}, {width / 2, height}, {-width / 2, height}};
}

/// The bench as the user calibrates it: a plate with a grid of holes held in the sheet.
SheetProjection calibrate_bench(const Rig& rig, Random& random) {
  const RigidTransform camera_from_scan = rig.axis.scan_from_camera.inverse();
  std::vector<SheetPoint> points;
  for (int i = -4; i <= 4; ++i) {
    for (int k = 0; k <= 6; ++k) {
      const Eigen::Vector2d in_sheet(0.012 * i, kGround + 0.008 * k);
      const Eigen::Vector2d pixel =
          rig.camera.project(camera_from_scan * Eigen::Vector3d(in_sheet.x(), 0, in_sheet.y()));
      if (pixel.y() < 0 || pixel.y() > rig.camera.height - 1) continue;
      points.push_back(
          {in_sheet, pixel + kNoise * Eigen::Vector2d(random.normal(), random.normal())});
    }
  }
  return fit_sheet_projection(points).projection;
}

Profile scan(const Rig& rig, const SheetProjection& sheet, const Outline& outline, Random& random) {
  const std::vector<double> seen =
      noisy(exact_positions(rig, 0, prism_on_plane(rig, outline)), kNoise, random);
  Profile profile;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto x = std::isnan(seen[i])
                       ? std::nullopt
                       : sheet.in_sheet(pixel_of(rig, seen[i], static_cast<int>(i)));
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    profile.push_back(x.value_or(Eigen::Vector2d(kNone, kNone)));
  }
  return profile;
}

/// Columns whose points lie between two places across the work.
ProfileSpan span_between(const Profile& profile, double from, double to) {
  ProfileSpan span{profile.size(), 0};
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (profile[i].x() < from || profile[i].x() > to || std::isnan(profile[i].x())) continue;
    span.first = std::min(span.first, i);
    span.last = std::max(span.last, i + 1);
  }
  return span;
}

struct Line {
  double offset = 0;
  double slope = 0;
};

Line fit_line(const Profile& profile, double from, double to) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Eigen::Vector2d& p : profile) {
    if (!(p.x() >= from && p.x() <= to)) continue;
    n += 1, x += p.x(), y += p.y(), xx += p.x() * p.x(), xy += p.x() * p.y();
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return {(y - slope * x) / n, slope};
}

/// Height of a polygon over the ground beside it: its flat top, or where its two upper sides meet.
double polygon_height(const Profile& profile, int sides, double side) {
  const Line ground = fit_line(profile, 0.035, 0.07);
  if (sides % 2 == 0) return fit_line(profile, -0.4 * side, 0.4 * side).offset - ground.offset;
  const double reach = side * std::cos(std::numbers::pi / sides);
  const Line left = fit_line(profile, -0.8 * reach, -0.1 * reach);
  const Line right = fit_line(profile, 0.1 * reach, 0.8 * reach);
  const double x = (right.offset - left.offset) / (left.slope - right.slope);
  return left.offset + left.slope * x - ground.offset - ground.slope * x;
}

StudyTable stack_table(const Rig& rig,
                       const SheetProjection& sheet,
                       const StudyOptions& options,
                       Random& random,
                       std::vector<double>& errors) {
  StudyTable table{.caption = "Stack of disks, 3.3 mm each [mm].",
                   .columns = {"disks", "actual", "paper: error", "error here"}};
  for (const auto& row : read_table(options.data / "tables/floppy_stack.csv")) {
    const double actual = row.at("actual_mm") / 1000;
    const Profile profile = scan(rig, sheet, box(0.06, actual), random);
    const StepMeasure step = measure_step(
        profile, span_between(profile, 0.05, 0.075), span_between(profile, -0.025, 0.025));
    errors.push_back(step.thickness - actual);
    table.rows.push_back({decimals(row.at("count"), 0),
                          decimals(row.at("actual_mm"), 2),
                          decimals(row.at("error_mm"), 2),
                          decimals(1000 * errors.back(), 3)});
  }
  return table;
}

StudyTable polygon_table(const Rig& rig,
                         const SheetProjection& sheet,
                         Random& random,
                         std::vector<double>& errors) {
  struct Polygon {
    const char* name;
    int sides;
    double side;
    const char* paper;
  };
  const Polygon polygons[] = {{"pentagon", 5, 0.02521, "0.00"},
                              {"hexagon", 6, 0.02252, "-0.08"},
                              {"octagon", 8, polygon_side(8, 0.04072), "0.21, sign not printed"}};
  StudyTable table{.caption = "Sides of regular polygons from their height [mm].",
                   .columns = {"polygon", "side", "paper: error", "error here"}};
  for (const Polygon& p : polygons) {
    const Profile profile = scan(rig, sheet, regular_polygon(p.sides, p.side), random);
    const double height = polygon_height(profile, p.sides, p.side);
    errors.push_back(polygon_side(p.sides, height) - p.side);
    table.rows.push_back(
        {p.name, decimals(1000 * p.side, 2), p.paper, decimals(1000 * errors.back(), 3)});
  }
  return table;
}

/// Diameter against the position of the rod's top, as the paper's cubic has it.
StudyTable rod_table(const Rig& rig, Random& random, std::vector<double>& errors) {
  const auto position = [&](double diameter) {
    Outline rod;
    for (int i = 0; i < 180; ++i) {
      const double angle = i * std::numbers::pi / 90;
      rod.emplace_back(diameter / 2 * std::cos(angle), diameter / 2 * (1 + std::sin(angle)));
    }
    const auto y = exact_position(rig, 0, prism_on_plane(rig, rod), rig.camera.width / 2);
    return y.value_or(std::numeric_limits<double>::quiet_NaN()) + kNoise * random.normal();
  };
  std::vector<ProfilePoint> points;
  for (double diameter = 0.004; diameter < 0.037; diameter += 0.004) {
    points.push_back({position(diameter), diameter});
  }
  const ProfilePolynomialFit fit = fit_profile_polynomial(points);
  StudyTable table{.caption = "Diameters of rods by a polynomial of degree " +
                              std::to_string(fit.polynomial.degree()) +
                              ", chosen by leave-one-out from nine rods (left-out error " +
                              decimals(1000 * fit.held_out_rms, 3) + " mm), tested on others [mm].",
                   .columns = {"diameter", "error here"}};
  for (const double diameter : {0.006, 0.010, 0.014, 0.018, 0.022, 0.026, 0.030, 0.034}) {
    errors.push_back(fit.polynomial.value(position(diameter)) - diameter);
    table.rows.push_back({decimals(1000 * diameter, 1), decimals(1000 * errors.back(), 3)});
  }
  return table;
}

}  // namespace

Study study_source_d(const StudyOptions& options) {
  const Rig rig = read_rig(options.data / "rigs/profile_bench.toml");
  Random random(options.seed, 1536);
  const SheetProjection sheet = calibrate_bench(rig, random);
  std::vector<double> stack;
  std::vector<double> polygons;
  std::vector<double> rods;
  Study study;
  study.title = "Source D: profiles of rolled products";
  study.tables = {stack_table(rig, sheet, options, random, stack),
                  polygon_table(rig, sheet, random, polygons),
                  rod_table(rig, random, rods)};
  study.paragraphs = {
      "The bench of data/rigs/profile_bench.toml, 0.1 px of noise in every column, calibrated by a "
      "projection matrix from a plate with a grid of holes (0.1 px of noise as well). Thickness: "
      "mean "
      "of the top over a line through the base. Polygons: height of the flat top, or where two "
      "sides "
      "meet. Rods: one column through the top, so that a single position decides."};
  const auto rms = [](const std::vector<double>& e) { return 1000 * statistics_of(e).rms; };
  study.verdicts = {
      {"stack: at most 0.1 mm RMS (the paper's own: 0.32 mm)",
       decimals(rms(stack), 3) + " mm",
       stack.size() == 12 && rms(stack) <= 0.1},
      {"polygons: at most 0.1 mm RMS", decimals(rms(polygons), 3) + " mm", rms(polygons) <= 0.1},
      {"rods by polynomial: at most 0.1 mm RMS", decimals(rms(rods), 3) + " mm", rms(rods) <= 0.1}};
  return study;
}

}  // namespace facula
