// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/mesh/brick_blocks.hpp>

#include <algorithm>

namespace facula {
namespace {

BrickBox box_of(const std::vector<BrickPlace>& bricks) {
  BrickBox box{bricks.front(), bricks.front()};
  for (const BrickPlace& b : bricks) {
    box.low = box.low.cwiseMin(b);
    box.high = box.high.cwiseMax(b);
  }
  return box;
}

/// Splits `own` further; `near` holds all bricks that any of its blocks may need.
void split(std::vector<BrickPlace> own,
           const std::vector<BrickPlace>& near,
           std::size_t most,
           std::vector<BrickBlock>& blocks) {
  BrickBlock block{box_of(own), {}, 0};
  block.needed = {block.own.low, block.own.high + BrickPlace::Ones()};
  std::vector<BrickPlace> needed;
  std::copy_if(near.begin(), near.end(), std::back_inserter(needed), [&](const BrickPlace& b) {
    return block.needed.holds(b);
  });
  block.bricks = needed.size();
  const BrickPlace sides = block.own.high - block.own.low;
  if (needed.size() <= most || sides.isZero()) {
    blocks.push_back(block);
    return;
  }
  int axis = 0;
  sides.maxCoeff(&axis);
  std::vector<int> along;
  along.reserve(own.size());
  for (const BrickPlace& b : own) along.push_back(b[axis]);
  const auto middle = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
  std::nth_element(along.begin(), middle, along.end());
  // Both sides get a brick, also where most stand in the lowest layer.
  const int border = std::max(*middle, block.own.low[axis] + 1);
  const auto upper = std::stable_partition(
      own.begin(), own.end(), [&](const BrickPlace& b) { return b[axis] < border; });
  std::vector<BrickPlace> second(upper, own.end());
  own.erase(upper, own.end());
  split(std::move(own), needed, most, blocks);
  split(std::move(second), needed, most, blocks);
}

}  // namespace

std::vector<BrickBlock> split_into_blocks(std::vector<BrickPlace> bricks, std::size_t most) {
  std::vector<BrickBlock> blocks;
  if (bricks.empty()) return blocks;
  const std::vector<BrickPlace> all = bricks;
  split(std::move(bricks), all, most, blocks);
  return blocks;
}

}  // namespace facula
