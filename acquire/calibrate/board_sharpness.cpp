// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board_detection.hpp>
#include <facula/acquire/core/median.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

namespace facula {
namespace {

std::optional<double> level_at(ImageView8 grey, const Eigen::Vector2d& pixel) {
  const int c = static_cast<int>(std::floor(pixel.x()));
  const int r = static_cast<int>(std::floor(pixel.y()));
  if (c < 0 || r < 0 || c + 1 >= grey.cols || r + 1 >= grey.rows) return std::nullopt;
  const double u = pixel.x() - c;
  const double v = pixel.y() - r;
  return (1 - v) * ((1 - u) * grey.row(r)[c] + u * grey.row(r)[c + 1]) +
         v * ((1 - u) * grey.row(r + 1)[c] + u * grey.row(r + 1)[c + 1]);
}

/// 10 % to 90 % width of the edge between two places of different brightness; none where they
/// hardly differ.
std::optional<double> width_between(ImageView8 grey,
                                    const Eigen::Vector2d& from,
                                    const Eigen::Vector2d& to) {
  const double length = (to - from).norm();
  const int steps = std::clamp(static_cast<int>(4 * length), 8, 2000);
  std::vector<double> levels;
  for (int i = 0; i <= steps; ++i) {
    const auto level = level_at(grey, from + (to - from) * i / steps);
    if (!level) return std::nullopt;
    levels.push_back(*level);
  }
  if (levels.back() < levels.front()) std::reverse(levels.begin(), levels.end());
  const double low = levels.front();
  const double swing = levels.back() - low;
  if (swing < 25) return std::nullopt;
  const auto crossing = [&](double share) {
    const auto above = std::find_if(
        levels.begin(), levels.end(), [&](double l) { return l >= low + share * swing; });
    const auto k = above - levels.begin();
    const double before = k > 0 ? levels[static_cast<std::size_t>(k - 1)] : low;
    return static_cast<double>(k) -
           (*above - low - share * swing) / std::max(1e-9, *above - before);
  };
  return (crossing(0.9) - crossing(0.1)) * length / steps;
}

/// Where to look for edges: for squares across the middle of the side between two corners, for
/// circles from the centre half way to the neighbour.
void add_edge(BoardKind kind,
              const Eigen::Vector2d& a,
              const Eigen::Vector2d& b,
              const Eigen::Vector2d& across,
              std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& edges) {
  if (kind == BoardKind::kCircles || kind == BoardKind::kAsymmetricCircles) {
    edges.emplace_back(a, 0.5 * (a + b));
    return;
  }
  // ChArUco markers begin a tenth of a square from the side; stay before them.
  const double reach = kind == BoardKind::kCharuco ? 0.09 : 0.4;
  const Eigen::Vector2d middle = 0.5 * (a + b);
  edges.emplace_back(middle - reach * across, middle + reach * across);
}

}  // namespace

double edge_width(ImageView8 grey, const Board& board, const BoardView& view) {
  std::map<int, Eigen::Vector2d> seen;
  for (std::size_t i = 0; i < view.ids.size(); ++i) seen.emplace(view.ids[i], view.pixels[i]);
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> edges;
  for (const auto& [id, a] : seen) {
    const auto right = seen.find(id + 1);
    const auto below = seen.find(id + board.cols);
    if (right == seen.end() || below == seen.end() || (id + 1) % board.cols == 0) continue;
    const Eigen::Vector2d along = right->second - a;
    const Eigen::Vector2d down = below->second - a;
    add_edge(board.kind, a, right->second, down, edges);
    add_edge(board.kind, a, below->second, along, edges);
  }
  std::vector<double> widths;
  const std::size_t step = 1 + edges.size() / 200;
  for (std::size_t i = 0; i < edges.size(); i += step) {
    if (const auto width = width_between(grey, edges[i].first, edges[i].second)) {
      widths.push_back(*width);
    }
  }
  return median(widths);
}

double clipped_share(ImageView8 grey, const BoardView& view) {
  if (view.pixels.empty()) return 0;
  Eigen::Vector2d low = view.pixels.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& p : view.pixels) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const int left = std::max(0, static_cast<int>(low.x()));
  const int right = std::min(grey.cols - 1, static_cast<int>(high.x()));
  std::size_t clipped = 0;
  std::size_t all = 0;
  for (int r = std::max(0, static_cast<int>(low.y()));
       r <= std::min(grey.rows - 1, static_cast<int>(high.y()));
       ++r) {
    for (int c = left; c <= right; ++c) clipped += grey.row(r)[c] == 255 ? 1U : 0U;
    all += static_cast<std::size_t>(std::max(0, right - left + 1));
  }
  return all == 0 ? 0 : static_cast<double>(clipped) / static_cast<double>(all);
}

}  // namespace facula
