// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/rig/toml_table.hpp>
#include <facula/acquire/simulate/scene.hpp>

#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr double kMillimetre = 1e-3;

Shape read_mesh_shape(TomlTable& table) {
  const std::filesystem::path file = table.text("file");
  const double unit = table.number_if("unit_mm").value_or(1000.0) * kMillimetre;
  return MeshShape{read_mesh(file.is_absolute() ? file : table.folder() / file, unit)};
}

Shape read_shape(TomlTable& table) {
  const std::string kind = table.text("shape");
  if (kind == "box") return BoxShape{kMillimetre * table.vector3("size_mm")};
  if (kind == "room") return RoomShape{kMillimetre * table.vector3("size_mm")};
  if (kind == "sphere") return SphereShape{kMillimetre * table.number("radius_mm")};
  if (kind == "cylinder") {
    return CylinderShape{kMillimetre * table.number("radius_mm"),
                         kMillimetre * table.number("height_mm")};
  }
  if (kind == "mesh") return read_mesh_shape(table);
  fail(table.where("shape"), ": expected box, room, sphere, cylinder or mesh, got '", kind, "'");
}

// Turns about the fixed axes x, then y, then z.
Eigen::Quaterniond rotation_from_degrees(const Eigen::Vector3d& degrees) {
  const Eigen::Vector3d angle = degrees * std::numbers::pi / 180;
  return Eigen::AngleAxisd(angle.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angle.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angle.x(), Eigen::Vector3d::UnitX());
}

SceneObject read_object(TomlTable& table) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  SceneObject object;
  object.name = table.text("name");
  object.shape = read_shape(table);
  object.world_from_object.translation =
      kMillimetre * table.vector3_if("position_mm").value_or(zero);
  object.world_from_object.rotation =
      rotation_from_degrees(table.vector3_if("rotation_deg").value_or(zero));
  object.albedo = table.number_if("albedo").value_or(object.albedo);
  object.colour = table.vector3_if("colour").value_or(object.colour);
  object.mirror = table.number_if("mirror").value_or(object.mirror);
  object.glow = table.number_if("glow_dn").value_or(object.glow);
  table.finish();
  return object;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path) {
  TomlTable file = TomlTable::from_file(path);
  std::vector<SceneObject> objects;
  for (TomlTable& table : file.tables("object")) objects.push_back(read_object(table));
  file.finish();
  require(!objects.empty(), path.string(), ": expected at least one [[object]], got none");
  try {
    return Scene(std::move(objects));
  } catch (const Error& error) {
    fail(path.string(), ": ", error.what());
  }
}

}  // namespace facula
