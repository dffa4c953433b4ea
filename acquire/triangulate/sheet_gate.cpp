// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/triangulate/sheet_gate.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr int kStep = 16;  // columns between two looks; bounds are then found to the pixel [px]

/// Leaves the bounds that do not depend on where the axis stands.
void keep_lasting(WorkVolume& volume, const Capture& capture) {
  if (capture.rig.axis.kind != AxisKind::kLinear) return;
  volume.max_radius.reset();
  volume.min_z.reset();
  volume.max_z.reset();
}

bool bounds_something(const WorkVolume& volume) {
  return volume.max_radius || volume.min_z || volume.max_z || volume.min_depth || volume.max_depth;
}

/// Tells whether the sheet seen in a pixel is within the volume.
class SheetInVolume {
 public:
  explicit SheetInVolume(const Capture& capture)
      : capture_(capture),
        volume_(capture.volume),
        scan_from_camera_(capture.rig.axis.scan_from_camera_at(0)) {
    keep_lasting(volume_, capture);
  }

  bool allows(int row, int column) const {
    const bool per_row = capture_.rig.stripe_direction == StripeDirection::kPerRow;
    const Eigen::Vector2d pixel =
        per_row ? Eigen::Vector2d(column, row) : Eigen::Vector2d(row, column);
    const auto point = triangulate(capture_.rig, capture_.laser, pixel, 0);
    return point &&
           volume_.contains(scan_from_camera_ * point->x_in_camera, point->x_in_camera.z());
  }

  /// The column nearest to `outside` that is allowed; `inside` is.
  int bound(int row, int inside, int outside) const {
    while (std::abs(outside - inside) > 1) {
      const int middle = (inside + outside) / 2;
      (allows(row, middle) ? inside : outside) = middle;
    }
    return inside;
  }

 private:
  const Capture& capture_;
  WorkVolume volume_;
  RigidTransform scan_from_camera_;
};

struct Span {
  int first = 0;
  int last = -1;
};

/// From the first allowed column to the last one.
Span allowed_span(const SheetInVolume& sheet, int row, int cols, int step) {
  Span span;
  int before = -1;  // the column looked at before
  for (int c = 0; c < cols; before = c, c = std::min(c + step, std::max(c + 1, cols - 1))) {
    if (!sheet.allows(row, c)) continue;
    if (span.last < span.first) span.first = before < 0 ? c : sheet.bound(row, c, before);
    span.last = c;
  }
  if (span.last >= span.first && span.last < cols - 1) {
    span.last = sheet.bound(row, span.last, std::min(span.last + step, cols - 1));
  }
  return span;
}

}  // namespace

ColumnGate sheet_gate(const Capture& capture, double margin) {
  require(margin >= 0 && margin < 1e5, "sheet gate: expected a margin of 0 or more, got ", margin);
  WorkVolume lasting = capture.volume;
  keep_lasting(lasting, capture);
  if (capture.zero_line || !bounds_something(lasting)) return {};
  const bool per_row = capture.rig.stripe_direction == StripeDirection::kPerRow;
  const Camera& camera = capture.rig.camera;
  const int rows = per_row ? camera.height : camera.width;
  const int cols = per_row ? camera.width : camera.height;
  const int beside = static_cast<int>(std::ceil(margin));
  const SheetInVolume sheet(capture);
  ColumnGate gate;
  bool whole = true;
  for (int r = 0; r < rows; ++r) {
    Span span = allowed_span(sheet, r, cols, kStep);
    if (span.last < span.first) span = allowed_span(sheet, r, cols, 1);  // a thin one, or none
    const bool any = span.last >= span.first;
    gate.first.push_back(any ? std::max(0, span.first - beside) : 0);
    gate.end.push_back(any ? std::min(cols, span.last + 1 + beside) : 0);
    whole = whole && gate.first.back() == 0 && gate.end.back() == cols;
  }
  return whole ? ColumnGate{} : gate;
}

}  // namespace facula
