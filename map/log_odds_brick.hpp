// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_key.hpp>
#include <facula/map/cell_mask.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace facula {

/// A cell is occupied from these log-odds (a probability of one half) up, and free below: OctoMap's
/// occupancy threshold.
inline bool is_occupied(float log_odds) {
  return log_odds >= 0;
}

/// What one hit or one miss does to a cell's log-odds, in float as OctoMap has them.
struct LogOddsModel {
  float hit = 0;   ///< added where a ray ended [1]
  float miss = 0;  ///< added where one passed, below 0 [1]
  float min = 0;   ///< least value that can be reached [1]
  float max = 0;   ///< largest [1]

  /// With a hit that counts so many eighths: its probability's excess over one half is that share.
  LogOddsModel with_hit(int eighths) const;

  // OctoMap's updateNode(): a value already at its bound, or beyond it, stays as it is.
  float after_hit(float value) const { return value >= max ? value : clamped(value + hit); }
  float after_miss(float value) const { return value <= min ? value : clamped(value + miss); }

 private:
  float clamped(float value) const { return value < min ? min : value > max ? max : value; }
};

/// Log-odds of 8 x 8 x 8 cells, or unknown, in as little memory as the number of different values
/// allows: one value for all costs nothing, up to 16 values cost a bit plane of 64 bytes per
/// doubling, more cost a float per cell. An update works on whole planes.
class LogOddsBrick {
 public:
  static constexpr std::size_t kFewValues = 16;  ///< as many as fit into bit planes [1]
  using Values = std::array<float, kCellsPerBrick>;

  bool empty() const { return form_ == Form::kEmpty; }

  /// One miss for the cells of `passed`, one hit for those of `ended`; no cell is in both.
  void apply(const CellMask& passed, const CellMask& ended, const LogOddsModel& model);

  /// Values of the cells of `known`; whatever was there is forgotten.
  void assign(const Values& values, const CellMask& known);

  /// The same value everywhere.
  void fill(float value);

  /// None where the cell (cell_in_brick()) is unknown.
  std::optional<float> value(std::size_t cell) const;

  /// The value of all cells, where there is only one and all are known.
  std::optional<float> uniform() const {
    return form_ == Form::kUniform ? std::optional<float>(uniform_) : std::nullopt;
  }

  CellMask known() const;

  /// Known cells that is_occupied() holds for.
  CellMask occupied() const;

  /// Writes the values of the known cells, leaves the others as they are, and returns who is known.
  CellMask read(Values& values) const;

  std::size_t memory_usage() const;  ///< beside the object itself [bytes]

 private:
  enum class Form : std::uint8_t { kEmpty, kUniform, kPlanes, kCells };
  struct Palette;

  Palette palette() const;
  void store(const Palette& palette);
  void store_cells(const Values& values, const CellMask& known);
  void apply_to_cells(const CellMask& passed, const CellMask& ended, const LogOddsModel& model);
  const float* floats_after(std::size_t words) const;

  std::unique_ptr<std::uint64_t[]>
      words_;  ///< planes, then values; or known cells, then 512 values
  float uniform_ = 0;
  Form form_ = Form::kEmpty;
  std::uint8_t count_ = 0;  ///< of different values in planes
  std::uint8_t planes_ = 0;
  bool partly_ = false;  ///< planes: code 0 stands for unknown
};

}  // namespace facula
