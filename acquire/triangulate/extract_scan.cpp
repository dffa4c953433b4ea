// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>
#include <facula/acquire/triangulate/zero_line.hpp>

#include <algorithm>
#include <mutex>

namespace facula {
namespace {

/// What one frame adds to the figures of the capture.
struct FrameFigures {
  std::size_t seen = 0;
  std::size_t outside = 0;
  std::size_t saturated = 0;
  float noise = 0;
  double shift = 0;
  std::vector<float> pixel_sigmas;
  std::vector<float> widths;
  std::vector<float> point_sigmas;
};

void check_capture(const Capture& capture, std::size_t frames) {
  require(frames == capture.positions.size() && frames > 0,
          "expected one axis position per frame, got ",
          capture.positions.size(),
          " positions for ",
          frames,
          " frames");
  require(capture.laser < capture.rig.light_count(),
          "expected a lit laser below ",
          capture.rig.light_count(),
          ", the number in the rig, got ",
          capture.laser);
  require(capture.stripe.direction == capture.rig.stripe_direction,
          "expected the stripe to be searched along the direction that the rig says");
  require(!capture.zero_line || capture.zero_line->frames.size() == frames,
          "expected one zero_line frame per frame, got ",
          capture.zero_line ? capture.zero_line->frames.size() : 0,
          " for ",
          frames);
}

void check_frame(const Image8& frame, const Capture& capture, std::size_t i) {
  const Camera& camera = capture.rig.camera;
  require(frame.cols == camera.width && frame.rows == camera.height,
          "frame ",
          i,
          ": expected ",
          camera.width,
          " x ",
          camera.height,
          " px as the rig's camera says, got ",
          frame.cols,
          " x ",
          frame.rows);
}

double move_onto_bed(const Capture& capture, std::size_t i, StripeProfile& profile) {
  const ZeroLine& zero_line = *capture.zero_line;
  const Image8 bed = read_image(zero_line.frames[i]);
  check_frame(bed, capture, i);
  try {
    return measure_against_bed(zero_line, detect_stripe(bed.view(), {}, capture.stripe), profile);
  } catch (const Error& error) {
    fail("frame ", i, " against '", zero_line.frames[i].string(), "': ", error.what());
  }
}

StripeProfile stripe_of_frame(const Capture& capture,
                              const CaptureFrames& frames,
                              std::size_t i,
                              FrameFigures& figures) {
  const Image8 lit = frames.lit(i);
  check_frame(lit, capture, i);
  StripeProfile profile = detect_stripe(lit.view(), frames.dark(i).view(), capture.stripe);
  if (capture.zero_line) figures.shift = move_onto_bed(capture, i, profile);
  figures.seen = profile.seen_count();
  figures.noise = profile.noise;
  return profile;
}

/// One column of the scan: every stripe position becomes a point, or is dropped and counted.
void place_column(const Capture& capture,
                  const StripeProfile& profile,
                  std::size_t i,
                  PolarScan& scan,
                  FrameFigures& figures) {
  const RigidTransform scan_from_camera =
      capture.rig.axis.scan_from_camera_at(capture.positions[i]);
  scan.axis_position[i] = capture.positions[i];
  scan.time[i] = static_cast<double>(i) * capture.frame_interval;
  scan.sensor_origin[i] = scan_from_camera.translation;
  const bool per_row = capture.stripe.direction == StripeDirection::kPerRow;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    const double along = static_cast<double>(r);
    const double across = static_cast<double>(profile.position[r]);
    const Eigen::Vector2d pixel =
        per_row ? Eigen::Vector2d(across, along) : Eigen::Vector2d(along, across);
    const auto point =
        triangulate(capture.rig, capture.laser, pixel, static_cast<double>(profile.sigma[r]));
    const Eigen::Vector3d x_in_scan =
        point ? scan_from_camera * point->x_in_camera : Eigen::Vector3d::Zero();
    if (!point || !capture.volume.contains(x_in_scan, point->x_in_camera.z())) {
      ++figures.outside;
      continue;
    }
    figures.saturated += profile.saturated[r];
    figures.pixel_sigmas.push_back(profile.sigma[r]);
    figures.widths.push_back(profile.width[r]);
    figures.point_sigmas.push_back(static_cast<float>(point->sigma));
    scan.set(scan.index(static_cast<int>(r), static_cast<int>(i)),
             x_in_scan,
             std::min(1.0F, profile.amplitude[r] / 255.0F),
             static_cast<float>(point->sigma));
  }
}

double median_of(const std::vector<FrameFigures>& figures,
                 const std::vector<float> FrameFigures::*values) {
  std::vector<float> all;
  for (const FrameFigures& f : figures) {
    all.insert(all.end(), (f.*values).begin(), (f.*values).end());
  }
  return static_cast<double>(median(all));
}

void sum_up(const Capture& capture, std::vector<FrameFigures>& figures, ExtractResult& result) {
  std::vector<float> noises;
  for (const FrameFigures& f : figures) {
    result.stripes_seen += f.seen;
    result.outside_volume += f.outside;
    result.saturated += f.saturated;
    noises.push_back(f.noise);
    if (capture.zero_line) result.zero_line_shift.push_back(f.shift);
  }
  result.median_noise = static_cast<double>(median(noises));
  result.median_pixel_sigma = median_of(figures, &FrameFigures::pixel_sigmas);
  result.median_width = median_of(figures, &FrameFigures::widths);
  result.median_point_sigma = median_of(figures, &FrameFigures::point_sigmas);
}

}  // namespace

ExtractResult extract_scan(const Capture& capture, const ExtractOptions& options) {
  const CaptureFrames frames(capture);
  check_capture(capture, frames.size());
  const bool per_row = capture.stripe.direction == StripeDirection::kPerRow;
  const int rows = per_row ? capture.rig.camera.height : capture.rig.camera.width;

  ExtractResult result;
  result.frames = frames.size();
  result.rows_searched = frames.size() * static_cast<std::size_t>(rows);
  result.scan = PolarScan::empty(rows, static_cast<int>(frames.size()));
  result.scan.world_from_scan = capture.world_from_scan;

  std::vector<FrameFigures> figures(frames.size());
  std::mutex progress_mutex;
  std::size_t done = 0;
  const auto extract_frame = [&](std::size_t i, std::size_t) {
    const StripeProfile profile = stripe_of_frame(capture, frames, i, figures[i]);
    place_column(capture, profile, i, result.scan, figures[i]);
    const std::lock_guard lock(progress_mutex);
    if (options.progress) options.progress(++done, frames.size());
  };
  parallel_for(frames.size(), extract_frame, {.num_threads = options.num_threads, .chunk = 1});
  sum_up(capture, figures, result);
  return result;
}

}  // namespace facula
