// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/log_odds_brick.hpp>

#include <bit>
#include <cmath>
#include <cstring>

namespace facula {

/// Different values, and where each one stands.
struct LogOddsBrick::Palette {
  std::array<float, kFewValues> values;  // the first `count` are set
  std::array<CellMask, kFewValues> cells;
  std::size_t count = 0;

  /// False when there is no room for one more value.
  bool add(float value, const CellMask& where) {
    if (where.none()) return true;
    for (std::size_t i = 0; i < count; ++i) {
      if (std::bit_cast<std::uint32_t>(values[i]) != std::bit_cast<std::uint32_t>(value)) continue;
      cells[i] |= where;
      return true;
    }
    if (count == kFewValues) return false;
    values[count] = value;
    cells[count++] = where;
    return true;
  }

  CellMask known() const {
    CellMask all;
    for (std::size_t i = 0; i < count; ++i) all |= cells[i];
    return all;
  }
};

namespace {

std::size_t words_for_floats(std::size_t count) {
  return (count + 1) / 2;
}

constexpr std::size_t kWordsOfCells = 8 + kCellsPerBrick / 2;

}  // namespace

LogOddsModel LogOddsModel::with_hit(int eighths) const {
  const double sure = 1 / (1 + std::exp(-static_cast<double>(hit)));
  const double probability = 0.5 + (sure - 0.5) * eighths / 8;
  LogOddsModel model = *this;
  model.hit = static_cast<float>(std::log(probability / (1 - probability)));
  return model;
}

const float* LogOddsBrick::floats_after(std::size_t words) const {
  return reinterpret_cast<const float*>(words_.get() + words);
}

LogOddsBrick::Palette LogOddsBrick::palette() const {
  Palette result;
  if (form_ == Form::kUniform) result.add(uniform_, CellMask::all());
  if (form_ != Form::kPlanes) return result;
  const float* values = floats_after(8 * std::size_t{planes_});
  result.count = count_;
  for (std::size_t i = 0; i < count_; ++i) {
    result.values[i] = values[i];
    const std::size_t code = partly_ ? i + 1 : i;
    CellMask& cells = result.cells[i];
    cells = CellMask::all();
    for (std::size_t plane = 0; plane < planes_; ++plane) {
      const std::uint64_t flip = (code >> plane & 1) != 0 ? 0 : ~std::uint64_t{0};
      for (std::size_t w = 0; w < 8; ++w) cells.words[w] &= words_[8 * plane + w] ^ flip;
    }
  }
  return result;
}

void LogOddsBrick::store(const Palette& palette) {
  partly_ = !palette.known().full();
  count_ = static_cast<std::uint8_t>(palette.count);
  form_ = Form::kEmpty;
  if (palette.count == 0) return words_.reset();
  if (palette.count == 1 && !partly_) return fill(palette.values[0]);
  form_ = Form::kPlanes;
  const std::size_t codes = palette.count + (partly_ ? 1 : 0);
  planes_ = static_cast<std::uint8_t>(std::bit_width(codes - 1));
  const std::size_t plane_words = 8 * std::size_t{planes_};
  words_ = std::make_unique<std::uint64_t[]>(plane_words + words_for_floats(palette.count));
  for (std::size_t i = 0; i < palette.count; ++i) {
    const std::size_t code = partly_ ? i + 1 : i;
    for (std::size_t plane = 0; plane < planes_; ++plane) {
      if ((code >> plane & 1) == 0) continue;
      for (std::size_t w = 0; w < 8; ++w) words_[8 * plane + w] |= palette.cells[i].words[w];
    }
  }
  std::memcpy(words_.get() + plane_words, palette.values.data(), palette.count * sizeof(float));
}

void LogOddsBrick::fill(float value) {
  words_.reset();
  uniform_ = value;
  form_ = Form::kUniform;
}

void LogOddsBrick::store_cells(const Values& values, const CellMask& known) {
  if (form_ != Form::kCells) words_ = std::make_unique<std::uint64_t[]>(kWordsOfCells);
  form_ = Form::kCells;
  std::memcpy(words_.get(), known.words.data(), sizeof known.words);
  std::memcpy(words_.get() + 8, values.data(), sizeof values);
}

void LogOddsBrick::assign(const Values& values, const CellMask& known) {
  Palette palette;
  bool few = true;
  for (std::size_t cell = 0; cell < kCellsPerBrick && few; ++cell) {
    if (!known.test(cell)) continue;
    CellMask one;
    one.set(cell);
    few = palette.add(values[cell], one);
  }
  if (few) return store(palette);
  Values kept{};  // unknown cells hold 0, so that equal bricks are equal bytes
  for_each_cell(known, [&](std::size_t cell) { kept[cell] = values[cell]; });
  store_cells(kept, known);
}

void LogOddsBrick::apply(const CellMask& passed, const CellMask& ended, const LogOddsModel& model) {
  if (form_ == Form::kCells) return apply_to_cells(passed, ended, model);
  const Palette before = palette();
  Palette after;
  const CellMask untouched = ~(passed | ended);
  bool few = true;
  for (std::size_t i = 0; i < before.count && few; ++i) {
    const float value = before.values[i];
    const CellMask& cells = before.cells[i];
    few = after.add(value, cells & untouched) &&
          after.add(model.after_miss(value), cells & passed) &&
          after.add(model.after_hit(value), cells & ended);
  }
  if (few && !before.known().full()) {
    const CellMask fresh = ~before.known();
    few = after.add(model.after_miss(0), fresh & passed) &&
          after.add(model.after_hit(0), fresh & ended);
  }
  if (few) return store(after);
  Values values{};
  store_cells(values, read(values));
  apply_to_cells(passed, ended, model);
}

void LogOddsBrick::apply_to_cells(const CellMask& passed,
                                  const CellMask& ended,
                                  const LogOddsModel& model) {
  Values values{};
  const CellMask known = read(values);
  for_each_cell(passed, [&](std::size_t cell) { values[cell] = model.after_miss(values[cell]); });
  for_each_cell(ended, [&](std::size_t cell) { values[cell] = model.after_hit(values[cell]); });
  assign(values, known | passed | ended);
}

std::optional<float> LogOddsBrick::value(std::size_t cell) const {
  if (form_ == Form::kEmpty) return std::nullopt;
  if (form_ == Form::kUniform) return uniform_;
  const std::size_t word = cell >> 6;
  const std::size_t bit = cell & 63;
  if (form_ == Form::kCells) {
    if ((words_[word] >> bit & 1) == 0) return std::nullopt;
    return floats_after(8)[cell];
  }
  std::size_t code = 0;
  for (std::size_t plane = 0; plane < planes_; ++plane) {
    code |= (words_[8 * plane + word] >> bit & 1) << plane;
  }
  if (partly_ && code == 0) return std::nullopt;
  return floats_after(8 * std::size_t{planes_})[partly_ ? code - 1 : code];
}

CellMask LogOddsBrick::known() const {
  if (form_ == Form::kCells) {
    CellMask known;
    std::memcpy(known.words.data(), words_.get(), sizeof known.words);
    return known;
  }
  CellMask known;
  if (form_ == Form::kUniform || (form_ == Form::kPlanes && !partly_)) return CellMask::all();
  if (form_ == Form::kEmpty) return known;
  for (std::size_t i = 0; i < 8 * std::size_t{planes_}; ++i) known.words[i & 7] |= words_[i];
  return known;
}

CellMask LogOddsBrick::occupied() const {
  CellMask result;
  if (form_ == Form::kCells) {
    const float* values = floats_after(8);
    for_each_cell(known(), [&](std::size_t cell) {
      if (is_occupied(values[cell])) result.set(cell);
    });
    return result;
  }
  const Palette few = palette();
  for (std::size_t i = 0; i < few.count; ++i) {
    if (is_occupied(few.values[i])) result |= few.cells[i];
  }
  return result;
}

CellMask LogOddsBrick::read(Values& values) const {
  if (form_ == Form::kCells) {
    std::memcpy(values.data(), words_.get() + 8, sizeof values);
    return known();
  }
  const Palette few = palette();
  for (std::size_t i = 0; i < few.count; ++i) {
    for_each_cell(few.cells[i], [&](std::size_t cell) { values[cell] = few.values[i]; });
  }
  return few.known();
}

std::size_t LogOddsBrick::memory_usage() const {
  if (form_ == Form::kCells) return 8 * kWordsOfCells;
  if (form_ == Form::kPlanes) return 8 * (8 * std::size_t{planes_} + words_for_floats(count_));
  return 0;
}

}  // namespace facula
