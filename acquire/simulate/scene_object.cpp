// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/simulate/shape_geometry.hpp>

#include <cmath>
#include <string>

namespace facula {
namespace {

void check_share(const SceneObject& object, const char* field, double value) {
  require(value >= 0 && value <= 1,
          "the ",
          field,
          " of '",
          object.name,
          "' must lie in [0, 1], but is ",
          value);
}

}  // namespace

void check_object(const SceneObject& object) {
  check_shape(object.shape);
  check_share(object, "albedo", object.albedo);
  check_share(object, "mirror", object.mirror);
  for (const double share : object.colour) check_share(object, "colour", share);
  require(object.albedo + object.mirror <= 1 + 1e-9,
          "albedo and mirror of '",
          object.name,
          "' must not add up to more than 1, but give ",
          object.albedo + object.mirror);
  require(object.mirror == 0 || std::holds_alternative<BoxShape>(object.shape),
          "'",
          object.name,
          "' has a mirror share, which only boxes may have; make it a box or leave mirror out");
  require(object.glow >= 0 && object.glow <= 1e6,
          "the glow_dn of '",
          object.name,
          "' must lie in [0, 1e6], but is ",
          object.glow);
  require(object.world_from_object.translation.allFinite() &&
              std::abs(object.world_from_object.rotation.norm() - 1) < 1e-6,
          "the pose of '",
          object.name,
          "' must be finite and its quaternion of length 1");
}

}  // namespace facula
