// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/grid_image.hpp>

#include <algorithm>
#include <locale>
#include <sstream>

namespace facula {
namespace {

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

GridImage decode_pgm(const std::string& bytes, const std::string& name) {
  require(bytes.starts_with("P5"), "'", name, "' is not a binary PGM image ('P5')");
  std::istringstream in(bytes.substr(2));
  in.imbue(std::locale::classic());
  GridImage image;
  image.cols = header_number(in, name);
  image.rows = header_number(in, name);
  const int white = header_number(in, name);
  require(white == 255, "'", name, "': expected 255 grey levels, found ", white);
  const std::size_t begin = 2 + static_cast<std::size_t>(in.tellg()) + 1;
  require(begin <= bytes.size() && bytes.size() - begin == image.size(),
          "'",
          name,
          "' is torn: expected ",
          image.size(),
          " pixels (",
          image.cols,
          " x ",
          image.rows,
          "), found ",
          begin <= bytes.size() ? bytes.size() - begin : 0);
  image.grey.assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.end());
  return image;
}

}  // namespace

void write_pgm(std::ostream& out, const GridImage& image) {
  out.imbue(std::locale::classic());
  out << "P5\n" << image.cols << ' ' << image.rows << "\n255\n";
  out.write(reinterpret_cast<const char*>(image.grey.data()),
            static_cast<std::streamsize>(image.grey.size()));
}

GridImage read_grid_image(const std::filesystem::path& path) {
  const std::string bytes = read_whole_file(path);
  return path.extension() == ".pgm" ? decode_pgm(bytes, path.string())
                                    : decode_grid_image(bytes, path.string());
}

}  // namespace facula
