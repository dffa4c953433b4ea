// SPDX-License-Identifier: GPL-3.0-or-later
//
// Planes and spheres at several distances and incidences, as images of the simulated head: every
// point's error along its ray over its own sigma.
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/frame_renderer.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>
#include <facula/tests/bench/accuracy/studies.hpp>
#include <facula/tests/bench/accuracy/thin_line.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

namespace facula {
namespace {

constexpr double kSteepest = 75 * std::numbers::pi / 180;

Scene plane_scene(double distance, double turn) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()).toRotationMatrix();
  SceneObject slab;
  slab.name = "plane";
  slab.shape = BoxShape{{40, 40, 0.2}};
  slab.albedo = 0.8;
  slab.world_from_object.rotation = Eigen::Quaterniond(rotation);
  slab.world_from_object.translation =
      Eigen::Vector3d(0, 0, distance) + rotation * Eigen::Vector3d(0, 0, 0.1);
  return Scene({slab});
}

Scene sphere_scene(double distance, double radius) {
  SceneObject ball;
  ball.name = "sphere";
  ball.shape = SphereShape{radius};
  ball.albedo = 0.8;
  ball.world_from_object.translation = {0, 0, distance};
  return Scene({ball});
}

/// Whether the camera, at the origin, sees the surface at x no more slantingly than 75 degrees.
bool seen_well(const Scene& scene, const Eigen::Vector3d& x) {
  const auto hit = scene.first_hit(Eigen::Vector3d::Zero(), x.normalized());
  return hit && std::abs(hit->normal.dot(x.normalized())) > std::cos(kSteepest);
}

struct Honesty {
  std::size_t points = 0;
  double chi2 = 0;
  double rms = 0;           ///< error along the ray [m]
  double median_sigma = 0;  ///< [m]
  double beyond_4 = 0;      ///< share of points beyond 4 sigma [1]
};

Honesty measure(const Rig& rig, const Scene& scene, const SimulateOptions& options, int frames) {
  const FrameRenderer renderer(scene, rig, options);
  Rig still = rig;
  still.axis = {};
  const PolarScan truth = true_scan(scene, still, {}, {0.0}, options);
  StripeOptions stripe;
  stripe.channel = Channel::kGrey;
  stripe.direction = rig.stripe_direction;
  std::vector<double> sigmas;
  Honesty h;
  for (int i = 0; i < frames; ++i) {
    const Image8 lit = renderer.render({}, true, static_cast<std::uint64_t>(i));
    const StripeProfile profile = detect_stripe(lit.view(), {}, stripe);
    for (std::size_t r = 0; r < profile.size(); ++r) {
      if (profile.seen[r] == 0) continue;
      const Eigen::Vector2d pixel(profile.position[r], static_cast<double>(r));
      const auto point = triangulate(rig, 0, pixel, static_cast<double>(profile.sigma[r]));
      if (!point) continue;
      const std::size_t cell = truth.index(static_cast<int>(r), 0);
      if (truth.valid[cell] == 0) continue;
      const Eigen::Vector3d x = truth.point[cell].cast<double>();
      if (!seen_well(scene, x)) continue;
      const double error = (point->x_in_camera - x).dot(x.normalized());
      const double z = error / point->sigma;
      h.chi2 += z * z;
      h.rms += error * error;
      h.beyond_4 += std::abs(z) > 4 ? 1 : 0;
      sigmas.push_back(point->sigma);
    }
  }
  h.points = sigmas.size();
  if (sigmas.empty()) return h;
  const auto n = static_cast<double>(sigmas.size());
  std::nth_element(sigmas.begin(), sigmas.begin() + sigmas.size() / 2, sigmas.end());
  h.median_sigma = sigmas[sigmas.size() / 2];
  h.chi2 /= n;
  h.beyond_4 /= n;
  h.rms = std::sqrt(h.rms / n);
  return h;
}

