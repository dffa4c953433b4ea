// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/triangulate/binned_median.hpp>
#include <facula/acquire/triangulate/calibration_sigma.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/acquire/triangulate/measured_frame.hpp>
#include <facula/acquire/triangulate/sheet_table.hpp>

#include <cstddef>
#include <mutex>
#include <vector>

namespace facula {

/// Makes a scan of measured frames, whatever they were measured from: every stripe position becomes
/// a point, or is dropped and counted.
class ScanBuilder {
 public:
  /// Rig, lit laser, volume and pose are the capture's. Throws Error when it contradicts itself.
  ScanBuilder(const Capture& capture, std::size_t columns, int num_threads);

  /// Fills the frame's column. Several threads may place different frames at once; the scan does
  /// not depend on their order.
  void place(const MeasuredFrame& frame);

  /// The scan and its figures. Columns that no frame was placed in stay empty; their axis position
  /// and time lie between those of their neighbours.
  ExtractResult finish();

 private:
  struct Placed {
    std::size_t outside = 0;
    std::size_t saturated = 0;
    std::vector<float> pixel_sigma;
    std::vector<float> width;
    std::vector<float> point_sigma;
    std::vector<float> stripe_sigma;
    std::vector<float> calibration_sigma;
  };

  Placed place_points(const MeasuredFrame& frame, const RigidTransform& scan_from_camera);
  void fill_gaps();

  const Capture& capture_;
  SheetTable table_;
  CalibrationSigma calibration_;
  ExtractResult result_;
  std::vector<std::uint8_t> placed_;
  std::vector<float> noise_;
  std::vector<double> bed_shift_;
  std::mutex mutex_;
  BinnedMedian pixel_sigma_;
  BinnedMedian width_;
  BinnedMedian point_sigma_;
  BinnedMedian stripe_sigma_;
  BinnedMedian calibration_sigma_;
};

}  // namespace facula
