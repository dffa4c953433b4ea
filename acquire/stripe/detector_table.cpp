// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/centroid.hpp>
#include <facula/acquire/stripe/detector_table.hpp>
#include <facula/acquire/stripe/fir_zero_crossing.hpp>

#include <array>

namespace facula {
namespace {

/// The detectors, by the names people give them.
struct DetectorRow {
  DetectorKind kind;
  const char* name;
  std::unique_ptr<RowDetector> (*make)(const StripeOptions&);
};

constexpr std::array<DetectorRow, 2> kDetectors = {{
    {DetectorKind::kFirZeroCrossing,
     "fir",
     [](const StripeOptions& options) { return make_fir_zero_crossing(options.sigma); }},
    {DetectorKind::kCentroid, "centroid", [](const StripeOptions&) { return make_centroid(); }},
}};

}  // namespace

std::unique_ptr<RowDetector> make_detector(const StripeOptions& options) {
  for (const DetectorRow& row : kDetectors) {
    if (row.kind == options.detector) return row.make(options);
  }
  fail("expected a known stripe detector");
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
