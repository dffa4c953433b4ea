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
// in: for a Gaussian line of sigma >= 1 px its line position is true to far below 0.001 px.
// Left out: blur of the lens, speckle, vignetting, light that is scattered twice, and things that
// are so thin (under one pixel; under two, away from the sheet) that no ray meets them.
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/simulate/frame_renderer.hpp>

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
  double sheet = 0;          // signed distance from the sheet [m]
  double low = kInfinity;    // sheet -+ the reach of the light: the sheet shines here
  double high = -kInfinity;  // when low <= 0 <= high [m]
  Light light = Light::kUnknown;
};

bool same_plane(const Surface& a, const Surface& b) {
  return a.object == b.object && (a.normal - b.normal).squaredNorm() < 1e-20 &&
         std::abs(a.normal.dot(a.x - b.x)) < 1e-9;
}

// Whether the pixels between two others may be taken from the plane that both lie on: not near the
// sheet, where every pixel has a ray of its own.
bool same_plane_off_sheet(const Surface& a, const Surface& b) {
  if (a.object < 0 || b.object < 0) return a.object == b.object;
  const bool left = a.high < 0 && b.high < 0;
  const bool right = a.low > 0 && b.low > 0;
  return (left || right) && same_plane(a, b);
}

// 1 + 1/2, 1 + 3/2, ... of `count` cells: the middle of sub-pixel i as a share of the pixel.
double sub_pixel(int i, int count) {
  return (i + 0.5) / count;
}

}  // namespace

// One frame. Rows of surfaces are kept in a ring of four: shading row r looks at r - 1 to r + 1,
// tracing odd row r + 1 at r and r + 2.
class FrameRenderer::Pass {
 public:
  Pass(const FrameRenderer& head, const RigidTransform& world_from_camera, bool laser_on)
      : head_(head),
        world_from_camera_(world_from_camera.rotation.toRotationMatrix()),
        camera_in_world_(world_from_camera.translation),
        laser_in_world_(world_from_camera * head.fan_.origin),
        laser_on_(laser_on),
        column_low_(static_cast<std::size_t>(head.width_)),
        column_high_(static_cast<std::size_t>(head.width_)) {
    for (auto& row : ring_) row.resize(static_cast<std::size_t>(head.width_));
  }

