// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/point_text.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <cctype>
#include <string>

namespace facula {
namespace {

constexpr std::string_view kSeparators = " \t,;\r\v\f";

bool is_remark(std::string_view line) {
  const std::string_view first = take_word(line, kSeparators);
  return first.empty() || first.starts_with('#') || first.starts_with("//");
}

bool starts_with_number(std::string_view line) {
  return parse_number<double>(take_word(line, kSeparators)).has_value();
}

struct Place {
  const std::string& file;
  std::size_t line;
};

/// Whether a column of this name may hold x: "x", "x_m", "X [mm]", "Points:0", "Easting".
bool may_be_x(std::string_view name) {
  std::string word;
  for (const char letter : name) {
    const auto c = static_cast<unsigned char>(letter);
    if (std::isalpha(c) == 0) {
      if (!word.empty()) break;
    } else {
      word += static_cast<char>(std::tolower(c));
    }
  }
  return word == "x" || word == "points" || word == "east" || word == "easting";
}

/// Columns of other figures, read as points, would be wrong without anyone being told.
void check_names(std::string_view line, std::size_t leading, const Place& place) {
  std::string_view name;
  for (std::size_t column = 0; column <= leading; ++column) name = take_word(line, kSeparators);
  require(may_be_x(name),
          "line ",
          place.line,
          " of '",
          place.file,
          "' calls its column ",
          leading + 1,
          " '",
          name.substr(0, 40),
          "'; expected the columns ",
          leading == 2 ? "col row x y z" : "x y z",
          ", or no line of names");
}

Eigen::Vector3f point_of(std::string_view line, std::size_t leading, const Place& place) {
  Eigen::Vector3f point;
  for (std::size_t k = 0; k < leading + 3; ++k) {
    const std::string_view word = take_word(line, kSeparators);
    const auto value = parse_number<double>(word);
    require(value.has_value(),
            "line ",
            place.line,
            " of '",
            place.file,
            "' has '",
            word.substr(0, 40),
            "' as its value ",
            k + 1,
            "; expected the numbers ",
            leading == 2 ? "col row x y z" : "x y z");
    if (k >= leading) point[static_cast<int>(k - leading)] = static_cast<float>(*value);
  }
  return point;
}

}  // namespace

PointCloud read_point_text(const std::filesystem::path& path, std::size_t leading) {
  const std::string file = path.string();
  const std::string bytes = read_whole_file(path);
  std::string_view rest = bytes;
  PointCloud cloud;
  bool may_be_names = true;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::string_view line = take_line(rest);
    if (is_remark(line)) continue;
    const bool is_names = may_be_names && !starts_with_number(line);
    may_be_names = false;
    if (is_names) {
      check_names(line, leading, {file, number});
      continue;
    }
    const Eigen::Vector3f point = point_of(line, leading, {file, number});
    if (point.allFinite()) cloud.points.push_back(point);
  }
  return cloud;
}

void write_point_text(const std::filesystem::path& path, const PointCloud& cloud) {
  AtomicFile file(path);
  for (const Eigen::Vector3f& p : cloud.points) {
    file.stream() << number_text(p.x()) << ' ' << number_text(p.y()) << ' ' << number_text(p.z())
                  << '\n';
  }
  file.commit();
}

}  // namespace facula
