// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/simulate/laser_fan.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRowTolerance = 1e-7;  // of a crossing [px]
constexpr double kStepPixels = 0.5;     // between neighbouring rays of the fan, at the far end [px]

// Where a ray of the fan's middle first meets the scene, camera frame.
struct FanHit {
  double angle = 0;  // of the ray in the sheet [rad]
  Vector3d x;        // [m]
  Vector3d normal;
  std::size_t object = 0;
  Vector2d pixel;
  double row = 0;  // image coordinate along the stripe [px]
};

// Follows the middle of the sheet over the scene, for one pose of the head. Works from the laser's
// side with rays of its own; of the image it knows only the camera's projection.
class SheetTracer {
 public:
  SheetTracer(const Scene& scene, const Rig& rig, const LaserFan& fan)
      : scene_(scene),
        camera_(rig.camera),
        fan_(fan),
        per_row_(rig.stripe_direction == StripeDirection::kPerRow) {
    along_ = fan.normal.unitOrthogonal();
    across_ = fan.normal.cross(along_);
  }

  void place(const RigidTransform& world_from_camera) { world_from_camera_ = world_from_camera; }

  std::size_t rows() const {
    return static_cast<std::size_t>(per_row_ ? camera_.height : camera_.width);
  }

  // Per image row the brightest point of the sheet's middle that the camera sees there.
  std::vector<std::optional<FanHit>> trace() const {
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

  // Signal of the point in the middle of the sheet [DN].
  double brightness(const FanHit& hit) const {
    return scene_.objects()[hit.object].albedo * fan_.middle_signal(hit.x, hit.normal);
  }

 private:
  // None where the ray leaves the scene or ends behind the camera.
  std::optional<FanHit> shoot(double angle) const {
    const Vector3d direction = std::cos(angle) * along_ + std::sin(angle) * across_;
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
  void keep_crossings(const FanHit& a,
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
  std::optional<FanHit> refine(FanHit a, FanHit b, int row) const {
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
  bool seen(const FanHit& hit) const {
    if (!(hit.pixel.x() >= -0.5 && hit.pixel.x() <= camera_.width - 0.5)) return false;
    if (!(hit.pixel.y() >= -0.5 && hit.pixel.y() <= camera_.height - 0.5)) return false;
    const std::optional<Vector2d> ray = camera_.undistort(hit.pixel);
    if (!ray || (*ray - hit.x.head<2>() / hit.x.z()).norm() > 1e-6) return false;
    return !scene_.occluded(world_from_camera_.translation, world_from_camera_ * hit.x);
  }

  const Scene& scene_;
  const Camera& camera_;
  const LaserFan& fan_;
  bool per_row_ = true;
  Vector3d along_;
  Vector3d across_;
  RigidTransform world_from_camera_;
};

}  // namespace

PolarScan true_scan(const Scene& scene,
                    const Rig& rig,
                    const RigidTransform& world_from_scan,
                    const std::vector<double>& positions,
                    const SimulateOptions& options) {
  const LaserFan fan = laser_fan(rig, options);
  const SheetTracer blank(scene, rig, fan);
  PolarScan scan =
      PolarScan::empty(static_cast<int>(blank.rows()), static_cast<int>(positions.size()));
  scan.world_from_scan = world_from_scan;
  scan.axis_position = positions;
  const auto trace_columns = [&](std::size_t begin, std::size_t end) {
    SheetTracer tracer = blank;
    for (std::size_t col = begin; col < end; ++col) {
      const RigidTransform scan_from_camera = rig.axis.scan_from_camera_at(positions[col]);
      scan.sensor_origin[col] = scan_from_camera.translation;
      tracer.place(world_from_scan * scan_from_camera);
      const std::vector<std::optional<FanHit>> hits = tracer.trace();
      for (std::size_t row = 0; row < hits.size(); ++row) {
        if (!hits[row]) continue;
        const double signal = std::min(tracer.brightness(*hits[row]) / 255, 1.0);
        scan.set(scan.index(static_cast<int>(row), static_cast<int>(col)),
                 scan_from_camera * hits[row]->x,
                 static_cast<float>(signal),
                 0.0F);
      }
    }
  };
  parallel_for(positions.size(), trace_columns, {.num_threads = options.num_threads, .chunk = 1});
  return scan;
}

}  // namespace facula
