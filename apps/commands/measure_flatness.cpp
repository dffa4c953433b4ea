// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/flatness_figures.hpp>
#include <facula/apps/commands/measure_flatness.hpp>
#include <facula/apps/commands/plane_search.hpp>
#include <facula/apps/commands/posed_scans.hpp>

#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

namespace facula {
namespace {

struct FlatnessArguments {
  PlaneSearch search;
  bool whole = false;
  FlatnessUncertaintyOptions noise;
};

/// Points and which of them lie on which surface.
struct Surfaces {
  PointCloud cloud;
  std::vector<std::vector<std::size_t>> indices;
  SearchBand band = {};
};

void declare(Arguments& arguments, FlatnessArguments& a) {
  declare_plane_search(arguments, a.search);
  arguments.flag("--whole", a.whole, "all points are of one surface; look for no planes");
  arguments.number(
      "--sigma-mm", a.noise.sigma, kMillimetres, "noise of points that do not know their own");
  arguments.whole("--trials", a.noise.trials, "draws of noise for the uncertainty");
}

Surfaces whole_surface(const FlatnessArguments& a, Session& session) {
  const PosedScans scans = read_posed_scans(a.search.scans);
  require_surface(scans.points_read, scans.stripes, a.search.scans.front());
  session.figures.count("points", "points", scans.points_read);
  Surfaces surfaces{scans.project.fused(), {}};
  surfaces.indices.emplace_back(surfaces.cloud.size());
  std::iota(surfaces.indices[0].begin(), surfaces.indices[0].end(), std::size_t{0});
  return surfaces;
}

Surfaces found_surfaces(const FlatnessArguments& a, Session& session) {
  FoundPlanes found = find_planes(a.search, session);
  Surfaces surfaces{std::move(found.cloud), {}, {found.inlier_distance, found.widened}};
  for (ExtractedPlane& plane : found.planes) surfaces.indices.push_back(std::move(plane.indices));
  return surfaces;
}

/// "1, 3, 4": the planes that the test picks, as people count them.
template <typename Test>
std::string planes_that(const std::vector<MeasuredFlatness>& all, const Test& test) {
  std::string names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (test(all[i])) names += (names.empty() ? "" : ", ") + std::to_string(i + 1);
  }
  return names;
}

/// What noise lets one say of the planes that were not cut.
void add_verdicts(const std::vector<MeasuredFlatness>& all,
                  const SearchBand& band,
                  Figures& figures) {
  if (all.size() == 1 || !all.front().uncertainty) {
    if (!is_cut(all.front(), band)) figures.note(flatness_verdict(all.front()));
    return;
  }
  const auto whole_and = [&](bool flat) {
    return planes_that(all, [&](const MeasuredFlatness& one) {
      return !is_cut(one, band) && one.uncertainty &&
             (one.flatness.total <= one.uncertainty->floor_p95) == flat;
    });
  };
  if (const std::string flat = whole_and(true); !flat.empty()) {
    figures.note("No deviation from flat is proven of plane " + flat +
                 ": noise alone would show as much (last column).");
  }
  if (const std::string bent = whole_and(false); !bent.empty()) {
    figures.note("FLTt of plane " + bent +
                 " exceeds what noise alone would show (last column): the rest is the surface's.");
  }
}

/// Flatness of a slice says nothing of the surface it was cut from.
void add_notes(const std::vector<MeasuredFlatness>& all, const SearchBand& band, Figures& figures) {
  const std::string cut =
      planes_that(all, [&](const MeasuredFlatness& one) { return is_cut(one, band); });
  if (!cut.empty()) {
    figures.text("cut_planes", "planes cut by the search", cut);
    figures.note(
        "The points of plane " + cut +
        " fill the band of the search: the surface or its noise reaches farther than that, and its "
        "flatness is larger. Raise --inlier-mm, or give --whole.");
  }
  add_verdicts(all, band, figures);
}

std::vector<MeasuredFlatness> measured(const FlatnessArguments& a,
                                       const Surfaces& surfaces,
                                       int num_threads) {
  FlatnessUncertaintyOptions noise = a.noise;
  noise.seed = static_cast<unsigned>(a.search.seed % std::numeric_limits<unsigned>::max());
  noise.num_threads = num_threads;
  const bool has_noise = noise.sigma > 0 || knows_sigma(surfaces.cloud);
  std::vector<MeasuredFlatness> result;
  for (const auto& indices : surfaces.indices) {
    MeasuredFlatness& surface = result.emplace_back();
    surface.flatness =
        measure_flatness(surfaces.cloud, indices, FlatnessOptions{.num_threads = num_threads});
    if (!has_noise) continue;
    surface.uncertainty = flatness_uncertainty(surfaces.cloud, indices, surface.flatness, noise);
  }
  return result;
}

void run(const FlatnessArguments& a, Session& session) {
  if (!a.search.csv.empty()) check_output(a.search.csv, {".csv"});
  a.noise.check();
  const Surfaces surfaces = a.whole ? whole_surface(a, session) : found_surfaces(a, session);
  const std::vector<MeasuredFlatness> all = measured(a, surfaces, session.num_threads);
  FigureTable table = flatness_table(all);
  if (!a.search.csv.empty()) write_table_csv(a.search.csv, table);
  session.figures.table(std::move(table));
  add_notes(all, surfaces.band, session.figures);
}

}  // namespace

Command measure_flatness_command() {
  const auto a = std::make_shared<FlatnessArguments>();
  return {
      .name = "measure flatness",
      .summary = "flatness after ISO 12781, with the minimum zone",
      .description =
          "Finds the planes in a cloud and measures their flatness: FLTt, FLTp, FLTv and FLTq from "
          "the least-squares plane, and the minimum zone, exact. Noise makes FLTt of a scan too "
          "large, the more the more points there are; where the noise is known, the table says "
          "how large FLTt of a perfectly flat surface would be.",
      .examples = {"facula simulate data/scenes/flat_wall.toml --rig data/rigs/head_fs1500.toml "
                   "--from-deg -20 --to-deg 20 --step-deg 2 --out wall",
                   "facula extract wall --out wall.pcd",
                   "facula measure flatness wall.pcd --inlier-mm 20 --csv flatness.csv"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