struct Case {
  std::string name;
  Scene scene;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const double distance : {0.6, 1.0, 2.0, 3.0, 4.0}) {
    for (const double degrees : {0.0, 30.0, 60.0, -60.0}) {
      cases.push_back(
          {"plane at " + decimals(distance, 1) + " m, turned " + decimals(degrees, 0) + " degrees",
           plane_scene(distance, degrees * std::numbers::pi / 180)});
    }
  }
  for (const double distance : {0.8, 1.5, 3.0}) {
    const double radius = 0.15 * distance;
    cases.push_back(
        {"sphere of " + decimals(1000 * radius, 0) + " mm at " + decimals(distance, 1) + " m",
         sphere_scene(distance, radius)});
  }
  return cases;
}

std::vector<Honesty> run_cases(const std::vector<Case>& cases,
                               const Rig& rig,
                               const SimulateOptions& light,
                               int frames,
                               bool exposed) {
  std::vector<Honesty> results(cases.size());
  const auto one = [&](std::size_t i, std::size_t) {
    SimulateOptions own = light;
    if (exposed) expose(own, cases[i].scene, rig, {RigidTransform{}});
    results[i] = measure(rig, cases[i].scene, own, frames);
  };
  parallel_for(cases.size(), one, {.chunk = 1});
  return results;
}

void add_table(Study& study,
               const std::vector<Honesty>& results,
               const std::vector<Case>& cases,
               const std::string& claim) {
  StudyTable table;
  table.caption = claim.substr(claim.rfind(": ") + 2) + ".";
  table.columns = {
      "target", "points", "RMS error [mm]", "median sigma [mm]", "reduced χ²", "beyond 4 sigma"};
  double low = 1e9;
  double high = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Honesty& h = results[i];
    if (h.points < 200) continue;  // χ² of fewer spreads by more than 0.1
    low = std::min(low, h.chi2);
    high = std::max(high, h.chi2);
    table.rows.push_back({cases[i].name,
                          std::to_string(h.points),
                          decimals(1000 * h.rms, 3),
                          decimals(1000 * h.median_sigma, 3),
                          decimals(h.chi2, 2),
                          decimals(100 * h.beyond_4, 2) + " %"});
  }
  study.tables.push_back(std::move(table));
  study.verdicts.push_back(
      {claim, decimals(low, 2) + " to " + decimals(high, 2), low >= 0.8 && high <= 1.2});
}

}  // namespace

Study study_sigma(const StudyOptions& options) {
  const Rig rig = read_rig(options.data / "rigs/head_fs1500.toml");
  const int frames = options.small ? 1 : 12;
  const std::vector<Case> cases = all_cases();
  SimulateOptions clean = thin_line_light(rig, 1.5);
  clean.seed = options.seed;
  SimulateOptions noisy = clean;
  noisy.read_noise = noise_for(0.1);
  SimulateOptions wide = options_for(rig);
  wide.seed = options.seed;

  Study study;
  study.title = "Is every point's sigma honest?";
  study.paragraphs = {
      "Images of the head f·s = 1500 mm². A point's error is its distance from the true point of "
      "its "
      "image row, taken along the ray, over the sigma the point carries; all points seen, rays up "
      "to "
      "75 degrees off the normal. χ² over the degrees of freedom is 1 for an honest sigma. A sheet "
      "of light as wide as the last table's reaches surfaces of different depth at once; on a ball "
      "of 120 mm that moves the middle of what is seen by more than the noise, which no sigma of a "
      "single row can know."};
  const std::string claim = "reduced χ² of planes and spheres between 0.8 and 1.2: ";
  add_table(study,
            run_cases(cases, rig, noisy, frames, true),
            cases,
            claim + "line of 1 mm, exposed to 150 DN, noise of 0.1 px (11.3 DN)");
  add_table(study,
            run_cases(cases, rig, clean, frames, false),
            cases,
            claim + "line of 1 mm, webcam noise (1.5 DN)");
  add_table(study,
            run_cases(cases, rig, wide, frames, false),
            cases,
            claim + "sheet of 3 to 9 mm, webcam noise (1.5 DN)");
  return study;
}

}  // namespace facula
