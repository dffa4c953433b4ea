// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board_detection.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

namespace facula {
namespace {

std::vector<cv::Point2f> dark_blobs(ImageView8 grey) {
  const cv::Mat image(grey.rows,
                      grey.cols,
                      CV_8U,
                      const_cast<std::uint8_t*>(grey.data),
                      static_cast<std::size_t>(grey.stride));
  cv::SimpleBlobDetector::Params params;
  params.minArea = 20;
  params.maxArea = static_cast<float>(grey.rows) * static_cast<float>(grey.cols) / 30;
  std::vector<cv::KeyPoint> keys;
  cv::SimpleBlobDetector::create(params)->detect(image, keys);
  std::vector<cv::Point2f> centres;
  centres.reserve(keys.size());
  for (const cv::KeyPoint& key : keys) centres.push_back(key.pt);
  return centres;
}

std::optional<GridSeen> grid_among(const std::vector<cv::Point2f>& blobs,
                                   int cols,
                                   int rows,
                                   bool asymmetric) {
  const auto count = static_cast<std::size_t>(cols * rows);
  if (blobs.size() < count) return std::nullopt;
  std::vector<cv::Point2f> centres;
  const int flags = asymmetric ? cv::CALIB_CB_ASYMMETRIC_GRID : cv::CALIB_CB_SYMMETRIC_GRID;
  for (const int clustering : {0, static_cast<int>(cv::CALIB_CB_CLUSTERING)}) {
    try {
      // Without a detector the function takes the blobs' centres in place of a picture.
      if (cv::findCirclesGrid(
              cv::Mat(blobs), {cols, rows}, centres, flags | clustering, nullptr, {}) &&
          centres.size() == count) {
        GridSeen grid{cols, rows, {}};
        for (const cv::Point2f& p : centres) grid.pixels.emplace_back(p.x, p.y);
        return grid;
      }
    } catch (const cv::Exception&) {
      continue;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<GridSeen> find_circle_grid(ImageView8 grey, const Board& board) {
  return grid_among(
      dark_blobs(grey), board.cols, board.rows, board.kind == BoardKind::kAsymmetricCircles);
}

std::optional<GridSeen> find_any_circle_grid(ImageView8 grey, const Board& board) {
  const std::vector<cv::Point2f> blobs = dark_blobs(grey);
  if (blobs.size() < 9 || blobs.size() > 2000) return std::nullopt;
  std::vector<std::pair<int, int>> sizes;
  for (int cols = 3; cols <= 14; ++cols) {
    for (int rows = 3; rows <= 14; ++rows) {
      if (static_cast<std::size_t>(cols * rows) == blobs.size()) sizes.emplace_back(cols, rows);
    }
  }
  // 24 blobs may be 6 x 4 or 8 x 3: the shape most like the board's first.
  const auto unlike = [&](const std::pair<int, int>& size) {
    return std::abs(std::log(static_cast<double>(size.first) * board.rows /
                             (static_cast<double>(size.second) * board.cols)));
  };
  std::sort(sizes.begin(), sizes.end(), [&](const auto& a, const auto& b) {
    return unlike(a) < unlike(b);
  });
  sizes.emplace_back(board.rows, board.cols);
  for (int less = 1; less <= 3; ++less) {
    sizes.emplace_back(board.cols - less, board.rows);
    sizes.emplace_back(board.cols, board.rows - less);
  }
  for (const auto& [cols, rows] : sizes) {
    if (cols < 3 || rows < 3 || (cols == board.cols && rows == board.rows)) continue;
    for (const bool asymmetric : {board.kind == BoardKind::kAsymmetricCircles}) {
      if (auto grid = grid_among(blobs, cols, rows, asymmetric)) return grid;
    }
  }
  return std::nullopt;
}

}  // namespace facula
