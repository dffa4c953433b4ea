// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_signal.hpp>

#include <array>
#include <optional>
#include <vector>

namespace facula {

/// How a line of a given width is looked for, in whole numbers of 8 bits. Rows are averaged into
/// one, columns in pairs or, twice, in fours; boxes of 2^levels of these are then held against the
/// boxes `distance` pairs or fours to both sides. Every average rounds halves up.
struct LineSearch {
  int halvings = 2;  ///< of the number of columns: 1 pairs, 2 fours [1]
  int levels = 0;    ///< of averaging neighbours after that [1]
  int distance = 2;  ///< between the boxes held against one another [pairs or fours]
  int box = 5;       ///< columns summed on each side when a row's own line is settled [px]
  int reach = 6;     ///< how far a row's own line may lie from where it was looked for [px]

  int step() const { return 1 << halvings; }              ///< columns from box to box [px]
  int width() const { return 1 << (halvings + levels); }  ///< columns of a box [px]

  /// Column in the middle of box j, which begins with pair or four j.
  int middle(int j) const { return step() * j + width() / 2; }
  /// Boxes beside the highest that its line may reach.
  int own_reach() const { return distance + (1 << levels); }
};

/// For lines of width `sigma` [px]: boxes of about twice that, 3 sigma or more apart.
LineSearch line_search(double sigma);

/// Boxes [first, last) of a row.
struct BoxRange {
  int first = 0;
  int last = 0;
};

/// Those with their middle among columns [columns[0], columns[1]); none for less than 3 columns.
BoxRange boxes_between(const std::array<int, 2>& columns, const LineSearch& search);

constexpr int kRowsAtOnce = 4;

/// Rows in which one line is looked for. Fewer than 4 rows: the last ones are the same.
using RowGroup = std::array<SignalRow, kRowsAtOnce>;

/// Where rows stand out the most over both sides.
struct LinePlace {
  int column = -1;      ///< [px], -1 for nowhere
  int height = 0;       ///< over the higher of both sides [DN]
  float row_noise = 0;  ///< of one row; 0 where not clearly more than was assumed [DN]
};

/// The place between columns [begin, end), of equal ones the first. `noise` is what the rows are
/// known to have [DN]; `averaged` tells whether the group's rows are different ones.
LinePlace search_rows(const RowGroup& rows,
                      const LineSearch& search,
                      const std::array<int, 2>& columns,
                      float noise,
                      bool averaged);

/// Up to `max_places` such places of one row, the highest first, `apart` columns or more from one
/// another. The first is what search_rows() finds in a group of that row alone.
std::vector<LinePlace> search_row(const SignalRow& row,
                                  const LineSearch& search,
                                  const std::array<int, 2>& columns,
                                  int apart,
                                  int max_places);

/// A row's own line near a place.
struct SettledLine {
  int column = 0;  ///< [px]
  int drop = 0;    ///< how much the difference between both sides changes across it [DN]
};

/// Near `column` the sum of `search.box` columns to the right exceeds that of the columns to the
/// left before a line, and falls short of it after: the steepest such change within the reach, of
/// equal ones the first.
std::optional<SettledLine> settle(const SignalRow& row, const LineSearch& search, int column);

/// Whether a row shows the line that its group shows with this height.
inline bool shows(const SettledLine& line, int height) {
  return 4 * line.drop >= 3 * height;
}

/// How far a sum of bends, each at most `clip`, shows more noise than assumed. See search_rows.
class RowNoiseScale {
 public:
  RowNoiseScale(const LineSearch& search, float noise, bool averaged);

  static constexpr int kSteps = 9;  ///< each 1.5 times the noise of the one before

  int clip(int step) const { return clip_[static_cast<std::size_t>(step)]; }
  /// Whether `sum` over `count` bends, clipped at clip(step), fits the noise of that step.
  bool fits(int step, int sum, int count) const {
    return static_cast<float>(sum) <=
           limit_[static_cast<std::size_t>(step)] * static_cast<float>(count);
  }
  /// The row's noise when it fits first at this step [DN].
  float noise(int step, int sum, int count) const {
    return step == 0 ? 0 : static_cast<float>(sum) / static_cast<float>(count) * per_mean_;
  }

 private:
  std::array<int, kSteps> clip_{};
  std::array<float, kSteps> limit_{};
  float per_mean_ = 0;
};

}  // namespace facula
