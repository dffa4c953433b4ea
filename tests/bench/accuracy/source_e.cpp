// SPDX-License-Identifier: GPL-3.0-or-later
//
// Source E: two parallel lines 100 mm apart, in air and behind a flat port in water.
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/two_line/two_line_fit.hpp>
#include <facula/tests/bench/accuracy/error_statistics.hpp>
#include <facula/tests/bench/accuracy/studies.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr double kNoise = 0.1;         // of each line in each column [px]
constexpr double kHalfSpacing = 0.05;  // [m]
constexpr int kSegmentWidth = 50;      // columns that are averaged, source E [px]

/// Where a line at `height` beside the axis is seen on a wall, on the plane z = 1 of the camera in
/// air: Snell's law at a port square to the axis.
double seen_at(double height, double depth, double index) {
  const double in_medium = height / std::hypot(height, depth);  // sine of the angle
  const double in_air = index * in_medium;
  return in_air / std::sqrt(1 - in_air * in_air);
}

/// Separation of the lines as the camera that is calibrated in the medium sees it: its focal length
/// counts `index` times, so that positions divide by it.
double measured_separation(
    const Rig& air, double depth, double index, int columns, Random& random) {
  const double exact = 2 * air.camera.fy * seen_at(kHalfSpacing, depth, index);  // [px]
  const double noise = kNoise * std::sqrt(2.0 / columns);
  return (exact + noise * random.normal()) / (index * air.camera.fy);
}

TwoLineHead calibrate(const Rig& air, double index, Random& random) {
  std::vector<TwoLinePoint> points;
  for (const double depth : {0.5, 0.8, 1.2, 1.8, 2.5, 3.3, 4.2}) {
    points.push_back({measured_separation(air, depth, index, 7 * kSegmentWidth, random), depth});
  }
  return fit_two_line(points).head;
}

double worst_error(const Rig& air,
                   const TwoLineHead& head,
                   double depth,
                   double index,
                   int columns,
                   Random& random) {
  std::vector<double> errors;
  for (int i = 0; i < 1000; ++i) {
    const auto z = head.depth(measured_separation(air, depth, index, columns, random));
    errors.push_back(100 * (z.value_or(1e9) - depth) / depth);
  }
  return statistics_of(errors).percentile_99;
}

}  // namespace

Study study_source_e(const StudyOptions& options) {
  const Rig air = read_rig(options.data / "rigs/two_line_air.toml");
  Random random(options.seed, 2);
  Study study;
  study.title = "Source E: two-line rangefinder, in air and in water";
  StudyTable table{.caption = "Error in % of the distance, 99th percentile of 1000 trials.",
                   .columns = {"distance [m]",
                               "paper",
                               "air: one column",
                               "air: segment of 50",
                               "water: one column",
                               "water: segment of 50"}};
  const TwoLineHead in_air = calibrate(air, 1, random);
  const TwoLineHead in_water = calibrate(air, 1.333, random);
  double worst = 0;
  for (const double depth : {0.61, 1.529, 2.14, 3.058, 3.975, 4.0}) {
    const double a1 = worst_error(air, in_air, depth, 1, 1, random);
    const double a50 = worst_error(air, in_air, depth, 1, kSegmentWidth, random);
    const double w1 = worst_error(air, in_water, depth, 1.333, 1, random);
    const double w50 = worst_error(air, in_water, depth, 1.333, kSegmentWidth, random);
    worst = std::max({worst, a50, w50});
    table.rows.push_back({decimals(depth, 3),
                          "10",
                          decimals(a1, 2),
                          decimals(a50, 3),
                          decimals(w1, 2),
                          decimals(w50, 3)});
  }
  study.tables = {table};
  study.paragraphs = {
      "Lines 100 mm apart, 0.1 px of noise in every column of each line, calibrated at seven "
      "distances in the medium it is used in (the rays bend at a flat port by Snell's law; the "
      "head "
      "is fitted, the law is not told). The source cuts its image into segments of 50 columns; one "
      "column alone is shown beside it."};
  study.verdicts = {{"at most 1 % up to 4 m, in air and in water, per segment (the paper: 10 %)",
                     decimals(worst, 2) + " %",
                     worst <= 1}};
  return study;
}

}  // namespace facula
