// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_columns.hpp>
#include <facula/acquire/core/error.hpp>

#include <array>
#include <cmath>
#include <optional>

namespace facula {
namespace {

using Names = std::array<const char*, 3>;
using Columns3 = std::array<const NumberColumn*, 3>;

std::optional<Columns3> find_three(const ColumnLookup& find, const Names& names) {
  Columns3 columns{};
  for (std::size_t k = 0; k < 3; ++k) {
    columns[k] = find(names[k]);
    if (columns[k] == nullptr) return std::nullopt;
  }
  return columns;
}

Eigen::Vector3f vector_at(const Columns3& columns, std::size_t row) {
  return {static_cast<float>(columns[0]->values[row]),
          static_cast<float>(columns[1]->values[row]),
          static_cast<float>(columns[2]->values[row])};
}

std::vector<Eigen::Vector3f> vectors_at(const std::optional<Columns3>& columns,
                                        const std::vector<std::size_t>& rows) {
  std::vector<Eigen::Vector3f> result;
  if (!columns) return result;
  result.reserve(rows.size());
  for (const std::size_t row : rows) result.push_back(vector_at(*columns, row));
  return result;
}

std::vector<float> numbers_at(const NumberColumn* column, const std::vector<std::size_t>& rows) {
  std::vector<float> result;
  if (column == nullptr) return result;
  double scale = 1;
  if (column->type == NumberType::kUint8) scale = 1.0 / 255;
  if (column->type == NumberType::kUint16) scale = 1.0 / 65535;
  result.reserve(rows.size());
  for (const std::size_t row : rows) {
    result.push_back(static_cast<float>(column->values[row] * scale));
  }
  return result;
}

std::uint8_t color_part(const NumberColumn& column, double value) {
  const bool is_fraction =
      column.type == NumberType::kFloat32 || column.type == NumberType::kFloat64;
  const double scaled = is_fraction ? value * 255 : value;
  if (!(scaled > 0)) return 0;
  return scaled >= 255 ? 255 : static_cast<std::uint8_t>(std::lround(scaled));
}

std::vector<Color> colors_at(const ColumnLookup& find, const std::vector<std::size_t>& rows) {
  std::vector<Color> result;
  const NumberColumn* packed = find("rgb") != nullptr ? find("rgb") : find("rgba");
  if (packed != nullptr) {
    for (const std::size_t row : rows) {
      const double value = packed->values[row];
      const auto bits =
          value >= 0 && value <= 0xFFFFFFFFp0 ? static_cast<std::uint32_t>(value) : 0U;
      result.push_back({static_cast<std::uint8_t>(bits >> 16U & 255U),
                        static_cast<std::uint8_t>(bits >> 8U & 255U),
                        static_cast<std::uint8_t>(bits & 255U)});
    }
    return result;
  }
  const auto parts = find_three(find, {"red", "green", "blue"});
  if (!parts) return result;
  for (const std::size_t row : rows) {
    Color color{};
    for (std::size_t k = 0; k < 3; ++k) {
      color[k] = color_part(*(*parts)[k], (*parts)[k]->values[row]);
    }
    result.push_back(color);
  }
  return result;
}

template <typename ValueAt>
void add_column(std::vector<NumberColumn>& columns,
                const std::string& name,
                NumberType type,
                std::size_t rows,
                const ValueAt& value_at) {
  if (rows == 0) return;
  NumberColumn column{name, type, {}};
  column.values.reserve(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    column.values.push_back(static_cast<double>(value_at(i)));
  }
  columns.push_back(std::move(column));
}

void add_vectors(std::vector<NumberColumn>& columns,
                 const Names& names,
                 const std::vector<Eigen::Vector3f>& vectors) {
  for (int k = 0; k < 3; ++k) {
    add_column(columns,
               names[static_cast<std::size_t>(k)],
               NumberType::kFloat32,
               vectors.size(),
               [&](std::size_t i) { return vectors[i][k]; });
  }
}

void add_rest(std::vector<NumberColumn>& columns, const PointCloud& cloud) {
  add_column(columns, "intensity", NumberType::kFloat32, cloud.intensity.size(), [&](auto i) {
    return cloud.intensity[i];
  });
  add_column(columns, "sigma", NumberType::kFloat32, cloud.sigma.size(), [&](auto i) {
    return cloud.sigma[i];
  });
  add_vectors(columns, {"sensor_x", "sensor_y", "sensor_z"}, cloud.sensor_origin);
}

}  // namespace

PointCloud cloud_from_columns(const ColumnLookup& find, const std::filesystem::path& path) {
  const auto position = find_three(find, {"x", "y", "z"});
  require(position.has_value(),
          "'",
          path.string(),
          "' lacks one of the columns x y z; choose a file with points");
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < (*position)[0]->values.size(); ++row) {
    if (vector_at(*position, row).allFinite()) rows.push_back(row);
  }
  PointCloud cloud;
  cloud.points = vectors_at(position, rows);
  auto normals = find_three(find, {"nx", "ny", "nz"});
  if (!normals) normals = find_three(find, {"normal_x", "normal_y", "normal_z"});
  cloud.normals = vectors_at(normals, rows);
  cloud.colors = colors_at(find, rows);
  cloud.intensity = numbers_at(find("intensity"), rows);
  cloud.sigma = numbers_at(find("sigma"), rows);
  cloud.sensor_origin = vectors_at(find_three(find, {"sensor_x", "sensor_y", "sensor_z"}), rows);
  return cloud;
}

std::vector<NumberColumn> ply_columns(const PointCloud& cloud) {
  std::vector<NumberColumn> columns;
  add_vectors(columns, {"x", "y", "z"}, cloud.points);
  add_vectors(columns, {"nx", "ny", "nz"}, cloud.normals);
  const Names colors{"red", "green", "blue"};
  for (std::size_t k = 0; k < 3; ++k) {
    add_column(columns, colors[k], NumberType::kUint8, cloud.colors.size(), [&](std::size_t i) {
      return cloud.colors[i][k];
    });
  }
  add_rest(columns, cloud);
  return columns;
}

std::vector<NumberColumn> pcd_columns(const PointCloud& cloud) {
  std::vector<NumberColumn> columns;
  add_vectors(columns, {"x", "y", "z"}, cloud.points);
  add_vectors(columns, {"normal_x", "normal_y", "normal_z"}, cloud.normals);
  // PCL takes a packed colour as `rgba` when it is an integer, as `rgb` when it is a float.
  add_column(columns, "rgba", NumberType::kUint32, cloud.colors.size(), [&](std::size_t i) {
    const Color& c = cloud.colors[i];
    return 0xFF000000U | std::uint32_t{c[0]} << 16U | std::uint32_t{c[1]} << 8U | c[2];
  });
  add_rest(columns, cloud);
  return columns;
}

}  // namespace facula
