// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/line_search.hpp>
#include <facula/acquire/stripe/locate.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

bool is_near(const std::vector<RowPeak>& peaks, int column, int reach) {
  return std::any_of(peaks.begin(), peaks.end(), [&](const RowPeak& p) {
    return std::abs(p.column - column) < reach;
  });
}

}  // namespace

LocatedRow locate_in_row(
    const SignalRow& row, const LineKernels& kernels, int begin, int end, int max_peaks) {
  LocatedRow located;
  const std::array<int, 2> columns = {std::max(begin, row.begin), std::min(end, row.end)};
  const LineSearch search = line_search(static_cast<double>(kernels.sigma));
  const int apart = std::max(2, static_cast<int>(std::ceil(2 * kernels.sigma)));
  const std::vector<LinePlace> places = search_row(row, search, columns, apart, 2 * max_peaks);
  if (!places.empty()) located.row_noise = places.front().row_noise;
  for (const LinePlace& place : places) {
    const auto line = settle(row, search, place.column);
    if (!line || is_near(located.peaks, line->column, apart)) continue;
    located.peaks.push_back({line->column, 0.5F * static_cast<float>(line->drop)});
    if (located.peaks.size() >= static_cast<std::size_t>(std::max(0, max_peaks))) break;
  }
  return located;
}

}  // namespace facula
