// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_columns.hpp>
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/pcd_table.hpp>
#include <facula/acquire/core/ply_table.hpp>
#include <facula/acquire/core/point_text.hpp>
#include <facula/acquire/core/range_grid.hpp>
#include <facula/acquire/core/whole_file.hpp>

namespace facula {
namespace {

PointCloud read_ply_cloud(const std::filesystem::path& path, ScanGrid* grid) {
  std::vector<std::string> infos;
  const std::vector<PlyElement> elements = read_ply(path, &infos);
  const PlyElement& vertices = ply_element(elements, "vertex", path);
  const auto find = [&](const std::string& name) -> const NumberColumn* {
    const PlyProperty* property = vertices.find(name);
    return property == nullptr || property->count_type ? nullptr : property;
  };
  PointCloud cloud = cloud_from_columns(find, path);
  if (grid == nullptr) return cloud;
  *grid = range_grid(elements, infos, path);
  if (!grid->empty() && cloud.sensor_origin.empty()) cloud.sensor_origin = seen_from(cloud, *grid);
  return cloud;
}

PointCloud read_pcd_cloud(const std::filesystem::path& path) {
  const PcdTable table = read_pcd(path);
  return cloud_from_columns([&](const std::string& name) { return table.find(name); }, path);
}

PointCloud read_by_extension(const std::filesystem::path& path, ScanGrid* grid) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return read_ply_cloud(path, grid);
  if (extension == ".pcd") return read_pcd_cloud(path);
  if (extension == ".asc") return read_point_text(path, 2);
  if (extension == ".xyz" || extension == ".txt" || extension == ".csv" || extension == ".dat") {
    return read_point_text(path, 0);
  }
  fail("cannot read a cloud from '",
       path.string(),
       "': expected a name that ends in .ply, .pcd, .xyz, .txt, .csv, .dat or .asc");
}

void write_ply_cloud(const std::filesystem::path& path, const PointCloud& cloud) {
  PlyElement vertices{"vertex", cloud.size(), {}};
  for (NumberColumn& column : ply_columns(cloud)) {
    vertices.properties.push_back({std::move(column), std::nullopt, {}});
  }
  write_ply(path, {vertices});
}

void write_pcd_cloud(const std::filesystem::path& path, const PointCloud& cloud) {
  PcdTable table;
  table.width = cloud.size();
  for (NumberColumn& column : pcd_columns(cloud)) table.fields.push_back({std::move(column), 1});
  write_pcd(path, table);
}

}  // namespace

PointCloud read_cloud(const std::filesystem::path& path, ScanGrid* grid) {
  if (grid != nullptr) *grid = {};
  PointCloud cloud = read_by_extension(path, grid);
  require(!cloud.empty(), "'", path.string(), "' holds no valid points; choose another file");
  return cloud;
}

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud) {
  cloud.check();
  require(!cloud.empty(),
          "the cloud for '",
          path.string(),
          "' has no points; nothing was written; check the steps before");
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return write_ply_cloud(path, cloud);
  if (extension == ".pcd") return write_pcd_cloud(path, cloud);
  if (extension == ".xyz") return write_point_text(path, cloud);
  fail("cannot write a cloud to '",
       path.string(),
       "': expected a name that ends in .ply, .pcd or .xyz");
}

}  // namespace facula
