// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board_detection.hpp>
#include <facula/acquire/calibrate/board_pattern.hpp>
#include <facula/acquire/core/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace facula {
namespace {

using cv::aruco::PREDEFINED_DICTIONARY_NAME;

constexpr std::array<std::pair<const char*, PREDEFINED_DICTIONARY_NAME>, 16> kDictionaries = {{
    {"4x4_50", cv::aruco::DICT_4X4_50},
    {"4x4_100", cv::aruco::DICT_4X4_100},
    {"4x4_250", cv::aruco::DICT_4X4_250},
    {"4x4_1000", cv::aruco::DICT_4X4_1000},
    {"5x5_50", cv::aruco::DICT_5X5_50},
    {"5x5_100", cv::aruco::DICT_5X5_100},
    {"5x5_250", cv::aruco::DICT_5X5_250},
    {"5x5_1000", cv::aruco::DICT_5X5_1000},
    {"6x6_50", cv::aruco::DICT_6X6_50},
    {"6x6_100", cv::aruco::DICT_6X6_100},
    {"6x6_250", cv::aruco::DICT_6X6_250},
    {"6x6_1000", cv::aruco::DICT_6X6_1000},
    {"7x7_50", cv::aruco::DICT_7X7_50},
    {"7x7_100", cv::aruco::DICT_7X7_100},
    {"7x7_250", cv::aruco::DICT_7X7_250},
    {"7x7_1000", cv::aruco::DICT_7X7_1000},
}};

cv::Ptr<cv::aruco::Dictionary> dictionary_of(const Board& board) {
  for (const auto& [name, number] : kDictionaries) {
    if (board.dictionary != name) continue;
    auto dictionary = cv::aruco::getPredefinedDictionary(number);
    const int needed = (board.cols + 1) * (board.rows + 1) / 2;
    require(dictionary->bytesList.rows >= needed,
            "a ChArUco board of ",
            board.cols,
            " x ",
            board.rows,
            " corners holds ",
            needed,
            " markers, dictionary '",
            board.dictionary,
            "' has ",
            dictionary->bytesList.rows,
            "; take a larger one");
    return dictionary;
  }
  fail("expected a dictionary 4x4_50 to 7x7_1000 (bits, then 50, 100, 250 or 1000 markers), got '",
       board.dictionary,
       "'");
}

/// Corners as the module leaves them count pixel corners, not centres, as whole numbers, and some
/// are drawn to a marker's corner. Those near where one homography has them are refined from there,
/// in a window that ends before the markers; the others are dropped.
void refine(const cv::Mat& image,
            const Board& board,
            std::vector<int>& ids,
            std::vector<cv::Point2f>& corners) {
  if (ids.size() < 4) return;
  std::vector<cv::Point2f> on_board;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    corners[i] -= cv::Point2f(0.5F, 0.5F);
    const Eigen::Vector3d p = board.point(ids[i]) / board.spacing;
    on_board.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  cv::theRNG().state = 1;
  const cv::Mat homography = cv::findHomography(on_board, corners, cv::RANSAC, 2.0);
  if (homography.empty()) return;
  std::vector<cv::Point2f> expected;
  cv::perspectiveTransform(on_board, expected, homography);
  std::vector<int> kept_ids;
  std::vector<cv::Point2f> kept;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::vector<cv::Point2f> beside = {{on_board[i].x + 0.7F, on_board[i].y + 0.7F},
                                       {on_board[i].x - 0.7F, on_board[i].y + 0.7F}};
    cv::perspectiveTransform(beside, beside, homography);
    const double gap = 0.5 * (1 - board.marker_side() / board.spacing);
    const double diagonal =
        std::min(cv::norm(beside[0] - expected[i]), cv::norm(beside[1] - expected[i]));
    const int reach = std::clamp(static_cast<int>(gap * diagonal), 2, 8);
    const double stray = std::max(1.5, 0.5 * reach);
    std::vector<cv::Point2f> corner = {cv::norm(corners[i] - expected[i]) < stray ? corners[i]
                                                                                  : expected[i]};
    const cv::Point2f from = corner[0];
    const cv::Rect2f inside(static_cast<float>(reach) + 2,
                            static_cast<float>(reach) + 2,
                            static_cast<float>(image.cols - 2 * reach - 4),
                            static_cast<float>(image.rows - 2 * reach - 4));
    if (!inside.contains(from)) continue;
    cv::cornerSubPix(image,
                     corner,
                     {reach, reach},
                     {-1, -1},
                     {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
    if (cv::norm(corner[0] - from) > stray) continue;
    kept_ids.push_back(ids[i]);
    kept.push_back(corner[0]);
  }
  ids = kept_ids;
  corners = kept;
}

}  // namespace

std::vector<MarkerBits> charuco_markers(const Board& board) {
  const auto dictionary = dictionary_of(board);
  const int needed = (board.cols + 1) * (board.rows + 1) / 2;
  std::vector<MarkerBits> markers;
  for (int i = 0; i < needed; ++i) {
    const cv::Mat bits = cv::aruco::Dictionary::getBitsFromByteList(dictionary->bytesList.row(i),
                                                                    dictionary->markerSize);
    markers.push_back({bits.rows, {bits.begin<std::uint8_t>(), bits.end<std::uint8_t>()}});
  }
  return markers;
}

CharucoSeen find_charuco(ImageView8 grey, const Board& board) {
  const auto dictionary = dictionary_of(board);
  const auto charuco = cv::aruco::CharucoBoard::create(board.cols + 1,
                                                       board.rows + 1,
                                                       static_cast<float>(board.spacing),
                                                       static_cast<float>(board.marker_side()),
                                                       dictionary);
  const cv::Mat image(grey.rows,
                      grey.cols,
                      CV_8U,
                      const_cast<std::uint8_t*>(grey.data),
                      static_cast<std::size_t>(grey.stride));
  CharucoSeen seen;
  try {
    std::vector<int> marker_ids;
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<std::vector<cv::Point2f>> rejected;
    cv::aruco::detectMarkers(
        image, dictionary, markers, marker_ids, cv::aruco::DetectorParameters::create(), rejected);
    seen.markers = static_cast<int>(marker_ids.size());
    if (marker_ids.empty()) return seen;
    std::vector<cv::Point2f> corners;
    std::vector<int> ids;
    cv::aruco::interpolateCornersCharuco(markers, marker_ids, image, charuco, corners, ids);
    refine(image, board, ids, corners);
    std::vector<std::size_t> order(ids.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return ids[a] < ids[b]; });
    for (const std::size_t i : order) {
      seen.ids.push_back(ids[i]);
      seen.pixels.emplace_back(corners[i].x, corners[i].y);
    }
  } catch (const cv::Exception&) {
    return {};
  }
  return seen;
}

}  // namespace facula
