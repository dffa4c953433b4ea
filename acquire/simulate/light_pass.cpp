// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/light_pass.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFaintest = 1e-6;  // of the sheet's middle, taken as dark
constexpr int kEdgeGrid = 2;        // sub-pixels each way where only ambient light changes
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Mean of exp(-u^2 / 2) over u = off - width / 2 ... off + width / 2. Below half a standard
// deviation the middle is as good: the rule of rectangles converges faster than any power.
double mean_gaussian(double off, double width) {
  if (width < 0.5) return std::exp(-0.5 * off * off);
  const double a = (off - 0.5 * width) / std::numbers::sqrt2;
  const double b = (off + 0.5 * width) / std::numbers::sqrt2;
  return std::sqrt(std::numbers::pi / 2) / width * (std::erf(b) - std::erf(a));
}

}  // namespace

LightPass::LightPass(const LightSetting& setting, const LightPath* path)
    : setting_(setting),
      path_(path),
      surfaces_(setting.scene,
                setting.rays,
                setting.world_from_camera,
                path != nullptr ? &path->fan : nullptr),
      column_low_(static_cast<std::size_t>(setting.rays.width())),
      column_high_(static_cast<std::size_t>(setting.rays.width())) {}

void LightPass::add_row(int r, int channels, double* ambient, LaserLayer& laser) {
  surfaces_.advance_to(r);
  if (path_ != nullptr) find_reach(r);
  for (int c = 0; c < setting_.rays.width(); ++c) {
    Vector3d here = Vector3d::Zero();
    if (path_ != nullptr && near_sheet(c)) {
      add_near_sheet(r, c, here, laser);
    } else if (ambient != nullptr) {
      here = ambient_at(r, c);
    }
    if (ambient == nullptr) continue;
    for (int k = 0; k < channels; ++k) *ambient++ += here[k];
  }
}

bool LightPass::shows_mirror(int r, int c) {
  return !surfaces_.neighbours_all(r, c, [&](const Surface& s) {
    return s.object < 0 || setting_.objects[static_cast<std::size_t>(s.object)].mirror == 0;
  });
}

// Per column the span of the sheet's distance over rows r - 1 to r + 1.
void LightPass::find_reach(int r) {
  std::fill(column_low_.begin(), column_low_.end(), kInfinity);
  std::fill(column_high_.begin(), column_high_.end(), -kInfinity);
  for (int y = std::max(r - 1, 0); y <= std::min(r + 1, setting_.rays.height() - 1); ++y) {
    const std::vector<Surface>& surfaces = surfaces_.row(y);
    for (std::size_t c = 0; c < surfaces.size(); ++c) {
      column_low_[c] = std::min(column_low_[c], surfaces[c].low);
      column_high_[c] = std::max(column_high_[c], surfaces[c].high);
    }
  }
}

// Whether any spot of the pixel can get light of the sheet: the sheet, with its reach, passes
// between the pixel's neighbours or touches one of them.
bool LightPass::near_sheet(int c) const {
  double low = kInfinity;
  double high = -kInfinity;
  for (int x = std::max(c - 1, 0); x <= std::min(c + 1, setting_.rays.width() - 1); ++x) {
    low = std::min(low, column_low_[static_cast<std::size_t>(x)]);
    high = std::max(high, column_high_[static_cast<std::size_t>(x)]);
  }
  return low <= 0 && high >= 0;
}

bool LightPass::at_edge(int r, int c) const {
  const auto i = static_cast<std::size_t>(c);
  const Surface* here = surfaces_.row(r).data() + i;
  const int object = here->object;
  if (c > 0 && here[-1].object != object) return true;
  if (c < setting_.rays.width() - 1 && here[1].object != object) return true;
  if (r > 0 && surfaces_.row(r - 1)[i].object != object) return true;
  return r < setting_.rays.height() - 1 && surfaces_.row(r + 1)[i].object != object;
}

Vector3d LightPass::ambient_at(int r, int c) const {
  if (!at_edge(r, c)) return ambient_of(surfaces_.row(r)[static_cast<std::size_t>(c)]);
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < kEdgeGrid * kEdgeGrid; ++i) {
    sum += ambient_of(surfaces_.cast(setting_.rays.within(r, c, i, kEdgeGrid)));
  }
  return sum / (kEdgeGrid * kEdgeGrid);
}

