// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/apps/report/drawing.hpp>
#include <facula/reconstruct/measure/plane.hpp>

namespace facula {

/// Signed distances of a plane's points from it, over the plane's own two axes (u along the longer
/// side), blue below, red above (the side the normal points to), with axes, colour bar and, below,
/// a histogram with the normal distribution of the same standard deviation. `cloud` is the cloud
/// the plane was extracted from; throws Error when the plane's indices do not fit it. A plane
/// without points gives a picture that says so.
Image8 plane_deviation(const ExtractedPlane& plane, const PointCloud& cloud);

}  // namespace facula
