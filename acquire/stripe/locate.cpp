// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/locate.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

/// filtered() with the curvature for all columns [begin, end): taps outside, columns inside, so
/// that the compiler runs several columns at once.
std::vector<float> bends_of_row(const SignalRow& row,
                                const LineKernels& kernels,
                                int begin,
                                int end) {
  const std::vector<float>& kernel = kernels.curvature;
  const int radius = kernels.radius;
  std::vector<float> out(static_cast<std::size_t>(end - begin), 0.0F);
  const int first = std::clamp(row.begin + radius, begin, end);
  const int last = std::clamp(row.end - radius, first, end);
  for (int c = begin; c < first; ++c) {
    out[static_cast<std::size_t>(c - begin)] = filtered(kernel, row, c);
  }
  for (int c = last; c < end; ++c) {
    out[static_cast<std::size_t>(c - begin)] = filtered(kernel, row, c);
  }
  for (std::size_t i = 0; i < kernel.size() && first < last; ++i) {
    const float weight = kernel[i];
    const std::int16_t* s =
        row.values + (first - radius - row.begin) + static_cast<std::ptrdiff_t>(i);
    float* sum = out.data() + (first - begin);
    for (int c = 0; c < last - first; ++c) sum[c] += weight * static_cast<float>(s[c]);
  }
  return out;
}

/// Standard deviation of most of the values, those within `reach` of `middle` left out.
float robust_scale(const std::vector<float>& values, std::size_t middle, std::size_t reach) {
  std::vector<float> sizes;
  constexpr std::size_t kStep = 3;  // neighbours say the same after the filter
  for (std::size_t i = 0; i < values.size(); i += kStep) {
    if (i + reach < middle || i > middle + reach) sizes.push_back(std::abs(values[i]));
  }
  if (sizes.size() < 16) return 0;
  return median(sizes) * 1.4826F;  // sigma over the median of |x| for a normal x
}

}  // namespace

LocatedRow locate_in_row(
    const SignalRow& row, const LineKernels& kernels, int begin, int end, int max_peaks) {
  LocatedRow located;
  begin = std::max(begin, row.begin);
  end = std::min(end, row.end);
  if (end - begin < 3 || max_peaks < 1) return located;
  std::vector<float> bends = bends_of_row(row, kernels, begin, end);
  const auto strongest =
      static_cast<std::size_t>(std::max_element(bends.begin(), bends.end()) - bends.begin());
  located.row_noise = robust_scale(bends, strongest, static_cast<std::size_t>(2 * kernels.radius)) /
                      kernels.curvature_norm;
  const auto reach = static_cast<std::ptrdiff_t>(std::max(2, kernels.radius / 2));
  for (int i = 0; i < max_peaks; ++i) {
    const auto top = std::max_element(bends.begin(), bends.end());
    if (!(*top > 0)) break;
    located.peaks.push_back({begin + static_cast<int>(top - bends.begin()), *top});
    std::fill(std::max(bends.begin(), top - std::min(reach, top - bends.begin())),
              top + std::min(reach + 1, bends.end() - top),
              0.0F);
  }
  return located;
}

}  // namespace facula
