// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/line_search.hpp>
#include <facula/acquire/stripe/row_noise.hpp>
#include <facula/acquire/stripe/search_area.hpp>
#include <facula/acquire/stripe/stripe_location.hpp>
#include <facula/acquire/stripe/stripe_simd.hpp>

#include <algorithm>
#include <utility>

namespace facula {
namespace {

/// The rows from r on, the last one of the area again where there are no more.
RowGroup group_from(const StripeSignal& signal, int r, const SearchArea& area) {
  RowGroup rows;
  for (int i = 0; i < kRowsAtOnce; ++i) {
    rows[static_cast<std::size_t>(i)] = signal.row(std::min(r + i, area.last - 1));
  }
  return rows;
}

/// The line that a row shares with its group or, where it shows none there, its own.
void locate_row(const SignalRow& row,
                const LineSearch& search,
                const std::array<int, 2>& columns,
                LinePlace place,
                std::size_t r,
                StripeLocation& location) {
  if (row.empty()) return;
  std::optional<SettledLine> line;
  if (place.column >= 0) line = settle(row, search, place.column);
  if (!line || !shows(*line, place.height)) {
    const std::array<int, 2> known = {std::max(columns[0], row.begin),
                                      std::min(columns[1], row.end)};
    place = search_rows({row, row, row, row}, search, known, location.noise, false);
    if (place.column < 0) return;
    line = settle(row, search, place.column);
  }
  if (!line) return;
  location.peak[r] = line->column;
  location.peak_per_noise[r] = 0.5F * static_cast<float>(line->drop);
  location.row_noise[r] = place.row_noise;
}

}  // namespace

StripeLocation StripeLocation::none(std::size_t rows) {
  StripeLocation location;
  location.peak.assign(rows, -1);
  location.peak_per_noise.assign(rows, 0);
  location.row_noise.assign(rows, 0);
  return location;
}

StripeLocation locate_stripe(const StripeSignal& signal, const StripeOptions& options) {
  if (auto location = locate_stripe_simd(signal, options)) return std::move(*location);
  StripeLocation location = StripeLocation::none(static_cast<std::size_t>(signal.rows()));
  location.noise = estimate_noise(signal);
  const LineSearch search = line_search(options.sigma);
  const SearchArea area = search_area(signal.rows(), signal.cols(), options);
  const std::array<int, 2> columns = {area.begin, area.end};
  for (int r = area.first; r < area.last; r += kRowsAtOnce) {
    const RowGroup rows = group_from(signal, r, area);
    // Windows of rows lie each elsewhere: every row is then looked at alone.
    const bool together = signal.is_whole();
    const LinePlace place =
        together ? search_rows(rows, search, columns, location.noise, true) : LinePlace{};
    for (int i = r; i < std::min(r + kRowsAtOnce, area.last); ++i) {
      locate_row(signal.row(i), search, columns, place, static_cast<std::size_t>(i), location);
    }
  }
  return location;
}

}  // namespace facula
