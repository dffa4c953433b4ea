// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/axis_positions.hpp>
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>

#include <charconv>
#include <cmath>
#include <fstream>
#include <locale>
#include <numbers>
#include <string>
#include <string_view>

namespace facula {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> result;
  while (true) {
    const std::size_t comma = line.find(',');
    result.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return result;
    line.remove_prefix(comma + 1);
  }
}

struct Column {
  std::size_t index = 0;
  double unit = 1;  ///< of the file, in rad or m
};

Column find_column(std::string_view header, const std::filesystem::path& path, AxisKind axis) {
  const bool linear = axis == AxisKind::kLinear;
  const std::vector<std::string_view> names = cells(header);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!linear && names[i] == "position_deg") return {i, kDegree};
    if (!linear && names[i] == "position_rad") return {i, 1};
    if (linear && names[i] == "position_mm") return {i, 1e-3};
  }
  fail(path.string(),
       ": expected a header line with a column ",
       linear ? "position_mm" : "position_deg or position_rad",
       " for a ",
       to_string(axis),
       " axis, got '",
       header,
       "'");
}

}  // namespace

std::vector<double> read_axis_positions(const std::filesystem::path& path, AxisKind axis) {
  std::ifstream file(path);
  require(file.is_open(), "there is no readable file '", path.string(), "' of axis positions");
  std::string line;
  require(static_cast<bool>(std::getline(file, line)), path.string(), ": the file is empty");
  const Column column = find_column(trimmed(line), path, axis);
  std::vector<double> positions;
  for (int number = 2; std::getline(file, line); ++number) {
    if (trimmed(line).empty()) continue;
    const std::vector<std::string_view> values = cells(line);
    double value = 0;
    bool good = column.index < values.size() && !values[column.index].empty();
    if (good) {
      const std::string_view text = values[column.index];
      const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
      good = problem == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
    }
    require(good, path.string(), ", line ", number, ": expected a number, got '", line, "'");
    positions.push_back(value * column.unit);
  }
  require(!positions.empty(), path.string(), ": the file holds no positions");
  return positions;
}

void write_axis_positions(const std::filesystem::path& path,
                          const std::vector<double>& positions,
                          AxisKind axis) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  out.imbue(std::locale::classic());
  out.precision(17);
  const bool linear = axis == AxisKind::kLinear;
  out << (linear ? "position_mm\n" : "position_rad\n");
  for (const double position : positions) out << position * (linear ? 1000 : 1) << "\n";
  file.commit();
}

}  // namespace facula
