// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board_detection.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace facula {
namespace {

cv::Mat mat_of(ImageView8 grey) {
  return {grey.rows,
          grey.cols,
          CV_8U,
          const_cast<std::uint8_t*>(grey.data),
          static_cast<std::size_t>(grey.stride)};
}

GridSeen grid_of(const std::vector<cv::Point2f>& corners, int cols, int rows) {
  GridSeen grid{cols, rows, {}};
  for (const cv::Point2f& p : corners) grid.pixels.emplace_back(p.x, p.y);
  return grid;
}

/// Half the window in which a corner is refined: as large as the squares allow, so that the noise
/// averages out, and never over a neighbour.
int refinement_reach(const std::vector<cv::Point2f>& corners, int cols) {
  double nearest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t step = static_cast<std::size_t>(cols);
    if (i + 1 < corners.size() && (i + 1) % step != 0) {
      nearest = std::min(nearest, cv::norm(corners[i + 1] - corners[i]));
    }
    if (i + step < corners.size()) {
      nearest = std::min(nearest, cv::norm(corners[i + step] - corners[i]));
    }
  }
  return std::clamp(static_cast<int>(0.4 * nearest), 2, 11);
}

bool shows_larger(ImageView8 grey, int cols, int rows) {
  const auto seen = find_any_chessboard(grey);
  return seen && (std::max(seen->cols, seen->rows) > std::max(cols, rows) ||
                  std::min(seen->cols, seen->rows) > std::min(cols, rows));
}

}  // namespace

std::optional<GridSeen> find_chessboard(ImageView8 grey, int cols, int rows) {
  if (cols < 3 || rows < 3) return std::nullopt;
  const cv::Mat image = mat_of(grey);
  std::vector<cv::Point2f> corners;
  try {
    bool found = cv::findChessboardCornersSB(
        image, {cols, rows}, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY);
    // The older search finds boards of which the newer one sees a part only, but takes many seconds
    // over a board that is larger than the wanted one.
    if (!found && !shows_larger(grey, cols, rows)) {
      found = cv::findChessboardCorners(
          image,
          {cols, rows},
          corners,
          cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK);
    }
    if (!found || corners.size() != static_cast<std::size_t>(cols * rows)) return std::nullopt;
    const int reach = refinement_reach(corners, cols);
    cv::cornerSubPix(image,
                     corners,
                     {reach, reach},
                     {-1, -1},
                     {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return grid_of(corners, cols, rows);
}

std::optional<GridSeen> find_any_chessboard(ImageView8 grey) {
  cv::Mat image = mat_of(grey);
  double shrink = 1;
  if (image.cols > 800) {
    shrink = 800.0 / image.cols;
    cv::resize(mat_of(grey), image, {}, shrink, shrink, cv::INTER_AREA);
  }
  std::vector<cv::Point2f> corners;
  cv::Mat meta;
  try {
    if (!cv::findChessboardCornersSB(
            image, {3, 3}, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER, meta)) {
      return std::nullopt;
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  for (cv::Point2f& p : corners) p *= 1 / shrink;
  return grid_of(corners, meta.cols, meta.rows);
}

}  // namespace facula
