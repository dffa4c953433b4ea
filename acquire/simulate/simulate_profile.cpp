// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/simulate/sheet_tracer.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr std::uint64_t kProfileStream = std::numeric_limits<std::uint64_t>::max() / 2;

}  // namespace

StripeProfile simulate_profile(const Scene& scene,
                               const Rig& rig,
                               const RigidTransform& world_from_camera,
                               std::uint64_t frame,
                               const SimulateOptions& options) {
  const LaserFan fan = laser_fan(rig, options);
  SheetTracer tracer(scene, rig, fan, options.laser_colour);
  tracer.place(world_from_camera);
  const std::vector<std::optional<FanHit>> hits = tracer.trace();
  const bool per_row = rig.stripe_direction == StripeDirection::kPerRow;
  const double focal_length = per_row ? rig.camera.fx : rig.camera.fy;
  StripeProfile profile = StripeProfile::none(hits.size());
  profile.noise = static_cast<float>(options.read_noise);
  Random random(options.seed, kProfileStream + frame);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double error = options.stripe_noise * random.normal();  // also drawn for unseen rows
    if (!hits[i]) continue;
    const double position = per_row ? hits[i]->pixel.x() : hits[i]->pixel.y();
    const double signal = tracer.brightness(*hits[i]);
    profile.seen[i] = 1;
    profile.position[i] = static_cast<float>(position + error);
    profile.sigma[i] = static_cast<float>(options.stripe_noise);
    profile.amplitude[i] = static_cast<float>(std::min(signal, 255.0));
    profile.saturated[i] = signal > 255 ? 1 : 0;
    profile.width[i] = static_cast<float>(
        std::hypot(line_sigma(fan, focal_length, hits[i]->x), options.lens.blur));
  }
  return profile;
}

}  // namespace facula
