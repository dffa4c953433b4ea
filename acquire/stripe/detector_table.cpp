// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/blais_rioux.hpp>
#include <facula/acquire/stripe/brightest_pixel.hpp>
#include <facula/acquire/stripe/centroid.hpp>
#include <facula/acquire/stripe/detector_table.hpp>
#include <facula/acquire/stripe/fir_zero_crossing.hpp>
#include <facula/acquire/stripe/log_gauss.hpp>
#include <facula/acquire/stripe/steger.hpp>
#include <facula/acquire/stripe/three_point.hpp>
#include <facula/acquire/stripe/threshold_crossings.hpp>

#include <array>

namespace facula {
namespace {

/// The detectors, by the names people give them.
struct DetectorRow {
  DetectorKind kind;
  const char* name;
  std::unique_ptr<RowDetector> (*make)(const StripeOptions&);
};

constexpr std::array<DetectorRow, 13> kDetectors = {{
    {DetectorKind::kFirZeroCrossing,
     "fir",
     [](const StripeOptions& o) { return make_fir_zero_crossing(o.sigma); }},
    {DetectorKind::kCentroid,
     "centroid",
     [](const StripeOptions& o) { return make_centroid(o.sigma); }},
    {DetectorKind::kThresholdCentroid,
     "threshold-centroid",
     [](const StripeOptions& o) { return make_threshold_centroid(o.sigma, o.min_amplitude); }},
    {DetectorKind::kBrightestPixel,
     "brightest",
     [](const StripeOptions& o) { return make_brightest_pixel(o.sigma); }},
    {DetectorKind::kMaximumThreshold,
     "maximum",
     [](const StripeOptions& o) { return make_maximum_threshold(o.sigma, o.min_amplitude); }},
    {DetectorKind::kOneThreshold,
     "one-threshold",
     [](const StripeOptions& o) { return make_one_threshold(o.sigma); }},
    {DetectorKind::kTwoThresholds,
     "two-thresholds",
     [](const StripeOptions& o) { return make_two_thresholds(o.sigma); }},
    {DetectorKind::kParabola,
     "parabola",
     [](const StripeOptions& o) { return make_parabola(o.sigma); }},
    {DetectorKind::kGauss, "gauss", [](const StripeOptions& o) { return make_gauss(o.sigma); }},
    {DetectorKind::kLogGauss,
     "log-gauss",
     [](const StripeOptions& o) { return make_log_gauss(o.sigma); }},
    {DetectorKind::kBlaisRioux4,
     "blais-rioux-4",
     [](const StripeOptions& o) { return make_blais_rioux(o.sigma, 4); }},
    {DetectorKind::kBlaisRioux8,
     "blais-rioux-8",
     [](const StripeOptions& o) { return make_blais_rioux(o.sigma, 8); }},
    {DetectorKind::kSteger, "steger", [](const StripeOptions& o) { return make_steger(o.sigma); }},
}};

}  // namespace

std::unique_ptr<RowDetector> make_detector(const StripeOptions& options) {
  for (const DetectorRow& row : kDetectors) {
    if (row.kind == options.detector) return row.make(options);
  }
  fail("expected a known stripe detector");
}

std::vector<std::string> detector_names() {
  std::vector<std::string> names;
  names.reserve(kDetectors.size());
  for (const DetectorRow& row : kDetectors) names.emplace_back(row.name);
  return names;
}

DetectorKind detector_from_name(const std::string& name) {
  std::string all;
  for (const DetectorRow& row : kDetectors) {
    if (name == row.name) return row.kind;
    all += std::string(all.empty() ? "" : ", ") + row.name;
  }
  fail("expected a stripe detector (", all, "), got '", name, "'");
}

std::string to_string(DetectorKind kind) {
  for (const DetectorRow& row : kDetectors) {
    if (row.kind == kind) return row.name;
  }
  return "fir";
}

}  // namespace facula
