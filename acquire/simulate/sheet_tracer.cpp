// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/object_light.hpp>
#include <facula/acquire/simulate/sheet_tracer.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRowTolerance = 1e-7;  // of a crossing [px]
constexpr double kStepPixels = 0.5;     // between neighbouring rays of the fan, at the far end [px]

}  // namespace

SheetTracer::SheetTracer(const Scene& scene,
                         const Rig& rig,
                         const LaserFan& fan,
                         LaserColour colour)
    : scene_(scene),
      camera_(rig.camera),
      fan_(fan),
      colour_(colour),
      per_row_(rig.stripe_direction == StripeDirection::kPerRow) {}

std::size_t SheetTracer::rows() const {
  return static_cast<std::size_t>(per_row_ ? camera_.height : camera_.width);
}

std::vector<std::optional<FanHit>> SheetTracer::trace() const {
  std::vector<std::optional<FanHit>> brightest(rows());
  const double step = kStepPixels / std::max(camera_.fx, camera_.fy);
  const int count = static_cast<int>(std::ceil(2 * std::numbers::pi / step));
  std::optional<FanHit> last;
  for (int i = 0; i <= count; ++i) {
    std::optional<FanHit> next = shoot(2 * std::numbers::pi * i / count);
    if (last && next) keep_crossings(*last, *next, brightest);
    last = std::move(next);
  }
  return brightest;
}

double SheetTracer::brightness(const FanHit& hit) const {
  const SceneObject& object = scene_.objects()[hit.object];
  return object.albedo * laser_tint(object.colour, colour_) * fan_.middle_signal(hit.x, hit.normal);
}

// None where the ray leaves the scene or ends behind the camera.
std::optional<FanHit> SheetTracer::shoot(double angle) const {
  const Vector3d direction = fan_.ray(angle);
  if (fan_.origin.z() <= 0 && direction.z() <= 0) return std::nullopt;
  const auto hit =
      scene_.first_hit(world_from_camera_ * fan_.origin, world_from_camera_.rotation * direction);
  if (!hit) return std::nullopt;
  FanHit result;
  result.angle = angle;
  result.x = fan_.origin + hit->distance * direction;
  if (!(result.x.z() > 1e-3)) return std::nullopt;
  result.normal = world_from_camera_.rotation.conjugate() * hit->normal;
  result.object = hit->object;
  result.pixel = camera_.project(result.x);
  result.row = per_row_ ? result.pixel.y() : result.pixel.x();
  return result;
}

// Every row centre that lies between two neighbouring rays of the fan.
void SheetTracer::keep_crossings(const FanHit& a,
                                 const FanHit& b,
                                 std::vector<std::optional<FanHit>>& brightest) const {
  const auto [low, high] = std::minmax(a.row, b.row);
  const double last_row = static_cast<double>(rows()) - 1;
  if (!(high >= 0 && low <= last_row)) return;
  const int first = static_cast<int>(std::ceil(std::max(low, 0.0)));
  const int last = static_cast<int>(std::floor(std::min(high, last_row)));
  for (int row = first; row <= last; ++row) {
    const std::optional<FanHit> hit = refine(a, b, row);
    if (!hit || !seen(*hit)) continue;
    std::optional<FanHit>& best = brightest[static_cast<std::size_t>(row)];
    if (brightness(*hit) > (best ? brightness(*best) : 0.0)) best = hit;
  }
}

// Regula falsi (Illinois). Where the surface jumps between the rays there is no crossing: the
// bracket then shrinks onto the jump without its row ever coming near.
std::optional<FanHit> SheetTracer::refine(FanHit a, FanHit b, int row) const {
  double error_a = a.row - row;
  double error_b = b.row - row;
  if (std::abs(error_a) < kRowTolerance) return a;
  if (std::abs(error_b) < kRowTolerance) return b;
  for (int i = 0; i < 100; ++i) {
    const double share = i % 8 == 7 ? 0.5 : error_a / (error_a - error_b);
    std::optional<FanHit> middle = shoot(a.angle + share * (b.angle - a.angle));
    if (!middle) return std::nullopt;
    const double error = middle->row - row;
    if (std::abs(error) < kRowTolerance) return middle;
    if ((error > 0) == (error_b > 0)) {
      b = *middle;
      error_b = error;
      error_a *= 0.5;
    } else {
      a = b;
      error_a = error_b;
      b = *middle;
      error_b = error;
    }
    if (std::abs(b.angle - a.angle) < 1e-14) return std::nullopt;
  }
  return std::nullopt;
}

// In the image, not behind the fold of the distortion, and with a free view.
bool SheetTracer::seen(const FanHit& hit) const {
  if (!(hit.pixel.x() >= -0.5 && hit.pixel.x() <= camera_.width - 0.5)) return false;
  if (!(hit.pixel.y() >= -0.5 && hit.pixel.y() <= camera_.height - 0.5)) return false;
  const std::optional<Vector2d> ray = camera_.undistort(hit.pixel);
  if (!ray || (*ray - hit.x.head<2>() / hit.x.z()).norm() > 1e-6) return false;
  return !scene_.occluded(world_from_camera_.translation, world_from_camera_ * hit.x);
}

}  // namespace facula
