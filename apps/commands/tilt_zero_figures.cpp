// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/tilt_zero_figures.hpp>
#include <facula/reconstruct/measure/tilt_zero.hpp>

#include <string>
#include <utility>

namespace facula {
namespace {

constexpr std::size_t kFewPoints = 300;  // of sweeps that are left aside [1]

FigureTable zero_table() {
  return {"tilt_zeros",
          "Zero of the tilt axis, to be added to every tilt, by the way it moved:",
          {{"scan", "scan", 0},
           {"sweeps", "sweeps", 0},
           {"points", "points", 0},
           {"pairs", "pairs", 0},
           {"tilt_zero_deg", "tilt zero", 2},
           {"tilt_zero_sigma_deg", "sigma", 2},
           {"off_square_before_deg", "off square before", 2},
           {"off_square_deg", "after", 2},
           {"on_planes_before_percent", "on planes before", 0},
           {"on_planes_percent", "after", 0}},
          {}};
}

}  // namespace

void report_tilt_zeros(const PlaneSearch& search, Session& session) {
  if (!search.csv.empty()) check_output(search.csv, {".csv"});
  TiltZeroOptions options;
  options.planes.inlier_distance = search.options.inlier_distance;
  options.planes.seed = static_cast<unsigned>(search.seed);
  options.planes.num_threads = session.num_threads;
  FigureTable table = zero_table();
  std::vector<double> zeros;
  std::size_t number = 0;
  bool falling = false;
  std::string doubtful;
  for (const auto& path : search.scans) {
    session.step("finding the tilt's zero", ++number, search.scans.size());
    require(is_pan_tilt_list(path),
            "expected a .csv of range_mm, pan_deg and tilt_deg, got '",
            path.string(),
            "'; only its tilts have a zero to find");
    const PanTiltSweeps sweeps = sweeps_of(read_pan_tilt_list(path));
    for (const bool rising : {true, false}) {
      const PanTiltList& list = rising ? sweeps.rising : sweeps.falling;
      if (list.size() < kFewPoints) continue;
      const TiltZero zero = find_tilt_zero(list, options);
      falling = falling || !rising;
      if (zero.on_planes <= zero.on_planes_before || zero.pairs < 2) {
        doubtful += (doubtful.empty() ? "" : ", ") + path.stem().string() +
                    (rising ? " rising" : " falling");
      }
      if (rising || sweeps.rising.size() < kFewPoints) zeros.push_back(zero.tilt_zero.value);
      table.rows.push_back({path.stem().string(),
                            std::string(rising ? "rising" : "falling"),
                            static_cast<long long>(list.size()),
                            static_cast<long long>(zero.pairs),
                            zero.tilt_zero.value / kDegrees.factor,
                            zero.tilt_zero.sigma / kDegrees.factor,
                            zero.off_square_before / kDegrees.factor,
                            zero.off_square / kDegrees.factor,
                            100 * zero.on_planes_before,
                            100 * zero.on_planes});
    }
  }
  session.end_steps();
  require(!zeros.empty(), "expected ", kFewPoints, " points or more in a list, got fewer in all");
  if (!search.csv.empty()) write_table_csv(search.csv, table);
  session.figures.number("tilt_zero_deg", "tilt zero, median", median(zeros) / kDegrees.factor, 2);
  session.figures.table(std::move(table));
  if (!doubtful.empty()) {
    session.figures.note("Do not trust " + doubtful +
                         ": fewer points lie on planes with that zero than without, or one pair of "
                         "planes alone decides it.");
  }
  session.figures.note(
      falling ? "Rising and falling sweeps differ by the play of the gears; measure with "
                "--tilt-zero-deg and --sweeps."
              : "Measure with --tilt-zero-deg.");
}

}  // namespace facula
