// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/measure/convex_hull_3d.hpp>
#include <facula/reconstruct/measure/width.hpp>
#include <facula/tests/reconstruct/width_clouds.hpp>
#include <facula/tests/reconstruct/width_comparison.hpp>
#include <facula/tests/reconstruct/width_judge_cgal.hpp>

#include <cmath>

namespace facula {

WidthComparison compare_widths(unsigned clouds) {
  WidthComparison result;
  for (unsigned seed = 0; seed < clouds; ++seed) {
    const WidthCloud cloud = width_cloud(seed);
    const double own = width_of(cloud.points).width;
    if (convex_hull_3d(cloud.points).dimension < 3) {
      ++result.flat;
      result.flat_is_zero = result.flat_is_zero && own == 0;
      continue;
    }
    ++result.judged;
    result.flat_is_zero = result.flat_is_zero && !cloud.flat;
    const double judged = judged_width(cloud.points, cloud.unit);
    const double off = std::abs(own - judged) / judged;
    if (off < result.worst) continue;
    result.worst = off;
    result.worst_kind = cloud.kind + " " + std::to_string(seed);
  }
  return result;
}

}  // namespace facula
