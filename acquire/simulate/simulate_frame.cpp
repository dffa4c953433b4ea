// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where each term of the image comes from
//
// The signal of a pixel is the mean, over the pixel's area, of the light that the surface point
// behind each spot of that area sends to the camera. Surfaces are Lambertian: their radiance, and
// with it the signal, does not depend on where the camera stands, only on the light they receive.
//
//   ambient   comes alike from all sides and is not shadowed, so a surface of albedo a gives a * A
//             whatever its pose (A: SimulateOptions::ambient). A turntable may therefore be
//             rendered by turning the head about the still object.
//   laser     leaves one point L and is a fan in the sheet n . x = d. At distance r from L its
//   power
//             has spread along the fan in proportion to r and across the sheet over a Gaussian of
//             standard deviation w(r) = w0 + theta r, whose peak is proportional to 1 / w(r) as the
//             power across stays what it was. A surface that the light meets at an angle gets the
//             cosine of it (Lambert). At distance s from the middle of the sheet
//               E = P (1 m / r)^p (w(1 m) / w(r)) cos(angle) exp(-s^2 / (2 w(r)^2))
//             and a * E is the signal, where the straight way from the point to L is free; p = 1 is
//             the fan's own spreading, a smaller p stands for a sensor that compresses or a head
//             that adapts its exposure (SimulateOptions::exposure_falloff).
//   sensor    electrons arrive as a Poisson process: the signal S has variance g S (g in DN per
//             DN, shot_noise), and reading adds read_noise^2; both are drawn as one normal number
//             of variance read_noise^2 + g S, which is close for more than about 10 electrons.
//             Black level is added, the sum rounded and clipped to 0..255.
//
// The integral over the pixel is a regular 4 x 4 midpoint rule where light of the sheet can come
// in: it places a Gaussian line of sigma >= 1 px to better than 0.005 px (a test holds it to that).
// Left out: blur of the lens, speckle, vignetting, light that is scattered twice, and things that
// are so thin (under one pixel; under two, away from the sheet) that no ray meets them.
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/simulate/frame_renderer.hpp>
#include <facula/acquire/simulate/shape_geometry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kLaserGrid = 4;   // sub-pixels each way where the sheet's light can come in
constexpr int kEdgeGrid = 2;    // sub-pixels each way where only ambient light changes
constexpr double kReach = 5.0;  // half widths from the sheet beyond which its light is nothing [1]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class Light { kUnknown, kFree, kBlocked };

// What the ray through a pixel's centre meets, in the camera frame.
struct Surface {
  int object = -1;  // -1: nothing
  Vector3d x = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  double low = kInfinity;    // sheet -+ the reach of the light: the sheet shines here
  double high = -kInfinity;  // when low <= 0 <= high [m]
  Light light = Light::kUnknown;
};

bool same_plane(const Surface& a, const Surface& b) {
  return a.object == b.object && (a.normal - b.normal).squaredNorm() < 1e-20 &&
         std::abs(a.normal.dot(a.x - b.x)) < 1e-9;
}

// Whether both lie on one smooth face of one object; its edges turn the normal by more.
bool same_bend(const Surface& a, const Surface& b) {
  return a.object == b.object && a.normal.dot(b.normal) > 0.9;
}

bool in_reach(const Surface& s) {
  return s.low <= 0 && s.high >= 0;
}

// Whether the pixels between two others may be taken from the plane that both lie on: not near the
// sheet, where every pixel has a ray of its own.
bool same_plane_off_sheet(const Surface& a, const Surface& b) {
  if (a.object < 0 || b.object < 0) return a.object == b.object;
  const bool left = a.high < 0 && b.high < 0;
  const bool right = a.low > 0 && b.low > 0;
  return (left || right) && same_plane(a, b);
}

}  // namespace

