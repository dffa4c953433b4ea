// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/map/brick_index.hpp>
#include <facula/map/cell_mask.hpp>
#include <facula/map/scan_cells.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace facula {

/// Colours added up: a cell's colour is the mean of the colours of all points that ended in it,
/// over all scans, each channel rounded to the nearest (halves up). Whole numbers, so that neither
/// the order of points nor that of scans matters, and a scan can be taken out again.
struct ColorSum {
  std::uint64_t count = 0;                ///< points [1]
  std::array<std::uint64_t, 3> sum = {};  ///< of red, green, blue [0..255 each]

  Color mean() const;  ///< black without points
  void add(const ColorSum& more);
  void subtract(const ColorSum& less);

  friend bool operator==(const ColorSum&, const ColorSum&) = default;
};

/// The coloured cells of a brick.
struct ColorBrick {
  std::uint64_t code = 0;      ///< brick_code()
  CellMask cells;              ///< that have a colour
  std::vector<ColorSum> sums;  ///< of them, in ascending order

  friend bool operator==(const ColorBrick&, const ColorBrick&) = default;
};

/// The colours that a scan's points give the cells they end in, by the same rules as
/// cells_of_scan(): points that are skipped, cut at the maximum range or outside the box give none.
/// In ascending order of codes; empty for a cloud without colours.
std::vector<ColorBrick> colors_of_scan(const PointCloud& cloud, const CastOptions& options);

/// Colours of cells, beside their log-odds. Holds nothing where no scan had colours.
class CellColors {
 public:
  bool empty() const { return bricks_.empty(); }

  void add(std::span<const ColorBrick> bricks);

  /// Takes out what add() put in; cells without points left have no colour any more.
  void subtract(std::span<const ColorBrick> bricks);

  /// None where the cell has no colour.
  std::optional<Color> color(const CellKey& cell) const;

  std::span<const ColorBrick> bricks() const { return bricks_; }  ///< in the order of their making
  std::vector<const ColorBrick*> sorted() const;                  ///< in Morton order
  std::size_t memory_usage() const;                               ///< [bytes]

 private:
  std::vector<ColorBrick> bricks_;
  BrickIndex index_;
};

}  // namespace facula
