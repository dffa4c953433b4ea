// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where each term of the image comes from (docs/simulated_head.md derives them at length)
//
// The signal of a pixel is the mean, over the pixel's area, of the light that the surface point
// behind each spot of that area sends to the camera. Surfaces are Lambertian: their radiance, and
// with it the signal, does not depend on where the camera stands, only on the light they receive.
//
//   ambient   comes alike from all sides and is not shadowed, so a surface of albedo a gives a * A
//             whatever its pose (A: SimulateOptions::ambient). A turntable may therefore be
//             rendered by turning the head about the still object.
//   laser     leaves one point L and is a fan in the sheet n . x = d, which may bow into a cone. At
//             distance r from L its power has spread along the fan in proportion to r and across
//             the sheet over a Gaussian of standard deviation w(r) = w0 + theta r, or that of a
//             Gaussian beam, whose peak is proportional to 1 / w(r) as the power across stays what
//             it was. A surface that the light meets at an angle gets the cosine of it (Lambert).
//             At distance s from the middle of the sheet
//               E = P (1 m / r)^p (w(1 m) / w(r)) cos(angle) exp(-s^2 / (2 w(r)^2))
//             and a * E is the signal, where the straight way from the point to L is free; p = 1 is
//             the fan's own spreading, a smaller p stands for a sensor that compresses or a head
//             that adapts its exposure (SimulateOptions::exposure_falloff).
//   mirrors   show the scene once more, and light it once more from the image of the laser.
//   lens      spreads the light, speckle makes the laser's part grainy, corners get less.
//   sensor    electrons arrive as a Poisson process: the signal S has variance g S (g in DN per
//             DN, shot_noise), and reading adds read_noise^2; both are drawn as one normal number
//             of variance read_noise^2 + g S, which is close for more than about 10 electrons.
//             Black level is added, the sum rounded and clipped to 0..255.
//
// The integral over the pixel is a regular 4 x 4 midpoint rule where light of the sheet can come
// in: it places a Gaussian line of sigma >= 1 px to better than 0.005 px (a test holds it to that).
// A thinner line's Gaussian is averaged over each of the 16 spots (error functions), and under a
// lens that blurs the spots keep their places (laser_layer.hpp).
// Left out: light that is scattered twice, and things that are so thin (under one pixel; under two,
// away from the sheet) that no ray meets them.
#include <facula/acquire/simulate/frame_renderer.hpp>
#include <facula/acquire/simulate/lens.hpp>
#include <facula/acquire/simulate/light_pass.hpp>
#include <facula/acquire/simulate/mirror_view.hpp>
#include <facula/acquire/simulate/sensor.hpp>
#include <facula/acquire/simulate/speckle_field.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace facula {
namespace {

constexpr std::uint64_t kAfterStream = std::numeric_limits<std::uint64_t>::max() / 4;

void add_laser(Image<double>& image, const Image<double>& laser, const Eigen::Vector3d& response) {
  double* out = image.pixels.data();
  for (const double light : laser.pixels) {
    for (int k = 0; k < image.channels; ++k) *out++ += response[k] * light;
  }
}

}  // namespace

FrameRenderer::FrameRenderer(const Scene& scene, const Rig& rig, const SimulateOptions& options)
    : scene_(scene),
      options_(options),
      fans_(lit_fans(rig, options)),
      rays_(rig.camera),
      objects_(object_lights(scene, options)),
      mirrors_(mirror_faces(scene)) {}

FrameRenderer::Light FrameRenderer::gather(const RigidTransform& world_from_camera,
                                           bool laser_on) const {
  const int channels = options_.colour_frames ? 3 : 1;
  Light light{{rays_.height(), rays_.width(), channels}, {}};
  if (laser_on) light.laser = {rays_.height(), rays_.width(), options_.lens};
  const LightSetting setting{scene_, rays_, objects_, world_from_camera};
  std::vector<LightPath> paths;
  if (laser_on) paths = light_paths(fans_, mirrors_, world_from_camera);
  LightPass first(setting, paths.empty() ? nullptr : &paths.front());
  const MirrorView mirror_view(setting, paths);
  for (int r = 0; r < rays_.height(); ++r) {
    double* ambient = light.ambient.row(r);
    first.add_row(r, channels, ambient, light.laser);
    for (int c = 0; c < rays_.width() && !mirrors_.empty(); ++c) {
      if (first.shows_mirror(r, c)) {
        mirror_view.add_pixel(r, c, channels, ambient + c * channels, light.laser);
      }
    }
  }
  for (std::size_t i = 1; i < paths.size(); ++i) {
    LightPass pass(setting, &paths[i]);
    for (int r = 0; r < rays_.height(); ++r) pass.add_row(r, channels, nullptr, light.laser);
  }
  return light;
}

double FrameRenderer::time_of(const Exposure& exposure) const {
  const std::uint64_t before = options_.background_frames ? 1 : 0;
  const std::uint64_t after = options_.second_background ? 1 : 0;
  const std::uint64_t place = exposure.laser_on ? before : exposure.after ? before + 1 : 0;
  const auto number = static_cast<double>(exposure.step * (1 + before + after) + place);
  return number * options_.timing.frame_interval;
}

// The light of the mains, averaged over the exposure: its swing shrinks by sinc(f T).
void FrameRenderer::flicker(Image<double>& ambient, const Exposure& exposure) const {
  const MainsFlicker& mains = options_.flicker;
  if (mains.depth == 0) return;
  const double turn = std::numbers::pi * mains.frequency * options_.timing.exposure_time;
  const double swing = mains.depth * (turn == 0 ? 1.0 : std::sin(turn) / turn);
  const double start = time_of(exposure);
  for (int r = 0; r < ambient.rows; ++r) {
    const double t = start + r * options_.timing.row_time;
    const double level =
        1 + swing * std::cos(2 * std::numbers::pi * mains.frequency * t + mains.phase);
    double* row = ambient.row(r);
    for (std::ptrdiff_t i = 0; i < ambient.stride(); ++i) row[i] *= level;
  }
}

Image<double> FrameRenderer::expected_signal(const RigidTransform& world_from_camera,
                                             const Exposure& exposure) const {
  Light light = gather(world_from_camera, exposure.laser_on);
  flicker(light.ambient, exposure);
  spread_light(light.ambient, options_.lens);
  if (exposure.laser_on) {
    Image<double> laser = std::move(light.laser).spread();
    if (options_.speckle) {
      const std::uint64_t seed = speckle_seed(options_.seed, world_from_camera);
      apply_speckle(laser, *options_.speckle, seed);
    }
    add_laser(light.ambient, laser, laser_response(options_));
  }
  vignette(light.ambient, rays_, options_.lens.vignetting);
  return std::move(light.ambient);
}

Image<double> FrameRenderer::expected_signal(const RigidTransform& world_from_camera,
                                             bool laser_on) const {
  return expected_signal(world_from_camera, Exposure{.laser_on = laser_on});
}

Image8 FrameRenderer::render(const RigidTransform& world_from_camera,
                             const Exposure& exposure) const {
  const std::uint64_t number =
      2 * exposure.step + (exposure.laser_on ? 1 : 0) + (exposure.after ? kAfterStream : 0);
  return sensed(expected_signal(world_from_camera, exposure), options_, number);
}

Image8 FrameRenderer::render(const RigidTransform& world_from_camera,
                             bool laser_on,
                             std::uint64_t frame) const {
  return render(world_from_camera, Exposure{.laser_on = laser_on, .step = frame});
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