// One frame. Rows of surfaces are kept in a ring of four: shading row r looks at r - 1 to r + 1,
// tracing odd row r + 1 at r and r + 2.
class FrameRenderer::Pass {
 public:
  Pass(const FrameRenderer& head, const RigidTransform& world_from_camera, bool laser_on)
      : head_(head),
        width_(head.rays_.width()),
        height_(head.rays_.height()),
        world_from_camera_(world_from_camera.rotation.toRotationMatrix()),
        camera_in_world_(world_from_camera.translation),
        laser_in_world_(world_from_camera * head.fan_.origin),
        laser_on_(laser_on),
        column_low_(static_cast<std::size_t>(width_)),
        column_high_(static_cast<std::size_t>(width_)) {
    for (auto& row : ring_) row.resize(static_cast<std::size_t>(width_));
    for (const SceneObject& object : head.scene_.objects()) {
      object_from_camera_.push_back(object.world_from_object.inverse() * world_from_camera);
    }
  }

  // Signal of the next row, from the top.
  void shade_row(int r, double* signal) {
    while (traced_ <= std::min(r + 1, height_ - 1)) trace_next_rows();
    if (laser_on_) find_reach(r);
    for (int c = 0; c < width_; ++c) signal[c] = shade_pixel(r, c);
  }

 private:
  std::vector<Surface>& row(int r) { return ring_[static_cast<std::size_t>(r) % ring_.size()]; }
  Surface& at(int r, int c) { return row(r)[static_cast<std::size_t>(c)]; }

  Surface surface_at(const Vector3d& x, const Vector3d& normal, int object) const {
    Surface result;
    result.object = object;
    result.x = x;
    result.normal = normal;
    const double reach = kReach * head_.fan_.half_width((x - head_.fan_.origin).norm());
    const double sheet = head_.fan_.sheet_distance(x);
    result.low = sheet - reach;
    result.high = sheet + reach;
    return result;
  }

  Surface cast(const Vector2d& ray) const {
    const Vector3d direction = Vector3d(ray.x(), ray.y(), 1).normalized();
    if (!direction.allFinite()) return {};
    const auto hit = head_.scene_.first_hit(camera_in_world_, world_from_camera_ * direction);
    if (!hit) return {};
    return surface_at(hit->distance * direction,
                      world_from_camera_.transpose() * hit->normal,
                      static_cast<int>(hit->object));
  }

  Surface on_plane(const Surface& plane, const Vector2d& ray) const {
    if (plane.object < 0) return {};
    const Vector3d direction(ray.x(), ray.y(), 1);
    const double depth = plane.normal.dot(plane.x) / plane.normal.dot(direction);
    return surface_at(depth * direction, plane.normal, plane.object);
  }

  // The same for a ray that is known to meet this convex object first.
  Surface cast_on(int object, const Vector2d& ray) const {
    const RigidTransform& object_from_camera =
        object_from_camera_[static_cast<std::size_t>(object)];
    const Vector3d direction = Vector3d(ray.x(), ray.y(), 1).normalized();
    const auto hit = intersect_shape(head_.scene_.objects()[static_cast<std::size_t>(object)].shape,
                                     object_from_camera.translation,
                                     object_from_camera.rotation * direction,
                                     0.0);
    if (!hit) return {};
    const Vector3d normal = object_from_camera.rotation.conjugate() * hit->normal;
    return surface_at(
        hit->distance * direction, normal.dot(direction) > 0 ? Vector3d(-normal) : normal, object);
  }

  // An even row by itself; an odd row together with the one below it, which it is drawn from.
  void trace_next_rows() {
    const int r = traced_;
    const bool between = r % 2 == 1 && r + 1 < height_;
    if (between) trace_alone(r + 1);
    if (between) {
      for (int c = 0; c < width_; ++c) at(r, c) = trace_between(at(r - 1, c), at(r + 1, c), r, c);
    } else {
      trace_alone(r);
    }
    traced_ += between ? 2 : 1;
  }

  void trace_alone(int r) {
    for (int c = 0; c < width_; c += 2) at(r, c) = cast(head_.rays_.centre(r, c));
    for (int c = 1; c < width_; c += 2) {
      at(r, c) = c + 1 < width_ ? trace_between(at(r, c - 1), at(r, c + 1), r, c)
                                : cast(head_.rays_.centre(r, c));
    }
  }

