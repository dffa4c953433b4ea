// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_warnings.hpp>
#include <facula/acquire/core/median.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <numbers>
#include <sstream>

namespace facula {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

void warn_of_tilts(CameraCalibration& result) {
  std::vector<RigidTransform> poses;
  for (const CalibratedView& view : result.views) poses.push_back(view.camera_from_board);
  const double spread = largest_turn_between_normals(poses);
  if (spread > 20 * kDegree) return;
  result.warnings.push_back(
      sentence("too little tilt: the boards differ by ",
               spread / kDegree,
               " degrees at most, focal length and principal point lean on that; add pictures "
               "tilted by 20 to 45 degrees"));
}

/// Ninths of the image that hold no point.
void warn_of_cover(const std::vector<BoardView>& views, CameraCalibration& result) {
  static constexpr std::array<const char*, 9> kPlaces = {"upper left",
                                                         "top",
                                                         "upper right",
                                                         "left",
                                                         "middle",
                                                         "right",
                                                         "lower left",
                                                         "bottom",
                                                         "lower right"};
  std::array<int, 9> points{};
  for (const BoardView& view : views) {
    for (const Eigen::Vector2d& p : view.pixels) {
      const double col = std::floor(std::clamp(3 * p.x() / view.image_width, 0.0, 2.0));
      const double row = std::floor(std::clamp(3 * p.y() / view.image_height, 0.0, 2.0));
      ++points[static_cast<std::size_t>(3 * row + col)];
    }
  }
  std::string empty;
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i] > 0) continue;
    empty += (empty.empty() ? "" : ", ") + std::string(kPlaces[i]);
    ++count;
  }
  if (count == 0) return;
  result.warnings.push_back(
      sentence("no points in ",
               count,
               " of 9 parts of the image (",
               empty,
               "); the distortion is guessed there; show the board there too"));
}

void warn_of_sigmas(CameraCalibration& result) {
  const double share = std::sqrt(result.covariance(0, 0)) / result.camera.fx;
  if (share > 3e-3) {
    result.warnings.push_back(sentence(
        "the focal length is known to ",
        100 * share,
        " % only (1 sigma); add pictures tilted by 20 to 45 degrees in different directions"));
  }
  const double centre = std::sqrt(std::max(result.covariance(2, 2), result.covariance(3, 3)));
  if (centre > 0.01 * result.camera.width) {
    result.warnings.push_back(sentence("the principal point is known to ",
                                       centre,
                                       " px only (1 sigma); tilt the board to all four sides"));
  }
}

void warn_of_blur(const std::vector<BoardView>& views, CameraCalibration& result) {
  std::vector<double> widths;
  for (const BoardView& view : views) {
    if (view.sharpness > 0) widths.push_back(view.sharpness);
  }
  if (widths.empty()) return;
  const double usual = median(widths);
  for (const BoardView& view : views) {
    if (view.sharpness > std::max(4.0, 1.7 * usual)) {
      result.warnings.push_back(sentence("'",
                                         view.name,
                                         "' is blurred: edges ",
                                         view.sharpness,
                                         " px wide, ",
                                         usual,
                                         " px in the others"));
    }
  }
}

}  // namespace

double largest_turn_between_normals(const std::vector<RigidTransform>& camera_from_board) {
  double least = 1;
  for (std::size_t a = 0; a < camera_from_board.size(); ++a) {
    for (std::size_t b = a + 1; b < camera_from_board.size(); ++b) {
      const Eigen::Vector3d za = camera_from_board[a].rotation * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d zb = camera_from_board[b].rotation * Eigen::Vector3d::UnitZ();
      least = std::min(least, std::abs(za.dot(zb)));
    }
  }
  return std::acos(std::clamp(least, 0.0, 1.0));
}

void add_camera_warnings(const Board& board,
                         const std::vector<BoardView>& views,
                         CameraCalibration& result) {
  if (views.size() < 8) {
    result.warnings.push_back(
        sentence("only ", views.size(), " views; 10 to 20 make the errors average out"));
  }
  warn_of_tilts(result);
  warn_of_cover(views, result);
  warn_of_sigmas(result);
  warn_of_blur(views, result);
  if (!(result.held_out_rms < 1.5 * result.rms)) {
    result.warnings.push_back(sentence("views left out of the fit lie ",
                                       result.held_out_rms,
                                       " px off, those in it ",
                                       result.rms,
                                       " px: the views hang on each other too little; add more"));
  }
  const bool circles =
      board.kind == BoardKind::kCircles || board.kind == BoardKind::kAsymmetricCircles;
  if (circles && board.circle_diameter == 0) {
    result.warnings.push_back(
        "the circles' diameter is not given: the centre of a tilted circle's image is not the "
        "image "
        "of its centre, and that stays in the result; give the diameter to take it out");
  }
}

}  // namespace facula
