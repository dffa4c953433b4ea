// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace facula {
namespace {

constexpr std::size_t kLeastPlaces = 20;
constexpr int kNeighbours = 12;  ///< on either side, of the line a place is judged by

/// Of an image row the columns within the outline [px]; empty when first > last.
struct Span {
  int first = 0;
  int last = -1;
  bool empty() const { return first > last; }
};

/// The outline of the board in the image, its sides cut into short pieces: distortion bends them.
std::vector<Eigen::Vector2d> outline_in_image(const Board& board,
                                              const Camera& camera,
                                              const RigidTransform& camera_from_board,
                                              double margin) {
  std::vector<Eigen::Vector2d> outline;
  const auto corners = board.outline(margin);
  constexpr int kPieces = 16;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& from = corners[i];
    const Eigen::Vector3d& to = corners[(i + 1) % corners.size()];
    for (int k = 0; k < kPieces; ++k) {
      const Eigen::Vector3d x = camera_from_board * (from + (to - from) * k / kPieces);
      if (x.z() > 1e-3) outline.push_back(camera.project(x));
    }
  }
  return outline;
}

std::vector<Span> spans_of(const std::vector<Eigen::Vector2d>& outline, int rows, int cols) {
  std::vector<Span> spans(static_cast<std::size_t>(rows), Span{cols, -1});
  for (std::size_t i = 0; i < outline.size(); ++i) {
    Eigen::Vector2d a = outline[i];
    Eigen::Vector2d b = outline[(i + 1) % outline.size()];
    if (a.y() > b.y()) std::swap(a, b);
    const int from = std::max(0, static_cast<int>(std::ceil(a.y())));
    const int to = std::min(rows - 1, static_cast<int>(std::floor(b.y())));
    for (int r = from; r <= to; ++r) {
      const double share = b.y() > a.y() ? (r - a.y()) / (b.y() - a.y()) : 0;
      const double x = std::clamp(a.x() + share * (b.x() - a.x()), -1.0, cols + 1.0);
      Span& span = spans[static_cast<std::size_t>(r)];
      span.first = std::min(span.first, std::max(0, static_cast<int>(std::ceil(x))));
      span.last = std::max(span.last, std::min(cols - 1, static_cast<int>(std::floor(x))));
    }
  }
  return spans;
}

/// The picture with all that lies beside the board painted over: where the line is searched along
/// rows, the outermost pixel of the board is repeated, so that no edge comes to be.
Image8 only_board(ImageView8 frame, const std::vector<Span>& spans) {
  Image8 image(frame.rows, frame.cols, frame.channels);
  const auto channels = static_cast<std::ptrdiff_t>(frame.channels);
  for (int r = 0; r < frame.rows; ++r) {
    const Span& span = spans[static_cast<std::size_t>(r)];
    if (span.empty()) continue;
    for (int c = 0; c < frame.cols; ++c) {
      const std::uint8_t* from = frame.row(r) + channels * std::clamp(c, span.first, span.last);
      std::copy(from, from + channels, image.row(r) + channels * c);
    }
  }
  return image;
}

/// The picture with rows and columns exchanged.
Image8 transposed(ImageView8 frame) {
  Image8 image(frame.cols, frame.rows, frame.channels);
  for (int r = 0; r < frame.rows; ++r) {
    for (int c = 0; c < frame.cols; ++c) {
      for (int k = 0; k < frame.channels; ++k) {
        image.row(c)[static_cast<std::ptrdiff_t>(r) * frame.channels + k] =
            frame.row(r)[static_cast<std::ptrdiff_t>(c) * frame.channels + k];
      }
    }
  }
  return image;
}

/// Where the line is, as (row, position in the row).
struct Place {
  double row;
  double position;
  double sigma;
};

/// Of the places within reach of place i, the line through them by the median of slopes (Theil and
/// Sen), and how far i lies off it [px].
double off_neighbours(const std::vector<Place>& places, std::size_t i) {
  const std::size_t first = i > kNeighbours ? i - kNeighbours : 0;
  const std::size_t last = std::min(places.size() - 1, i + kNeighbours);
  std::vector<double> slopes;
  for (std::size_t a = first; a < last; ++a) {
    for (std::size_t b = a + 1; b <= last; ++b) {
      slopes.push_back((places[b].position - places[a].position) / (places[b].row - places[a].row));
    }
  }
  const double slope = median(slopes);
  std::vector<double> offsets;
  for (std::size_t a = first; a <= last; ++a) {
    offsets.push_back(places[a].position - slope * (places[a].row - places[i].row));
  }
  return std::abs(places[i].position - median(offsets));
}

std::vector<Place> places_of(const StripeProfile& profile, const std::vector<Span>& spans) {
  std::vector<Place> places;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0 || spans[r].empty()) continue;
    // Half a line's width from the outline is cut off.
    const double room = 2.0 * profile.width[r];
    if (profile.position[r] < spans[r].first + room || profile.position[r] > spans[r].last - room) {
      continue;
    }
    places.push_back({static_cast<double>(r), profile.position[r], profile.sigma[r]});
  }
  return places;
}

}  // namespace

void BoardLineOptions::check() const {
  stripe.check();
  require(margin >= -1 && margin <= 5, "margin: expected -1 to 5 spacings, got ", margin);
  require(max_jump > 0, "max_jump_px: expected above 0, got ", max_jump);
}

LaserLineView find_line_on_board(ImageView8 frame,
                                 ImageView8 background,
                                 const Board& board,
                                 const Camera& camera,
                                 const RigidTransform& camera_from_board,
                                 const BoardLineOptions& options) {
  options.check();
  board.check();
  require(frame.cols == camera.width && frame.rows == camera.height,
          "expected a picture of the camera's ",
          camera.width,
          " x ",
          camera.height,
          " px, got ",
          frame.cols,
          " x ",
          frame.rows);
  const bool level = options.stripe.direction == StripeDirection::kPerColumn;
  auto outline = outline_in_image(board, camera, camera_from_board, options.margin);
  if (level) {
    for (Eigen::Vector2d& p : outline) std::swap(p.x(), p.y());
  }
  const Image8 turned = level ? transposed(frame) : Image8();
  const Image8 turned_dark = level && !background.empty() ? transposed(background) : Image8();
  const ImageView8 upright = level ? turned.view() : frame;
  const ImageView8 dark = level ? turned_dark.view() : background;
  const std::vector<Span> spans = spans_of(outline, upright.rows, upright.cols);
  StripeOptions stripe = options.stripe;
  stripe.direction = StripeDirection::kPerRow;
  const Image8 lit = only_board(upright, spans);
  const Image8 unlit = dark.empty() ? Image8() : only_board(dark, spans);
  const StripeProfile profile =
      detect_stripe(lit.view(), unlit.empty() ? ImageView8() : unlit.view(), stripe);

  LaserLineView line;
  line.direction = options.stripe.direction;
  const std::vector<Place> places = places_of(profile, spans);
  for (std::size_t i = 0; i < places.size() && places.size() >= kLeastPlaces; ++i) {
    if (off_neighbours(places, i) > options.max_jump) continue;
    const Place& p = places[i];
    line.pixels.emplace_back(level ? p.row : p.position, level ? p.position : p.row);
    line.sigmas.push_back(p.sigma);
  }
  if (line.pixels.size() < kLeastPlaces) {
    line.failure = "no laser line on the board: seen in " + std::to_string(places.size()) +
                   " places, " + std::to_string(kLeastPlaces) +
                   " are needed; check that it crosses the board, its colour and its direction";
    line.pixels.clear();
    line.sigmas.clear();
  }
  return line;
}

}  // namespace facula