  // A pixel between two others on one plane is taken to show the same plane, one ray saved. Its
  // spot is left where a's is: off the sheet only the plane and the side of the sheet are asked
  // for.
  Surface trace_between(const Surface& a, const Surface& b, int r, int c) const {
    if (!same_plane_off_sheet(a, b)) return cast(head_.rays_.centre(r, c));
    Surface between = a;
    between.light = Light::kUnknown;
    return between;
  }

  // Per column the span of the sheet's distance over rows r - 1 to r + 1.
  void find_reach(int r) {
    std::fill(column_low_.begin(), column_low_.end(), kInfinity);
    std::fill(column_high_.begin(), column_high_.end(), -kInfinity);
    for (int y = std::max(r - 1, 0); y <= std::min(r + 1, height_ - 1); ++y) {
      const std::vector<Surface>& surfaces = row(y);
      for (std::size_t c = 0; c < surfaces.size(); ++c) {
        column_low_[c] = std::min(column_low_[c], surfaces[c].low);
        column_high_[c] = std::max(column_high_[c], surfaces[c].high);
      }
    }
  }

  // Whether any spot of the pixel can get light of the sheet: the sheet, with its reach, passes
  // between the pixel's neighbours or touches one of them.
  bool near_sheet(int c) const {
    double low = kInfinity;
    double high = -kInfinity;
    for (int x = std::max(c - 1, 0); x <= std::min(c + 1, width_ - 1); ++x) {
      low = std::min(low, column_low_[static_cast<std::size_t>(x)]);
      high = std::max(high, column_high_[static_cast<std::size_t>(x)]);
    }
    return low <= 0 && high >= 0;
  }

  double shade_pixel(int r, int c) {
    if (laser_on_ && near_sheet(c)) return shade_near_sheet(r, c);
    const Surface& centre = at(r, c);
    const bool edge = (c > 0 && at(r, c - 1).object != centre.object) ||
                      (c + 1 < width_ && at(r, c + 1).object != centre.object) ||
                      (r > 0 && at(r - 1, c).object != centre.object) ||
                      (r + 1 < height_ && at(r + 1, c).object != centre.object);
    if (!edge) return ambient_of(centre);
    double sum = 0;
    for (int i = 0; i < kEdgeGrid * kEdgeGrid; ++i) {
      sum += ambient_of(cast(head_.rays_.within(r, c, i, kEdgeGrid)));
    }
    return sum / (kEdgeGrid * kEdgeGrid);
  }

  double shade_near_sheet(int r, int c) {
    const Surface& centre = at(r, c);
    const bool plane =
        neighbours_all(r, c, [&](const Surface& s) { return same_plane(s, centre); });
    const bool bend = !plane && is_convex(centre) &&
                      neighbours_all(r, c, [&](const Surface& s) { return same_bend(s, centre); });
    const Light light = plane || bend ? common_light(r, c) : Light::kUnknown;
    double sum = 0;
    for (int i = 0; i < kLaserGrid * kLaserGrid; ++i) {
      const Vector2d ray = head_.rays_.within(r, c, i, kLaserGrid);
      Surface spot = plane ? on_plane(centre, ray) : bend ? cast_on(centre.object, ray) : cast(ray);
      spot.light = light;
      sum += ambient_of(spot) + laser_signal(spot);
    }
    return sum / (kLaserGrid * kLaserGrid);
  }

  bool is_convex(const Surface& s) const {
    return s.object >= 0 && !std::holds_alternative<MeshShape>(
                                head_.scene_.objects()[static_cast<std::size_t>(s.object)].shape);
  }

  template <typename Predicate>
  bool neighbours_all(int r, int c, const Predicate& holds) {
    for (int y = std::max(r - 1, 0); y <= std::min(r + 1, height_ - 1); ++y) {
      for (int x = std::max(c - 1, 0); x <= std::min(c + 1, width_ - 1); ++x) {
        if (!holds(at(y, x))) return false;
      }
    }
    return true;
  }