  // Signal of the next row, from the top.
  void shade_row(int r, double* signal) {
    while (traced_ <= std::min(r + 1, head_.height_ - 1)) trace_next_rows();
    find_reach(r);
    for (int c = 0; c < head_.width_; ++c) signal[c] = shade_pixel(r, c);
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
    result.sheet = head_.fan_.sheet_distance(x);
    result.low = result.sheet - reach;
    result.high = result.sheet + reach;
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

  const Vector2d& centre_ray(int r, int c) const {
    return head_.centre_ray_[static_cast<std::size_t>(r * head_.width_ + c)];
  }

  // An even row by itself; an odd row together with the one below it, which it is drawn from.
  void trace_next_rows() {
    const int r = traced_;
    const bool between = r % 2 == 1 && r + 1 < head_.height_;
    if (between) trace_alone(r + 1);
    if (between) {
      for (int c = 0; c < head_.width_; ++c)
        at(r, c) = trace_between(at(r - 1, c), at(r + 1, c), r, c);
    } else {
      trace_alone(r);
    }
    traced_ += between ? 2 : 1;
  }

  void trace_alone(int r) {
    for (int c = 0; c < head_.width_; c += 2) at(r, c) = cast(centre_ray(r, c));
    for (int c = 1; c < head_.width_; c += 2) {
      at(r, c) = c + 1 < head_.width_ ? trace_between(at(r, c - 1), at(r, c + 1), r, c)
                                      : cast(centre_ray(r, c));
    }
  }

  Surface trace_between(const Surface& a, const Surface& b, int r, int c) const {
    return same_plane_off_sheet(a, b) ? on_plane(a, centre_ray(r, c)) : cast(centre_ray(r, c));
  }

  // Per column the span of the sheet's distance over rows r - 1 to r + 1.
  void find_reach(int r) {
    std::fill(column_low_.begin(), column_low_.end(), kInfinity);
    std::fill(column_high_.begin(), column_high_.end(), -kInfinity);
    for (int y = std::max(r - 1, 0); y <= std::min(r + 1, head_.height_ - 1); ++y) {
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
    for (int x = std::max(c - 1, 0); x <= std::min(c + 1, head_.width_ - 1); ++x) {
      low = std::min(low, column_low_[static_cast<std::size_t>(x)]);
      high = std::max(high, column_high_[static_cast<std::size_t>(x)]);
    }
    return low <= 0 && high >= 0;
  }

  double shade_pixel(int r, int c) {
    if (laser_on_ && near_sheet(c)) return shade_near_sheet(r, c);
    const Surface& centre = at(r, c);
    const bool edge = (c > 0 && at(r, c - 1).object != centre.object) ||
                      (c + 1 < head_.width_ && at(r, c + 1).object != centre.object) ||
                      (r > 0 && at(r - 1, c).object != centre.object) ||
                      (r + 1 < head_.height_ && at(r + 1, c).object != centre.object);
    if (!edge) return ambient_of(centre);
    double sum = 0;
    for (int i = 0; i < kEdgeGrid * kEdgeGrid; ++i) {
      sum += ambient_of(cast(sub_ray(r, c, i, kEdgeGrid)));
    }
    return sum / (kEdgeGrid * kEdgeGrid);
  }

  double shade_near_sheet(int r, int c) {
    const bool plane =
        neighbours_all(r, c, [&](const Surface& s) { return same_plane(s, at(r, c)); });
    const Light light = plane ? common_light(r, c) : Light::kUnknown;
    double sum = 0;
    for (int i = 0; i < kLaserGrid * kLaserGrid; ++i) {
      const Vector2d ray = sub_ray(r, c, i, kLaserGrid);
      Surface spot = plane ? on_plane(at(r, c), ray) : cast(ray);
      spot.light = light;
      sum += ambient_of(spot) + laser_signal(spot);
    }
    return sum / (kLaserGrid * kLaserGrid);
  }

  template <typename Predicate>
  bool neighbours_all(int r, int c, const Predicate& holds) {
    for (int y = std::max(r - 1, 0); y <= std::min(r + 1, head_.height_ - 1); ++y) {
      for (int x = std::max(c - 1, 0); x <= std::min(c + 1, head_.width_ - 1); ++x) {
        if (!holds(at(y, x))) return false;
      }
    }
    return true;
  }

  // Whether the pixel and its neighbours all see the laser or all do not; unknown when they differ.
  Light common_light(int r, int c) {
    const Light light = light_at(at(r, c));
    const bool same = neighbours_all(r, c, [&](Surface& s) { return light_at(s) == light; });
    return same ? light : Light::kUnknown;
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
    if (spot.object < 0 || spot.low > 0 || spot.high < 0) return 0;
    const double signal = albedo_of(spot) * head_.fan_.signal(spot.x, spot.normal);
    return signal > 0 && light_at(spot) == Light::kFree ? signal : 0.0;
  }

  double albedo_of(const Surface& spot) const {
    return head_.scene_.objects()[static_cast<std::size_t>(spot.object)].albedo;
  }

  // Ray through the middle of sub-pixel i, bilinear between the rays of the pixel's corners: the
  // distortion bends less than 0.001 px within a pixel.
  Vector2d sub_ray(int r, int c, int i, int grid) const {
    const double v = sub_pixel(i / grid, grid);
    const double u = sub_pixel(i % grid, grid);
    const std::size_t corner = static_cast<std::size_t>(r * (head_.width_ + 1) + c);
    const Vector2d* above = &head_.corner_ray_[corner];
    const Vector2d* below = above + head_.width_ + 1;
    return (1 - v) * ((1 - u) * above[0] + u * above[1]) + v * ((1 - u) * below[0] + u * below[1]);
  }

  const FrameRenderer& head_;
  Eigen::Matrix3d world_from_camera_;  // rotation
  Vector3d camera_in_world_;
  Vector3d laser_in_world_;
  bool laser_on_;
  int traced_ = 0;  // rows above this one are traced
  std::array<std::vector<Surface>, 4> ring_;
  std::vector<double> column_low_;
  std::vector<double> column_high_;
};

namespace {

// Rays through a grid of pixel positions that starts at `first` in both directions.
std::vector<Vector2d> ray_table(const Camera& camera, double first, int cols, int rows) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vector2d> rays;
  rays.reserve(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      rays.push_back(camera.undistort({c + first, r + first}).value_or(Vector2d(nan, nan)));
    }
  }
  return rays;
}

std::uint8_t digitised(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

}  // namespace

FrameRenderer::FrameRenderer(const Scene& scene, const Rig& rig, const SimulateOptions& options)
    : scene_(scene), options_(options), width_(rig.camera.width), height_(rig.camera.height) {
  options.check();
  rig.check();
  fan_ = laser_fan(rig, options);
  centre_ray_ = ray_table(rig.camera, 0.0, width_, height_);
  corner_ray_ = ray_table(rig.camera, -0.5, width_ + 1, height_ + 1);
}

Image<double> FrameRenderer::expected_signal(const RigidTransform& world_from_camera,
                                             bool laser_on) const {
  Image<double> image(height_, width_);
  Pass pass(*this, world_from_camera, laser_on);
  for (int r = 0; r < height_; ++r) pass.shade_row(r, image.row(r));
  return image;
}

Image8 FrameRenderer::render(const RigidTransform& world_from_camera,
                             bool laser_on,
                             std::uint64_t frame) const {
  Image8 image(height_, width_);
  Pass pass(*this, world_from_camera, laser_on);
  std::vector<double> signal(static_cast<std::size_t>(width_));
  const double read_variance = options_.read_noise * options_.read_noise;
  for (int r = 0; r < height_; ++r) {
    pass.shade_row(r, signal.data());
    const std::uint64_t exposure = 2 * frame + (laser_on ? 1 : 0);
    Random random(options_.seed,
                  exposure * static_cast<std::uint64_t>(height_) + static_cast<std::uint64_t>(r));
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
