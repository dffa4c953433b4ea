// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/line_search.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace facula {
namespace {

int average(int a, int b) {
  return (a + b + 1) >> 1;
}

int level_at(const RowGroup& rows, int c) {
  const auto value = [&](std::size_t i) { return std::clamp(rows[i].at(c), 0, 255); };
  return average(average(value(0), value(1)), average(value(2), value(3)));
}

/// Average of so many columns from c on, twice as many for every halving.
int column_at(const RowGroup& rows, int c, int halvings) {
  if (halvings == 0) return level_at(rows, c);
  const int half = 1 << (halvings - 1);
  return average(column_at(rows, c, halvings - 1), column_at(rows, c + half, halvings - 1));
}

/// What boxes [first, last) exceed those beside them by.
std::vector<int> heights(const RowGroup& rows, const LineSearch& search, int first, int last) {
  const int length = 1 << search.levels;
  const int begin = first - search.distance;
  std::vector<int> box;
  for (int j = begin; j < last + search.distance + length; ++j) {
    box.push_back(column_at(rows, search.step() * j, search.halvings));
  }
  for (int step = 1; step < length; step *= 2) {
    for (std::size_t i = 0; i + static_cast<std::size_t>(step) < box.size(); ++i) {
      box[i] = average(box[i], box[i + static_cast<std::size_t>(step)]);
    }
  }
  std::vector<int> over;
  for (int j = first; j < last; ++j) {
    const auto at = [&](int k) { return box[static_cast<std::size_t>(k - begin)]; };
    const int beside = std::max(at(j - search.distance), at(j + search.distance));
    over.push_back(std::max(0, at(j) - beside));
  }
  return over;
}

std::size_t highest(const std::vector<int>& over) {
  return static_cast<std::size_t>(std::max_element(over.begin(), over.end()) - over.begin());
}

LinePlace place_at(const std::vector<int>& over,
                   std::size_t i,
                   const BoxRange& pairs,
                   const LineSearch& search) {
  return {search.middle(pairs.first + static_cast<int>(i)), over[i], 0};
}

float noise_of(std::vector<int>& over, const RowNoiseScale& scale, std::size_t top, int reach) {
  const auto count = static_cast<int>(over.size());
  const int first = std::max(0, static_cast<int>(top) - reach);
  const int last = std::min(count, static_cast<int>(top) + reach + 1);
  const int kept = count - (last - first);
  if (kept < 32) return 0;
  std::fill(over.begin() + first, over.begin() + last, 0);
  int sum = 0;
  for (int step = 0; step < RowNoiseScale::kSteps; ++step) {
    sum = 0;
    for (const int v : over) sum += std::min(v, scale.clip(step));
    if (scale.fits(step, sum, kept)) return scale.noise(step, sum, kept);
  }
  return scale.noise(RowNoiseScale::kSteps - 1, sum, kept);
}

}  // namespace

LineSearch line_search(double sigma) {
  LineSearch search;
  search.halvings = sigma < 1.5 ? 1 : 2;
  search.levels = sigma < 1.5 ? 1 : sigma <= 2.8 ? 0 : sigma <= 5.6 ? 1 : 2;
  search.distance =
      std::max(2 << (search.levels / 2), static_cast<int>(std::lround(3 * sigma / search.step())));
  search.box = std::max(2, static_cast<int>(std::lround(2.5 * sigma)));
  search.reach = std::max(4, static_cast<int>(std::lround(3 * sigma)));
  return search;
}

RowNoiseScale::RowNoiseScale(const LineSearch& search, float noise, bool averaged) {
  // White noise n leaves n / sqrt(pixels) in a box, and each average that rounds a variance of
  // 1/16, less what later averages take away. A box exceeds the higher of two others, all alike,
  // by 0.282 of their standard deviation in the mean, 0 where it does not.
  const float pixels = static_cast<float>((averaged ? kRowsAtOnce : 1) * search.width());
  constexpr float kRounding = 0.12F;
  constexpr float kMeanHeight = 0.282F;
  constexpr float kClear = 1.5F;
  float step_noise = std::max(1.0F, noise);
  for (std::size_t step = 0; step < kSteps; ++step) {
    const float deviation = std::sqrt(step_noise * step_noise / pixels + kRounding);
    clip_[step] = std::min(255, static_cast<int>(std::ceil(4 * deviation)));
    limit_[step] = kClear * kMeanHeight * deviation;
    step_noise *= kClear;
  }
  per_mean_ = std::sqrt(pixels) / kMeanHeight;
}

BoxRange boxes_between(const std::array<int, 2>& columns, const LineSearch& search) {
  if (columns[1] - columns[0] < 3) return {};
  // The first box whose middle is at or right of a column; a row's first boxes begin left of it.
  const auto from = [&](int column) {
    constexpr int kSteps = 256;
    const int least = column - search.middle(0) + search.step() - 1;
    return (least + kSteps * search.step()) / search.step() - kSteps;
  };
  return {from(columns[0]), from(columns[1])};
}

LinePlace search_rows(const RowGroup& rows,
                      const LineSearch& search,
                      const std::array<int, 2>& columns,
                      float noise,
                      bool averaged) {
  const BoxRange pairs = boxes_between(columns, search);
  if (rows[0].empty() || pairs.first >= pairs.last) return {};
  std::vector<int> over = heights(rows, search, pairs.first, pairs.last);
  const std::size_t top = highest(over);
  LinePlace place = place_at(over, top, pairs, search);
  if (place.height <= 0) return {};
  const int reach = search.own_reach();
  place.row_noise = noise_of(over, RowNoiseScale(search, noise, averaged), top, reach);
  return place;
}

std::vector<LinePlace> search_row(const SignalRow& row,
                                  const LineSearch& search,
                                  const std::array<int, 2>& columns,
                                  int apart,
                                  int max_places) {
  std::vector<LinePlace> places;
  const RowGroup rows = {row, row, row, row};
  const BoxRange pairs = boxes_between(columns, search);
  if (row.empty() || pairs.first >= pairs.last) return places;
  std::vector<int> over = heights(rows, search, pairs.first, pairs.last);
  for (int i = 0; i < max_places; ++i) {
    const std::size_t top = highest(over);
    LinePlace place = place_at(over, top, pairs, search);
    if (place.height <= 0) break;
    if (i == 0) place.row_noise = search_rows(rows, search, columns, 0, false).row_noise;
    places.push_back(place);
    const int index = static_cast<int>(top);
    const int reach = std::max(1, apart / search.step());
    std::fill(over.begin() + std::max(0, index - reach),
              over.begin() + std::min(static_cast<int>(over.size()), index + reach + 1),
              0);
  }
  return places;
}

std::optional<SettledLine> settle(const SignalRow& row, const LineSearch& search, int column) {
  const auto difference = [&](int c) {
    int sum = 0;
    for (int i = 1; i <= search.box; ++i) sum += row.at(c + i) - row.at(c - i);
    return sum;
  };
  SettledLine best;
  int left = difference(column - search.reach);
  for (int c = column - search.reach; c < column + search.reach; ++c) {
    const int right = difference(c + 1);
    const int drop = left - right;
    if (left > 0 && right <= 0 && drop > best.drop) {
      best = {2 * left < drop ? c : c + 1, drop};
    }
    left = right;
  }
  if (best.drop == 0 || !row.holds(best.column)) return std::nullopt;
  return best;
}

}  // namespace facula