  // Whether the pixel and its neighbours in the light's reach all see the laser or all do not;
  // unknown when they differ.
  Light common_light(int r, int c) {
    Surface& centre = at(r, c);
    if (!in_reach(centre)) return Light::kUnknown;
    const Light light = light_at(centre);
    const auto agrees = [&](Surface& s) { return !in_reach(s) || light_at(s) == light; };
    return neighbours_all(r, c, agrees) ? light : Light::kUnknown;
  }

  Light light_at(Surface& spot) const {
    if (spot.light == Light::kUnknown && spot.object >= 0) {
      const Vector3d in_world = camera_in_world_ + world_from_camera_ * spot.x;
      spot.light =
          head_.scene_.occluded(in_world, laser_in_world_) ? Light::kBlocked : Light::kFree;
    }
    return spot.light;
  }

  double ambient_of(const Surface& spot) const {
    return spot.object < 0 ? 0.0 : albedo_of(spot) * head_.options_.ambient;
  }

  double laser_signal(Surface& spot) const {
    if (spot.object < 0 || !in_reach(spot)) return 0;
    const double signal = albedo_of(spot) * head_.fan_.signal(spot.x, spot.normal);
    return signal > 0 && light_at(spot) == Light::kFree ? signal : 0.0;
  }

  double albedo_of(const Surface& spot) const {
    return head_.scene_.objects()[static_cast<std::size_t>(spot.object)].albedo;
  }

  const FrameRenderer& head_;
  int width_;
  int height_;
  Eigen::Matrix3d world_from_camera_;  // rotation
  Vector3d camera_in_world_;
  Vector3d laser_in_world_;
  bool laser_on_;
  std::vector<RigidTransform> object_from_camera_;
  int traced_ = 0;  // rows above this one are traced
  std::array<std::vector<Surface>, 4> ring_;
  std::vector<double> column_low_;
  std::vector<double> column_high_;
};

namespace {

std::uint8_t digitised(double value) {
  return static_cast<std::uint8_t>(std::floor(std::clamp(value, 0.0, 255.0) + 0.5));
}

}  // namespace

FrameRenderer::FrameRenderer(const Scene& scene, const Rig& rig, const SimulateOptions& options)
    : scene_(scene), options_(options), fan_(laser_fan(rig, options)), rays_(rig.camera) {}

Image<double> FrameRenderer::expected_signal(const RigidTransform& world_from_camera,
                                             bool laser_on) const {
  Image<double> image(rays_.height(), rays_.width());
  Pass pass(*this, world_from_camera, laser_on);
  for (int r = 0; r < rays_.height(); ++r) pass.shade_row(r, image.row(r));
  return image;
}

Image8 FrameRenderer::render(const RigidTransform& world_from_camera,
                             bool laser_on,
                             std::uint64_t frame) const {
  Image8 image(rays_.height(), rays_.width());
  Pass pass(*this, world_from_camera, laser_on);
  std::vector<double> signal(static_cast<std::size_t>(rays_.width()));
  const double read_variance = options_.read_noise * options_.read_noise;
  for (int r = 0; r < rays_.height(); ++r) {
    pass.shade_row(r, signal.data());
    const std::uint64_t exposure = 2 * frame + (laser_on ? 1 : 0);
    Random random(
        options_.seed,
        exposure * static_cast<std::uint64_t>(rays_.height()) + static_cast<std::uint64_t>(r));
    std::uint8_t* out = image.row(r);
    for (const double expected : signal) {
      const double noise = std::sqrt(read_variance + options_.shot_noise * expected);
      *out++ = digitised(options_.black_level + expected + noise * random.normal());
    }
  }
  return image;
}

Image8 simulate_frame(const Scene& scene,
                      const Rig& rig,
                      const RigidTransform& world_from_camera,
                      bool laser_on,
                      std::uint64_t frame,
                      const SimulateOptions& options) {
  return FrameRenderer(scene, rig, options).render(world_from_camera, laser_on, frame);
}

}  // namespace facula
