// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace facula {

/// Eye-dome lighting (Boucheny 2009): how light a pixel is, from the heights around it. `height`
/// holds rows x cols values towards the viewer [px of the picture], NaN where nothing is seen;
/// returns 1 on open ground, less beside what stands higher. `strength` [1], 0 = no shading.
std::vector<float> depth_shading(const std::vector<float>& height,
                                 int rows,
                                 int cols,
                                 double strength);

}  // namespace facula
