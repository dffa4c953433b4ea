// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/pcd_table.hpp>
#include <facula/acquire/core/ply_table.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/scan_header.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <limits>

namespace facula {
namespace {

/// PCD files count row by row, scans column by column.
template <typename ValueAt>
PcdField field_by_rows(const char* name, const PolarScan& scan, const ValueAt& value_at) {
  PcdField field{{name, NumberType::kFloat32, {}}, 1};
  field.values.reserve(scan.point.size());
  for (int row = 0; row < scan.rows; ++row) {
    for (int col = 0; col < scan.cols; ++col) {
      field.values.push_back(static_cast<double>(value_at(scan.index(row, col))));
    }
  }
  return field;
}

PcdField field_of(const char* name, const PolarScan& scan, const std::vector<float>& values) {
  return field_by_rows(
      name, scan, [&](std::size_t c) { return scan.valid[c] != 0 ? values[c] : 0.0F; });
}

void write_pcd_scan(const std::filesystem::path& path, const PolarScan& scan) {
  PcdTable table;
  table.comments = scan_comments(scan);
  table.viewpoint = viewpoint_of(scan.world_from_scan);
  table.width = static_cast<std::size_t>(scan.cols);
  table.height = static_cast<std::size_t>(scan.rows);
  for (int k = 0; k < 3; ++k) {
    constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
    table.fields.push_back(
        field_by_rows(kNames[static_cast<std::size_t>(k)], scan, [&](std::size_t c) {
          return scan.valid[c] != 0 ? scan.point[c][k] : std::numeric_limits<float>::quiet_NaN();
        }));
  }
  table.fields.push_back(field_of("intensity", scan, scan.intensity));
  table.fields.push_back(field_of("range", scan, scan.range));
  table.fields.push_back(field_of("yaw", scan, scan.yaw));
  table.fields.push_back(field_of("pitch", scan, scan.pitch));
  table.fields.push_back(field_of("sigma", scan, scan.sigma));
  write_pcd(path, table);
}

void write_ply_scan(const std::filesystem::path& path, const PolarScan& scan) {
  PlyElement vertices{"vertex", 0, {}};
  for (const char* name : {"x", "y", "z", "row", "col", "intensity", "sigma"}) {
    const bool is_index = name[0] == 'r' || name[0] == 'c';
    const NumberType type = is_index ? NumberType::kInt32 : NumberType::kFloat32;
    vertices.properties.push_back({{name, type, {}}, std::nullopt, {}});
  }
  for (int col = 0; col < scan.cols; ++col) {
    for (int row = 0; row < scan.rows; ++row) {
      const std::size_t c = scan.index(row, col);
      if (scan.valid[c] == 0) continue;
      const Eigen::Vector3d p = scan.point[c].cast<double>();
      const std::array<double, 7> values{p.x(),
                                         p.y(),
                                         p.z(),
                                         static_cast<double>(row),
                                         static_cast<double>(col),
                                         scan.intensity[c],
                                         scan.sigma[c]};
      for (std::size_t k = 0; k < values.size(); ++k) {
        vertices.properties[k].values.push_back(values[k]);
      }
      ++vertices.rows;
    }
  }
  write_ply(path, {vertices});
}

void write_asc_scan(const std::filesystem::path& path, const PolarScan& scan) {
  AtomicFile file(path);
  for (int col = 0; col < scan.cols; ++col) {
    for (int row = 0; row < scan.rows; ++row) {
      const std::size_t c = scan.index(row, col);
      if (scan.valid[c] == 0) continue;
      const Eigen::Vector3f& p = scan.point[c];
      file.stream() << number_text(col) << ' ' << number_text(row) << ' ' << number_text(p.x())
                    << ' ' << number_text(p.y()) << ' ' << number_text(p.z()) << '\n';
    }
  }
  file.commit();
}

/// Fields of a table as the cells of a scan; an absent field is null and gives zeros.
struct ScanFields {
  std::array<const PcdField*, 3> position;
  const PcdField* intensity;
  const PcdField* range;
  const PcdField* yaw;
  const PcdField* pitch;
  const PcdField* sigma;
};

float value_at(const PcdField* field, std::size_t i) {
  return field == nullptr ? 0.0F : static_cast<float>(field->values[i]);
}

/// Fills the cell from entry i of the fields; without range, yaw and pitch these are derived.
void fill_cell(PolarScan& scan, std::size_t cell, const ScanFields& fields, std::size_t i) {
  const Eigen::Vector3d p(
      fields.position[0]->values[i], fields.position[1]->values[i], fields.position[2]->values[i]);
  if (!p.cast<float>().allFinite()) return;
  scan.set(cell, p, value_at(fields.intensity, i), value_at(fields.sigma, i));
  if (fields.range == nullptr) return;
  scan.range[cell] = value_at(fields.range, i);
  scan.yaw[cell] = value_at(fields.yaw, i);
  scan.pitch[cell] = value_at(fields.pitch, i);
}

/// What another program calls range, yaw and pitch may mean something else, so these three are
/// taken from our own files only.
ScanFields fields_of(const PcdTable& table, bool own, const std::filesystem::path& path) {
  const auto polar = [&](const char* name) { return own ? &table.field(name, path) : nullptr; };
  return {{&table.field("x", path), &table.field("y", path), &table.field("z", path)},
          table.find("intensity"),
          polar("range"),
          polar("yaw"),
          polar("pitch"),
          table.find("sigma")};
}

void check_size(const PcdTable& table, bool own, const std::filesystem::path& path) {
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<int>::max());
  require(table.width >= 1 && table.height >= 1 && table.width <= kMost && table.height <= kMost,
          "'",
          path.string(),
          "' holds ",
          table.width,
          " x ",
          table.height,
          " points; a scan needs at least one");
  require(own || table.height > 1,
          "'",
          path.string(),
          "' is a plain cloud (HEIGHT 1), not an organised scan; read it as a cloud");
}

}  // namespace

PolarScan read_scan(const std::filesystem::path& path) {
  require(lower_extension(path) == ".pcd",
          "cannot read a scan from '",
          path.string(),
          "': expected a name that ends in .pcd");
  const PcdTable table = read_pcd(path);
  const bool own = has_scan_comments(table.comments);
  check_size(table, own, path);
  const ScanFields fields = fields_of(table, own, path);
  PolarScan scan = PolarScan::empty(static_cast<int>(table.height), static_cast<int>(table.width));
  for (int row = 0; row < scan.rows; ++row) {
    for (int col = 0; col < scan.cols; ++col) {
      const std::size_t i = static_cast<std::size_t>(row) * table.width;
      fill_cell(scan, scan.index(row, col), fields, i + static_cast<std::size_t>(col));
    }
  }
  scan.world_from_scan = pose_of(table.viewpoint, path);
  if (own) read_scan_comments(table.comments, scan, path);
  return scan;
}

void write_scan(const std::filesystem::path& path, const PolarScan& scan) {
  scan.check();
  require(scan.rows > 0 && scan.cols > 0,
          "the scan for '",
          path.string(),
          "' has no cells; nothing was written; check the steps before");
  const std::string extension = lower_extension(path);
  if (extension == ".pcd") return write_pcd_scan(path, scan);
  if (extension == ".ply") return write_ply_scan(path, scan);
  if (extension == ".asc") return write_asc_scan(path, scan);
  fail("cannot write a scan to '",
       path.string(),
       "': expected a name that ends in .pcd, .ply or .asc");
}

}  // namespace facula
