// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/distance_transform.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace facula {
namespace {

// One transform serves both signs: on every line the cells of one kind form runs, and next to
// either end of a run lies a cell of the other kind, whose distance is 0. Whatever lies behind that
// cell is farther from the run than the cell itself, so that runs never look at each other.

constexpr std::size_t kBlock = 32;  // neighbouring lines that are worked on together

/// First x behind `begin` where the row's kind of cell changes, or `end`.
int end_of_run(const ObstacleBits& obstacles, std::size_t row, int begin, int end) {
  constexpr int kBitsRead = 56;
  const bool solid = (obstacles.from(row, begin) & 1) != 0;
  for (int x = begin; x < end; x += kBitsRead) {
    const std::uint64_t word = obstacles.from(row, x);
    const std::uint64_t other = (solid ? ~word : word) & ((std::uint64_t{1} << kBitsRead) - 1);
    if (other != 0) return std::min(end, x + std::countr_zero(other));
  }
  return end;
}

/// Squared distances along x alone.
void scan_row(const ObstacleBits& obstacles, std::size_t row, int limit, std::int32_t* line) {
  const int end = obstacles.box().size(0);
  for (int begin = 0; begin < end;) {
    const bool solid = (obstacles.from(row, begin) & 1) != 0;
    const int behind = end_of_run(obstacles, row, begin, end);
    const int sign = solid ? -1 : 1;
    const bool left = begin > 0;
    const bool right = behind < end;
    const int middle = !left ? begin : right ? begin + (behind - begin) / 2 : behind;
    const int near_left = left ? std::min(middle, begin + limit) : begin;
    const int near_right = right ? std::max(middle, behind - limit) : behind;
    for (int x = begin; x < near_left; ++x) line[x] = sign * (x - begin + 1) * (x - begin + 1);
    std::fill(line + near_left, line + near_right, sign * kBeyond);
    for (int x = near_right; x < behind; ++x) line[x] = sign * (behind - x) * (behind - x);
    begin = behind;
  }
}

/// A parabola: squared distance to what lies `height` away, at the side, from the line's cell `at`.
struct Parabola {
  int at = 0;
  std::int32_t height = 0;
  int from = 0;  // first cell where it is the lowest

  std::int32_t value(int x) const { return (x - at) * (x - at) + height; }
};

/// The lower envelope of parabolas over the cells [begin, end) of a line.
class Envelope {
 public:
  explicit Envelope(std::size_t longest_line) : parabolas_(longest_line + 2) {}

  void start(int begin, int end) {
    begin_ = begin;
    end_ = end;
    count_ = 0;
  }

  /// In ascending order of `at`.
  void add(int at, std::int32_t height) {
    Parabola fresh{at, height, begin_};
    while (count_ > 0 && parabolas_[count_ - 1].value(parabolas_[count_ - 1].from) >=
                             fresh.value(parabolas_[count_ - 1].from)) {
      --count_;
    }
    if (count_ > 0) {
      // Numerator and denominator are above 0: the last parabola is the lower one where it begins.
      const Parabola& last = parabolas_[count_ - 1];
      const std::int32_t rise = at * at - last.at * last.at + height - last.height;
      fresh.from = rise / (2 * (at - last.at)) + 1;
      if (fresh.from >= end_) return;
    }
    parabolas_[count_++] = fresh;
  }

  void write(std::int32_t* line, std::int32_t limit_squared, int sign) const {
    if (count_ == 0) std::fill(line + begin_, line + end_, sign * kBeyond);
    for (std::size_t i = 0; i < count_; ++i) {
      const Parabola lowest = parabolas_[i];
      const int end = i + 1 < count_ ? parabolas_[i + 1].from : end_;
      for (int x = lowest.from; x < end; ++x) {
        const std::int32_t value = lowest.value(x);
        line[x] = sign * (value > limit_squared ? kBeyond : value);
      }
    }
  }

 private:
  std::vector<Parabola> parabolas_;
  std::size_t count_ = 0;
  int begin_ = 0;
  int end_ = 0;
};

/// From distances across a line's direction to those along it as well.
void transform_line(std::int32_t* line, int size, std::int32_t limit_squared, Envelope& envelope) {
  for (int begin = 0; begin < size;) {
    const bool solid = line[begin] < 0;
    const int sign = solid ? -1 : 1;
    int end = begin + 1;
    while (end < size && (line[end] < 0) == solid) ++end;
    envelope.start(begin, end);
    if (begin > 0) envelope.add(begin - 1, 0);
    for (int x = begin; x < end; ++x) {
      const std::int32_t height = sign * line[x];
      if (height != kBeyond) envelope.add(x, height);
    }
    if (end < size) envelope.add(end, 0);
    envelope.write(line, limit_squared, sign);
    begin = end;
  }
}

/// Lines of `size` cells that lie `stride` apart in the array; a plane holds `width` of them side
/// by side, and planes are `plane_stride` apart.
struct Lines {
  int size = 0;
  std::size_t stride = 0;
  std::size_t width = 0;
  std::size_t planes = 0;
  std::size_t plane_stride = 0;
};

void transform_lines(std::vector<std::int32_t>& cells,
                     const Lines& lines,
                     std::int32_t limit_squared,
                     int num_threads) {
  const std::size_t blocks = (lines.width + kBlock - 1) / kBlock;
  const auto size = static_cast<std::size_t>(lines.size);
  const auto work = [&](std::size_t begin, std::size_t end) {
    Envelope envelope(size);
    std::vector<std::int32_t> turned(kBlock * size);  // a block with its lines one behind the other
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t column = i % blocks * kBlock;
      const std::size_t count = std::min(kBlock, lines.width - column);
      std::int32_t* corner = cells.data() + i / blocks * lines.plane_stride + column;
      for (std::size_t k = 0; k < size; ++k) {
        for (std::size_t c = 0; c < count; ++c) turned[c * size + k] = corner[k * lines.stride + c];
      }
      for (std::size_t c = 0; c < count; ++c) {
        transform_line(turned.data() + c * size, lines.size, limit_squared, envelope);
      }
      for (std::size_t k = 0; k < size; ++k) {
        for (std::size_t c = 0; c < count; ++c) corner[k * lines.stride + c] = turned[c * size + k];
      }
    }
  };
  parallel_for(blocks * lines.planes, work, {.num_threads = num_threads, .chunk = 8});
}

}  // namespace

std::vector<std::int32_t> signed_squared_distances(const ObstacleBits& obstacles,
                                                   std::int32_t limit_squared,
                                                   int num_threads) {
  const CellBox& box = obstacles.box();
  const auto nx = static_cast<std::size_t>(box.size(0));
  const auto ny = static_cast<std::size_t>(box.size(1));
  const auto nz = static_cast<std::size_t>(box.size(2));
  const int limit = static_cast<int>(std::sqrt(static_cast<double>(limit_squared)));
  std::vector<std::int32_t> cells(box.cells());
  const auto scan = [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      scan_row(obstacles, row, limit, cells.data() + row * nx);
    }
  };
  parallel_for(obstacles.rows(), scan, {.num_threads = num_threads, .chunk = 64});
  const Lines along_y{
      .size = box.size(1), .stride = nx, .width = nx, .planes = nz, .plane_stride = nx * ny};
  transform_lines(cells, along_y, limit_squared, num_threads);
  const Lines along_z{
      .size = box.size(2), .stride = nx * ny, .width = nx, .planes = ny, .plane_stride = nx};
  transform_lines(cells, along_z, limit_squared, num_threads);
  return cells;
}

}  // namespace facula