void LightPass::add_near_sheet(int r, int c, Vector3d& ambient, LaserLayer& laser) {
  const Surface& centre = surfaces_.at(r, c);
  const bool plane =
      surfaces_.neighbours_all(r, c, [&](const Surface& s) { return same_plane(s, centre); });
  const bool bend =
      !plane && is_convex(centre) &&
      surfaces_.neighbours_all(r, c, [&](const Surface& s) { return same_bend(s, centre); });
  const SpotLight light = plane || bend ? common_light(r, c) : SpotLight::kUnknown;
  std::array<Surface, kLaserSpots> spots;
  for (int i = 0; i < kLaserSpots; ++i) {
    const Vector2d ray = setting_.rays.within(r, c, i, kLaserGrid);
    Surface& spot = spots[static_cast<std::size_t>(i)];
    spot = plane  ? surfaces_.on_plane(centre, ray)
           : bend ? surfaces_.cast_on(centre.object, ray)
                  : surfaces_.cast(ray);
    spot.light = light;
    if (!plane && !bend) ambient += ambient_of(spot) / kLaserSpots;
  }
  if (plane || bend) ambient = ambient_of(centre);
  const std::array<double, kLaserSpots> light_of = laser_over(spots);
  for (int i = 0; i < kLaserSpots; ++i) {
    const int column = i % kLaserGrid;
    const int row = i / kLaserGrid;
    const double across = (column + 0.5) / kLaserGrid - 0.5;
    const double down = (row + 0.5) / kLaserGrid - 0.5;
    laser.add(r, c, across, down, light_of[static_cast<std::size_t>(i)] / kLaserSpots);
  }
}

// Signal of the spots of a pixel. A spot is as wide as a quarter of the pixel; where the line
// is thinner than that, its Gaussian is averaged over the spot instead of taken in the middle.
std::array<double, LightPass::kLaserSpots> LightPass::laser_over(
    std::array<Surface, kLaserSpots>& spots) const {
  std::array<double, kLaserSpots> off{};  // from the sheet's middle in its standard deviations
  for (std::size_t i = 0; i < spots.size(); ++i) {
    off[i] = spots[i].object < 0 ? 0 : path_->fan.standard_deviations(spots[i].x);
  }
  constexpr std::size_t kGrid = kLaserGrid;
  const auto step = [&](std::size_t i, std::size_t place, std::size_t stride) {
    const std::size_t other = place > 0 ? i - stride : i + stride;
    return spots[i].object == spots[other].object ? off[i] - off[other] : 0.0;
  };
  std::array<double, kLaserSpots> signal{};
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const double width = std::hypot(step(i, i % kGrid, 1), step(i, i / kGrid, kGrid));
    signal[i] = laser_signal(spots[i], off[i], width);
  }
  return signal;
}

bool LightPass::is_convex(const Surface& s) const {
  return s.object >= 0 && !std::holds_alternative<MeshShape>(
                              setting_.scene.objects()[static_cast<std::size_t>(s.object)].shape);
}

// Whether the pixel and its neighbours in the light's reach all see the laser or all do not;
// unknown when they differ.
SpotLight LightPass::common_light(int r, int c) {
  Surface& centre = surfaces_.at(r, c);
  if (!centre.in_reach()) return SpotLight::kUnknown;
  const SpotLight light = light_at(centre);
  const auto agrees = [&](Surface& s) { return !s.in_reach() || light_at(s) == light; };
  return surfaces_.neighbours_all(r, c, agrees) ? light : SpotLight::kUnknown;
}

SpotLight LightPass::light_at(Surface& spot) const {
  if (spot.light == SpotLight::kUnknown && spot.object >= 0) {
    const bool open = path_->open(setting_.scene, surfaces_.in_world(spot.x));
    spot.light = open ? SpotLight::kFree : SpotLight::kBlocked;
  }
  return spot.light;
}

const Vector3d& LightPass::ambient_of(const Surface& spot) const {
  static const Vector3d none = Vector3d::Zero();
  return spot.object < 0 ? none : setting_.objects[static_cast<std::size_t>(spot.object)].ambient;
}

double LightPass::laser_signal(Surface& spot, double off, double width) const {
  if (spot.object < 0) return 0;
  const double brightness = mean_gaussian(off, width);
  if (brightness < kFaintest) return 0;
  const double share = setting_.objects[static_cast<std::size_t>(spot.object)].laser_share;
  const double signal =
      path_->share() * share * brightness * path_->fan.middle_signal(spot.x, spot.normal);
  return signal > 0 && light_at(spot) == SpotLight::kFree ? signal : 0.0;
}

}  // namespace facula
