// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/map/navigation_grid.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <locale>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

namespace facula {
namespace {

using Entries = std::map<std::string, std::string, std::less<>>;

/// Shortest text that reads back as the same number.
std::string exact(double value) {
  char text[64];
  const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
  return {text, end};
}

/// A YAML scalar: bare where no character could mean something, else in double quotes.
std::string scalar(const std::string& text) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '/';
  };
  if (std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

void write_pgm(std::ostream& out, const NavigationGrid& grid) {
  out.imbue(std::locale::classic());
  out << "P5\n" << grid.cols << ' ' << grid.rows << "\n255\n";
  out.write(reinterpret_cast<const char*>(grid.cells.data()),
            static_cast<std::streamsize>(grid.cells.size()));
}

/// The keys of ROS map_server and nav2_map_server. 205 counts as unknown only with the
/// thresholds given: 0.196 < (255 - 205) / 255 < 0.65.
void write_yaml(std::ostream& out, const NavigationGrid& grid, const std::string& image) {
  out << "image: " << scalar(image) << "\nmode: trinary\nresolution: " << exact(grid.resolution)
      << "\norigin: [" << exact(grid.origin.x()) << ", " << exact(grid.origin.y())
      << ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  require(stream.is_open() && std::filesystem::is_regular_file(path),
          "cannot read '",
          path.string(),
          "': there is no such file");
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

std::string unquoted(const std::string& text) {
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return text;
  std::string plain;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == '\\' && i + 2 < text.size()) ++i;
    plain += text[i];
  }
  return plain;
}

/// The flat "key: value" lines a map file consists of.
Entries read_entries(const std::string& text) {
  Entries entries;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find(" #"));
    const auto colon = line.find(':');
    if (colon == std::string::npos || trimmed(line).starts_with('#')) continue;
    entries[trimmed(std::string_view(line).substr(0, colon))] =
        trimmed(std::string_view(line).substr(colon + 1));
  }
  return entries;
}

const std::string& entry(const Entries& entries, std::string_view key, const std::string& name) {
  const auto found = entries.find(key);
  require(found != entries.end(), "'", name, "': expected a line '", key, ": ...'");
  return found->second;
}

/// Numbers of "[1, 2, 3]" or "1".
std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at != end) {
    if (*at == '[' || *at == ',' || *at == ' ' || *at == ']') {
      ++at;
      continue;
    }
    double value = 0;
    const auto [next, failure] = std::from_chars(at, end, value);
    if (failure != std::errc() || !std::isfinite(value)) return {};
    values.push_back(value);
    at = next;
  }
  return values;
}

double number(const Entries& entries, std::string_view key, const std::string& name) {
  const auto values = numbers(entry(entries, key, name));
  require(values.size() == 1, "'", name, "': expected one number after '", key, ":'");
  return values[0];
}

/// The next number of a PGM header; comments run from # to the end of the line.
int header_number(std::istream& in, const std::string& name) {
  while (in >> std::ws && in.peek() == '#') in.ignore(1 << 20, '\n');
  int value = 0;
  require(static_cast<bool>(in >> value) && value > 0,
          "'",
          name,
          "' is not a binary PGM image: expected 'P5', width, height and 255 at its start");
  return value;
}

void read_pgm(const std::filesystem::path& path, NavigationGrid& grid) {
  const std::string text = read_text(path);
  const std::string name = path.string();
  require(text.starts_with("P5"), "'", name, "' is not a binary PGM image ('P5')");
  std::istringstream in(text.substr(2));
  in.imbue(std::locale::classic());
  grid.cols = header_number(in, name);
  grid.rows = header_number(in, name);
  const int white = header_number(in, name);
  require(white == 255, "'", name, "': expected 255 grey levels, found ", white);
  const std::size_t begin = 2 + static_cast<std::size_t>(in.tellg()) + 1;
  const auto count = static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.cols);
  require(begin <= text.size() && text.size() - begin == count,
          "'",
          name,
          "' is torn: expected ",
          count,
          " pixels (",
          grid.cols,
          " x ",
          grid.rows,
          "), found ",
          begin <= text.size() ? text.size() - begin : 0);
  grid.cells.resize(count);
  std::copy(text.begin() + static_cast<std::ptrdiff_t>(begin), text.end(), grid.cells.begin());
}

/// Grey values to the three states, as the ROS map servers decide in mode "trinary".
void interpret(NavigationGrid& grid, const Entries& entries, const std::string& name) {
  const bool negate = number(entries, "negate", name) != 0;
  const double occupied = number(entries, "occupied_thresh", name);
  const double free = number(entries, "free_thresh", name);
  for (std::uint8_t& cell : grid.cells) {
    const double probability = (negate ? cell : 255 - cell) / 255.0;
    cell = probability > occupied ? NavigationGrid::kOccupied
           : probability < free   ? NavigationGrid::kFree
                                  : NavigationGrid::kUnknown;
  }
}

}  // namespace

void write_navigation_grid(const std::filesystem::path& yaml_path, const NavigationGrid& grid) {
  const std::string extension = yaml_path.extension().string();
  require(extension == ".yaml" || extension == ".yml",
          "cannot write the grid '",
          yaml_path.string(),
          "': expected a name ending in .yaml");
  require(grid.rows > 0 && grid.cols > 0 &&
              grid.cells.size() ==
                  static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.cols),
          "NavigationGrid: expected ",
          grid.rows,
          " x ",
          grid.cols,
          " cells, got ",
          grid.cells.size());
  const auto pgm_path = std::filesystem::path(yaml_path).replace_extension(".pgm");
  AtomicFile pgm(pgm_path);
  AtomicFile yaml(yaml_path);
  write_pgm(pgm.stream(), grid);
  write_yaml(yaml.stream(), grid, pgm_path.filename().string());
  pgm.commit();
  yaml.commit();  // last: a YAML file always finds its image
}

NavigationGrid read_navigation_grid(const std::filesystem::path& yaml_path) {
  const std::string name = yaml_path.string();
  const Entries entries = read_entries(read_text(yaml_path));
  NavigationGrid grid;
  grid.resolution = number(entries, "resolution", name);
  require(grid.resolution > 0, "'", name, "': expected a resolution above 0 m");
  const auto origin = numbers(entry(entries, "origin", name));
  require(origin.size() == 3, "'", name, "': expected 'origin: [x, y, yaw]'");
  require(origin[2] == 0, "'", name, "': turned maps (yaw ", origin[2], ") are not read");
  grid.origin = {origin[0], origin[1]};
  read_pgm(yaml_path.parent_path() / unquoted(entry(entries, "image", name)), grid);
  interpret(grid, entries, name);
  return grid;
}

}  // namespace facula
