// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/measure_profile.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/apps/commands/profile_figures.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/profile_section.hpp>

#include <algorithm>
#include <limits>
#include <memory>

namespace facula {
namespace {

constexpr double kBeyondLimits = 0.1;  // share of a limit by which a fitted radius may miss it

struct ProfileArguments {
  std::vector<std::filesystem::path> scans;
  std::filesystem::path csv;
  std::string shape = "pieces";
  SectionOptions section;
  ProfilePieceOptions pieces;
  double gap = 0.002;  // [m]
  ShapeSearchOptions search;
  std::optional<double> max_radius;
  std::size_t seed = 1;
};

void declare(Arguments& arguments, ProfileArguments& a) {
  arguments.inputs("SCANS", a.scans, "a scan, several, or a project (poses.toml, .conf, folder)");
  arguments.required();
  arguments.choice("--shape",
                   a.shape,
                   {"pieces", "circle", "rod", "ball"},
                   "pieces or a circle in a section; a rod or a ball among all points");
  arguments.vector("--at-mm", a.section.point, kMillimetres, "a point of the section");
  arguments.vector("--normal", a.section.normal, kPlainNumber, "direction square to the section");
  arguments.vector("--up", a.section.up, kPlainNumber, "direction in which heights grow");
  arguments.number("--thickness-mm", a.section.thickness, kMillimetres, "of the slice");
  arguments.number("--tolerance-mm",
                   a.pieces.tolerance,
                   kMillimetres,
                   "farthest point from its piece, 0 = 5 times the noise");
  arguments.number(
      "--gap-mm", a.gap, kMillimetres, "farthest corner of a side from the points of the side");
  arguments.number(
      "--inlier-mm", a.search.inlier_distance, kMillimetres, "farthest point of a rod or ball");
  arguments.number("--min-radius-mm", a.search.min_radius, kMillimetres, "of a rod or ball");
  arguments.number("--max-radius-mm", a.max_radius, kMillimetres, "of a rod or ball");
  arguments.whole("--min-points", a.search.min_points, "fewest points of a rod or ball");
  arguments.whole("--seed", a.seed, "of the search for rods and balls");
  arguments.output("--csv", a.csv, "also write the pieces as a table (.csv)");
}

/// One spot has neither length nor direction.
bool is_one_spot(const std::vector<Eigen::Vector2d>& points) {
  return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector2d& x) {
    return (x - points.front()).norm() <= 1e-7 * x.norm();  // rounding of single precision
  });
}

void measure_pieces(const ProfileArguments& a, const ProfileSection& section, Figures& figures) {
  require(section.points.size() < 2 || !is_one_spot(section.points),
          "the ",
          section.points.size(),
          " points of the section lie in one spot, so they have no straight piece; move the "
          "section");
  const std::vector<ProfilePiece> pieces = straight_pieces(section.points, a.pieces);
  require(!pieces.empty(),
          "expected a straight piece of ",
          a.pieces.min_points,
          " points among the section's ",
          section.points.size(),
          ", got none; make the slice thicker or raise --tolerance-mm");
  FigureTable table = piece_table(section.points, pieces, a.gap);
  if (!a.csv.empty()) write_table_csv(a.csv, table);
  figures.count("piece_count", "straight pieces", pieces.size());
  figures.table(std::move(table));
}

void measure_section(const ProfileArguments& a, const PointCloud& cloud, Session& session) {
  const ProfileSection section = cut_section(cloud, a.section);
  session.figures.count("section_points", "points in the section", section.points.size());
  if (a.shape == "circle") {
    report_circle(fit_circle(section), session.figures);
  } else {
    measure_pieces(a, section, session.figures);
  }
}

/// The search keeps to the limits, but the fit goes where the points take it: far from them they
/// are of something else.
void require_radius(const std::string& shape, double radius, const ShapeSearchOptions& options) {
  require(radius >= (1 - kBeyondLimits) * options.min_radius &&
              radius <= (1 + kBeyondLimits) * options.max_radius,
          "expected a ",
          shape,
          " with a radius of ",
          1000 * options.min_radius,
          " to ",
          1000 * options.max_radius,
          " mm, but the points that look like one fit a radius of ",
          1000 * radius,
          " mm; change the limits, or lower --inlier-mm (it was ",
          1000 * options.inlier_distance,
          " mm)");
}

void measure_shape(const ProfileArguments& a, PointCloud cloud, Session& session) {
  ShapeSearchOptions options = a.search;
  if (a.max_radius) options.max_radius = *a.max_radius;
  options.seed = static_cast<unsigned>(a.seed % std::numeric_limits<unsigned>::max());
  options.check();
  if (a.shape == "ball") {
    const SphereFit ball = find_sphere(cloud, options).fit;
    require_radius(a.shape, ball.sphere.radius, options);
    report_sphere(ball, session.figures);
    return;
  }
  estimate_normals(cloud, {.num_threads = session.num_threads});
  const CylinderFit rod = find_cylinder(cloud, options).fit;
  require_radius(a.shape, rod.cylinder.radius, options);
  report_cylinder(rod, session.figures);
}

void run(const ProfileArguments& a, Session& session) {
  if (!a.csv.empty()) check_output(a.csv, {".csv"});
  require(a.csv.empty() || a.shape == "pieces",
          "expected --csv with --shape pieces, got it with ",
          a.shape,
          "; --json holds its figures");
  session.step("reading", 1, 2);
  const PosedScans scans = read_posed_scans(a.scans);
  session.figures.count("points", "points", scans.points_read);
  session.step("measuring", 2, 2);
  if (a.shape == "pieces" || a.shape == "circle") {
    measure_section(a, scans.project.fused(), session);
  } else {
    measure_shape(a, scans.project.fused(), session);
  }
}

}  // namespace

Command measure_profile_command() {
  const auto a = std::make_shared<ProfileArguments>();
  return {
      .name = "measure profile",
      .summary = "steps, sides of prisms, diameters of rods and balls",
      .description =
          "Cuts a slice out of a cloud and measures its straight pieces: steps over the lowest "
          "level one, sides between corners; or fits a circle to it. Or finds a rod or a ball "
          "among all points and fits it. Every size comes with its standard uncertainty, from the "
          "points' own noise or, where they know none, from their scatter.",
      .examples =
          {"facula simulate data/scenes/turntable_object.toml --rig "
           "data/rigs/ciclop_turntable.toml --step-deg 10 --out object",
           "facula extract object --out object.pcd",
           "facula measure profile object.pcd --shape ball --min-radius-mm 38 "
           "--max-radius-mm 46 --inlier-mm 1",
           "facula measure profile object.pcd --shape circle --at-mm 0 0 117 --normal 0 0 1 "
           "--up 0 1 0 --thickness-mm 4",
           "facula measure profile object.pcd --at-mm 0 0 0 --normal 0 1 0 "
           "--thickness-mm 4 --tolerance-mm 1 --csv pieces.csv"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
