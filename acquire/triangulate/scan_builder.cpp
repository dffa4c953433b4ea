// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/triangulate/scan_builder.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace facula {
namespace {

int rows_of_scan(const Capture& capture) {
  const bool per_row = capture.stripe.direction == StripeDirection::kPerRow;
  return per_row ? capture.rig.camera.height : capture.rig.camera.width;
}

}  // namespace

ScanBuilder::ScanBuilder(const Capture& capture, std::size_t columns, int num_threads)
    : capture_(capture),
      table_(capture.rig, capture.laser, num_threads),
      calibration_(capture.rig, capture.laser) {
  require(capture.stripe.direction == capture.rig.stripe_direction,
          "expected the stripe to be searched along the direction that the rig says");
  const int rows = rows_of_scan(capture);
  require(columns <= static_cast<std::size_t>(std::numeric_limits<int>::max() / rows),
          "expected a scan of fewer than 2^31 cells, got ",
          columns,
          " columns of ",
          rows,
          " rows");
  result_.scan = PolarScan::empty(rows, static_cast<int>(columns));
  result_.scan.world_from_scan = capture.world_from_scan;
  result_.scan.stand = capture.stand;
  placed_.assign(columns, 0);
  noise_.assign(columns, 0);
  if (capture.zero_line) bed_shift_.assign(columns, 0);
}

ScanBuilder::Placed ScanBuilder::place_points(const MeasuredFrame& frame,
                                              const RigidTransform& scan_from_camera) {
  Placed placed;
  const StripeProfile& profile = frame.profile;
  const Eigen::Matrix3d rotation = scan_from_camera.rotation.toRotationMatrix();
  PolarScan& scan = result_.scan;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    const auto across = static_cast<double>(profile.position[r]);
    const auto point =
        table_.at(static_cast<int>(r), across, static_cast<double>(profile.sigma[r]));
    if (!point) {
      ++placed.outside;
      continue;
    }
    const Eigen::Vector3d x = rotation * point->x_in_camera + scan_from_camera.translation;
    if (!capture_.volume.contains(x, point->x_in_camera.z())) {
      ++placed.outside;
      continue;
    }
    const double range = point->x_in_camera.norm();
    const double calibration_variance =
        calibration_.variance(table_.pixel(static_cast<int>(r), across), range, frame.position);
    const auto sigma =
        static_cast<float>(std::sqrt(point->sigma * point->sigma + calibration_variance));
    placed.stripe_sigma.push_back(static_cast<float>(point->sigma));
    placed.calibration_sigma.push_back(static_cast<float>(std::sqrt(calibration_variance)));
    placed.saturated += profile.saturated[r];
    placed.pixel_sigma.push_back(profile.sigma[r]);
    placed.width.push_back(profile.width[r]);
    placed.point_sigma.push_back(sigma);
    const float intensity = std::min(1.0F, profile.amplitude[r] / 255.0F);
    scan.set(scan.index(static_cast<int>(r), static_cast<int>(frame.index)), x, intensity, sigma);
  }
  return placed;
}

void ScanBuilder::place(const MeasuredFrame& frame) {
  const std::size_t i = frame.index;
  require(i < placed_.size() && frame.profile.size() == static_cast<std::size_t>(result_.scan.rows),
          "expected a frame of the scan's ",
          placed_.size(),
          " columns and ",
          result_.scan.rows,
          " rows, got frame ",
          i,
          " of ",
          frame.profile.size(),
          " rows");
  const RigidTransform scan_from_camera = capture_.rig.axis.scan_from_camera_at(frame.position);
  result_.scan.axis_position[i] = frame.position;
  result_.scan.time[i] = frame.time;
  result_.scan.sensor_origin[i] = scan_from_camera.translation;
  const Placed placed = place_points(frame, scan_from_camera);

  const std::lock_guard lock(mutex_);
  placed_[i] = 1;
  noise_[i] = frame.profile.noise;
  if (capture_.zero_line) bed_shift_[i] = frame.bed_shift;
  ++result_.frames;
  result_.rows_searched += frame.profile.size();
  result_.stripes_seen += frame.profile.seen_count();
  result_.outside_volume += placed.outside;
  result_.saturated += placed.saturated;
  for (const float sigma : placed.pixel_sigma) pixel_sigma_.add(sigma);
  for (const float width : placed.width) width_.add(width);
  for (const float sigma : placed.point_sigma) point_sigma_.add(sigma);
  for (const float sigma : placed.stripe_sigma) stripe_sigma_.add(sigma);
  for (const float sigma : placed.calibration_sigma) calibration_sigma_.add(sigma);
}

/// Straight between the placed columns on both sides, as the only one where there is but one.
void ScanBuilder::fill_gaps() {
  PolarScan& scan = result_.scan;
  const auto columns = static_cast<std::ptrdiff_t>(placed_.size());
  std::ptrdiff_t before = -1;
  for (std::ptrdiff_t i = 0; i <= columns; ++i) {
    if (i < columns && placed_[static_cast<std::size_t>(i)] == 0) continue;
    for (std::ptrdiff_t gap = before + 1; gap < i && (before >= 0 || i < columns); ++gap) {
      const auto a = static_cast<std::size_t>(before >= 0 ? before : i);
      const auto b = static_cast<std::size_t>(i < columns ? i : before);
      const double share =
          a == b ? 0 : static_cast<double>(gap - before) / static_cast<double>(i - before);
      const auto c = static_cast<std::size_t>(gap);
      scan.axis_position[c] =
          scan.axis_position[a] + share * (scan.axis_position[b] - scan.axis_position[a]);
      scan.time[c] = scan.time[a] + share * (scan.time[b] - scan.time[a]);
      scan.sensor_origin[c] =
          capture_.rig.axis.scan_from_camera_at(scan.axis_position[c]).translation;
    }
    before = i;
  }
}

ExtractResult ScanBuilder::finish() {
  fill_gaps();
  std::vector<float> noise;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    if (placed_[i] == 0) continue;
    noise.push_back(noise_[i]);
    if (capture_.zero_line) result_.zero_line_shift.push_back(bed_shift_[i]);
  }
  result_.median_noise = static_cast<double>(median(noise));
  result_.median_pixel_sigma = pixel_sigma_.value();
  result_.median_width = width_.value();
  result_.median_point_sigma = point_sigma_.value();
  result_.median_stripe_sigma = stripe_sigma_.value();
  if (calibration_.known()) result_.median_calibration_sigma = calibration_sigma_.value();
  return std::move(result_);
}

}  // namespace facula
