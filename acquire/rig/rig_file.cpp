// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/toml_text.hpp>
#include <facula/acquire/rig/rig_covariance_file.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/rig/simple_calibrations_file.hpp>
#include <facula/acquire/rig/toml_table.hpp>

#include <cmath>
#include <locale>
#include <numbers>
#include <sstream>

namespace facula {
namespace {

Camera read_camera(TomlTable table) {
  Camera camera;
  camera.width = table.integer("width_px");
  camera.height = table.integer("height_px");
  camera.fx = table.number("fx_px");
  camera.fy = table.number("fy_px");
  camera.cx = table.number("cx_px");
  camera.cy = table.number("cy_px");
  camera.k1 = table.number_if("k1").value_or(0);
  camera.k2 = table.number_if("k2").value_or(0);
  camera.p1 = table.number_if("p1").value_or(0);
  camera.p2 = table.number_if("p2").value_or(0);
  camera.k3 = table.number_if("k3").value_or(0);
  table.finish();
  return camera;
}

LaserPlane read_laser(TomlTable& table) {
  LaserPlane laser;
  laser.name = table.text_if("name").value_or("laser");
  laser.normal = table.vector3("normal");
  laser.distance = 1e-3 * table.number("distance_mm");
  laser.bow = table.number_if("bow_deg").value_or(0) * std::numbers::pi / 180;
  table.finish();
  // Published planes are printed with few digits: a small deviation from length 1 is theirs.
  const double length = laser.normal.norm();
  if (std::abs(length - 1) < 1e-3) {
    laser.normal /= length;
    laser.distance /= length;
  }
  return laser;
}

AxisKind axis_kind_from_name(const std::string& name, const std::string& where) {
  for (const AxisKind kind :
       {AxisKind::kNone, AxisKind::kPan, AxisKind::kTurntable, AxisKind::kLinear}) {
    if (to_string(kind) == name) return kind;
  }
  fail(where, ": expected none, pan, turntable or linear, got '", name, "'");
}

Axis read_axis(TomlTable table) {
  Axis axis;
  axis.kind = axis_kind_from_name(table.text("kind"), table.where("kind"));
  axis.scan_from_camera = table.pose();
  axis.direction = table.vector3_if("direction").value_or(axis.direction);
  if (std::abs(axis.direction.norm() - 1) < 1e-3) axis.direction.normalize();
  table.finish();
  return axis;
}

StripeDirection read_direction(TomlTable& table) {
  const std::string name = table.text_if("stripe").value_or("upright");
  if (name == "upright") return StripeDirection::kPerRow;
  if (name == "level") return StripeDirection::kPerColumn;
  fail(table.where("stripe"), ": expected upright or level, got '", name, "'");
}

void write_vector(std::ostream& out, const char* key, const Eigen::Vector3d& v) {
  out << key << " = [" << v.x() << ", " << v.y() << ", " << v.z() << "]\n";
}

Rig rig_from_table(TomlTable table, const std::filesystem::path& path, RigParts needed) {
  Rig rig;
  rig.name = table.text_if("name").value_or(path.stem().string());
  rig.stripe_direction = read_direction(table);
  rig.camera = read_camera(table.table("camera"));
  for (TomlTable& laser : table.tables("laser")) rig.lasers.push_back(read_laser(laser));
  if (auto axis = table.table_if("axis")) rig.axis = read_axis(std::move(*axis));
  if (auto covariance = table.table_if("covariance")) {
    rig.covariance = read_covariance(std::move(*covariance));
  }
  read_simple_calibrations(table, rig);
  table.finish();
  try {
    rig.check(needed);
  } catch (const Error& error) {
    fail(path.string(), ": ", error.what());
  }
  return rig;
}

}  // namespace

Rig read_rig(const std::filesystem::path& path, RigParts needed) {
  return rig_from_table(TomlTable::from_file(path), path, needed);
}

Rig parse_rig(const std::string& text, const std::string& source) {
  return rig_from_table(TomlTable::from_text(text, source), source, RigParts::kWhole);
}

std::string rig_text(const Rig& rig, RigParts needed) {
  rig.check(needed);
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  const Camera& c = rig.camera;
  out << "name = " << toml_quoted(rig.name) << "\n"
      << "stripe = \"" << (rig.stripe_direction == StripeDirection::kPerRow ? "upright" : "level")
      << "\"\n\n"
      << "[camera]\nwidth_px = " << c.width << "\nheight_px = " << c.height << "\nfx_px = " << c.fx
      << "\nfy_px = " << c.fy << "\ncx_px = " << c.cx << "\ncy_px = " << c.cy << "\nk1 = " << c.k1
      << "\nk2 = " << c.k2 << "\np1 = " << c.p1 << "\np2 = " << c.p2 << "\nk3 = " << c.k3 << "\n";
  for (const LaserPlane& laser : rig.lasers) {
    out << "\n[[laser]]\nname = " << toml_quoted(laser.name) << "\n";
    write_vector(out, "normal", laser.normal);
    out << "distance_mm = " << laser.distance * 1000 << "\n";
    if (laser.bow != 0) out << "bow_deg = " << laser.bow * 180 / std::numbers::pi << "\n";
  }
  const Eigen::Quaterniond& q = rig.axis.scan_from_camera.rotation;
  out << "\n[axis]\nkind = \"" << to_string(rig.axis.kind) << "\"\n# scan_from_camera\n";
  write_vector(out, "translation_mm", rig.axis.scan_from_camera.translation * 1000);
  out << "quaternion_xyzw = [" << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w() << "]\n";
  write_vector(out, "direction", rig.axis.direction);
  if (rig.covariance) write_covariance(out, *rig.covariance);
  write_simple_calibrations(out, rig);
  return out.str();
}

void write_rig(const std::filesystem::path& path, const Rig& rig, RigParts needed) {
  const std::string text = rig_text(rig, needed);
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

}  // namespace facula
