// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/register/pan_tilt_list.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

namespace facula {
namespace {

constexpr double kSamePan = 1e-6;  // [rad]
constexpr int kMostRows = 20000;   // of a grid [1]

const std::vector<std::string> kRangeColumns = {"range_mm", "range_m"};
const std::vector<std::string> kPanColumns = {"pan_deg", "pan_rad"};
const std::vector<std::string> kTiltColumns = {"tilt_deg", "tilt_rad"};

/// First points of the runs of equal pan, and one past the last point.
std::vector<std::size_t> run_starts(const PanTiltList& list) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i == 0 || std::abs(list.pan[i] - list.pan[i - 1]) > kSamePan) starts.push_back(i);
  }
  starts.push_back(list.size());
  return starts;
}

/// The usual step of tilt within a run [rad]; 0 where there is none.
double tilt_step(const PanTiltList& list, const std::vector<std::size_t>& starts) {
  std::vector<double> steps;
  for (std::size_t run = 0; run + 1 < starts.size(); ++run) {
    for (std::size_t i = starts[run] + 1; i < starts[run + 1]; ++i) {
      const double step = std::abs(list.tilt[i] - list.tilt[i - 1]);
      if (step > kSamePan) steps.push_back(step);
    }
  }
  return median(steps);
}

ScanGrid grid_of(const PanTiltList& list) {
  const std::vector<std::size_t> starts = run_starts(list);
  const double step = tilt_step(list, starts);
  if (step <= 0) return {};
  const auto [low, high] = std::minmax_element(list.tilt.begin(), list.tilt.end());
  const double rows = std::round((*high - *low) / step) + 1;
  if (!(rows < kMostRows)) return {};
  ScanGrid grid;
  grid.rows = static_cast<int>(rows);
  grid.cols = static_cast<int>(starts.size() - 1);
  grid.point.assign(static_cast<std::size_t>(grid.rows) * (starts.size() - 1), ScanGrid::kNone);
  for (int col = 0; col < grid.cols; ++col) {
    const auto run = static_cast<std::size_t>(col);
    for (std::size_t i = starts[run]; i < starts[run + 1]; ++i) {
      const int row = static_cast<int>(std::round((list.tilt[i] - *low) / step));
      std::int32_t& cell = grid.point[grid.index(row, col)];
      if (cell == ScanGrid::kNone) cell = static_cast<std::int32_t>(i);
    }
  }
  return grid;
}

std::vector<double> intensity_of(const CsvTable& table) {
  if (!table.has("strength")) return {};
  std::vector<double> values = table.column({"strength"});
  const double most = *std::max_element(values.begin(), values.end());
  for (double& value : values) value = most > 0 ? std::clamp(value / most, 0.0, 1.0) : 0;
  return values;
}

void append_points(PanTiltList& to, const PanTiltList& from, std::size_t first, std::size_t end) {
  const auto copy = [first, end](std::vector<double>& target, const std::vector<double>& source) {
    if (source.empty()) return;
    target.insert(target.end(),
                  source.begin() + static_cast<std::ptrdiff_t>(first),
                  source.begin() + static_cast<std::ptrdiff_t>(end));
  };
  copy(to.range, from.range);
  copy(to.pan, from.pan);
  copy(to.tilt, from.tilt);
  copy(to.intensity, from.intensity);
}

}  // namespace

bool is_pan_tilt_list(const std::filesystem::path& path) {
  if (lower_extension(path) != ".csv") return false;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line) && (line.empty() || line.front() == '#')) continue;
  return line.find("range_") != std::string::npos && line.find("pan_") != std::string::npos &&
         line.find("tilt_") != std::string::npos;
}

PanTiltList read_pan_tilt_list(const std::filesystem::path& path) {
  const CsvTable table = CsvTable::from_file(path);
  const std::vector<double> range = table.column(kRangeColumns);
  const std::vector<double> pan = table.column(kPanColumns);
  const std::vector<double> tilt = table.column(kTiltColumns);
  const std::vector<double> intensity = intensity_of(table);
  PanTiltList list;
  for (std::size_t i = 0; i < range.size(); ++i) {
    require(range[i] >= 0,
            path.string(),
            ": expected ranges of 0 (nothing seen) or more, got ",
            range[i],
            " m in row ",
            i + 1);
    if (range[i] == 0) continue;
    list.range.push_back(range[i]);
    list.pan.push_back(pan[i]);
    list.tilt.push_back(tilt[i]);
    if (!intensity.empty()) list.intensity.push_back(intensity[i]);
  }
  require(list.size() > 0,
          path.string(),
          ": expected ranges, got 0 in all ",
          range.size(),
          " rows; did the scanner see anything?");
  return list;
}

PosedCloud posed_cloud(const PanTiltList& list, double tilt_zero) {
  PosedCloud scan;
  PointCloud& cloud = scan.cloud;
  cloud.points.reserve(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const double tilt = list.tilt[i] + tilt_zero;
    const Eigen::Vector3d ray(std::sin(tilt) * std::cos(list.pan[i]),
                              std::sin(tilt) * std::sin(list.pan[i]),
                              std::cos(tilt));
    cloud.points.emplace_back((list.range[i] * ray).cast<float>());
  }
  cloud.intensity.assign(list.intensity.begin(), list.intensity.end());
  cloud.sensor_origin.assign(cloud.size(), Eigen::Vector3f::Zero());
  scan.grid = grid_of(list);
  return scan;
}

PanTiltSweeps sweeps_of(const PanTiltList& list) {
  PanTiltSweeps sweeps;
  const std::vector<std::size_t> starts = run_starts(list);
  for (std::size_t run = 0; run + 1 < starts.size(); ++run) {
    const std::size_t first = starts[run];
    const std::size_t end = starts[run + 1];
    // Most steps decide: a list may carry the last point of the sweep before at its head.
    std::ptrdiff_t rises = 0;
    for (std::size_t i = first + 1; i < end; ++i) rises += list.tilt[i] > list.tilt[i - 1] ? 1 : -1;
    append_points(rises >= 0 ? sweeps.rising : sweeps.falling, list, first, end);
  }
  return sweeps;
}

}  // namespace facula
