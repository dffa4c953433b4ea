// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/stripe/column_gate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace facula {
namespace {

constexpr std::size_t kLeastPlaces = 20;

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
    // A corner close to the camera may be seen farther out than whole numbers reach.
    const auto inside = [&](double y) { return std::clamp(y, -1.0, rows + 0.0); };
    const int from = std::max(0, static_cast<int>(std::ceil(inside(a.y()))));
    const int to = std::min(rows - 1, static_cast<int>(std::floor(inside(b.y()))));
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

/// Where the line is: row (or column) and position in it, and the same undistorted.
struct Place {
  double row;
  double position;
  double sigma;
  Eigen::Vector2d ray;  ///< on the plane z = 1, x along the searched row
};

/// x = offset + slope y on the plane z = 1: sheet and board meet in a straight line.
struct StraightLine {
  double offset = 0;
  double slope = 0;
  double off(const Eigen::Vector2d& ray) const { return ray.x() - offset - slope * ray.y(); }
};

/// The line that most places lie on, by the best of 400 pairs, then least squares over those that
/// agree.
StraightLine straight_line(const std::vector<Place>& places, double tolerance) {
  Random random(1);
  StraightLine best;
  std::size_t most = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Eigen::Vector2d& a = places[random.below(places.size())].ray;
    const Eigen::Vector2d& b = places[random.below(places.size())].ray;
    if (std::abs(a.y() - b.y()) < 10 * tolerance) continue;
    StraightLine line;
    line.slope = (b.x() - a.x()) / (b.y() - a.y());
    line.offset = a.x() - line.slope * a.y();
    const auto agree =
        static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [&](const Place& p) {
          return std::abs(line.off(p.ray)) < tolerance;
        }));
    if (agree > most) {
      most = agree;
      best = line;
    }
  }
  for (int round = 0; round < 3; ++round) {
    double n = 0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Place& p : places) {
      if (std::abs(best.off(p.ray)) >= tolerance) continue;
      mean += p.ray;
      n += 1;
    }
    if (n < 3) return best;
    mean /= n;
    double yy = 0;
    double xy = 0;
    for (const Place& p : places) {
      if (std::abs(best.off(p.ray)) >= tolerance) continue;
      yy += std::pow(p.ray.y() - mean.y(), 2);
      xy += (p.ray.y() - mean.y()) * (p.ray.x() - mean.x());
    }
    if (!(yy > 0)) return best;
    best.slope = xy / yy;
    best.offset = mean.x() - best.slope * mean.y();
  }
  return best;
}

/// How the camera's pixels look when rows are searched, or columns.
class SearchFrame {
 public:
  SearchFrame(const Camera& camera, StripeDirection direction)
      : camera_(camera), level_(direction == StripeDirection::kPerColumn) {}

  int rows() const { return level_ ? camera_.width : camera_.height; }
  int cols() const { return level_ ? camera_.height : camera_.width; }
  Eigen::Vector2d turned(const Eigen::Vector2d& p) const {
    return level_ ? Eigen::Vector2d(p.y(), p.x()) : p;
  }
  double pixels_per_ray() const { return level_ ? camera_.fy : camera_.fx; }

  std::vector<Place> places(const StripeProfile& profile) const {
    std::vector<Place> found;
    for (std::size_t r = 0; r < profile.size(); ++r) {
      if (profile.seen[r] == 0) continue;
      const Eigen::Vector2d at(profile.position[r], static_cast<double>(r));
      const auto ray = camera_.undistort(turned(at));
      if (ray) found.push_back({at.y(), at.x(), profile.sigma[r], turned(*ray)});
    }
    return found;
  }

  /// The columns within `reach` of the line and within the outline's spans.
  ColumnGate gate_about(const StraightLine& line,
                        const std::vector<Span>& spans,
                        double reach) const {
    ColumnGate gate;
    for (int r = 0; r < rows(); ++r) {
      const Span& span = spans[static_cast<std::size_t>(r)];
      double at = 0.5 * cols();
      // The line's place in this row: the row hardly depends on x, so two steps suffice.
      for (int step = 0; step < 3; ++step) {
        const auto ray = camera_.undistort(turned({at, static_cast<double>(r)}));
        if (!ray) break;
        at -= pixels_per_ray() * line.off(turned(*ray));
      }
      const int first = std::max(span.first, static_cast<int>(std::floor(at - reach)));
      const int end = std::min(span.last + 1, static_cast<int>(std::ceil(at + reach)) + 1);
      gate.first.push_back(first);
      gate.end.push_back(std::max(first, end));
    }
    return gate;
  }

 private:
  const Camera& camera_;
  bool level_;
};

ColumnGate gate_of(const std::vector<Span>& spans) {
  ColumnGate gate;
  for (const Span& span : spans) {
    gate.first.push_back(span.empty() ? 0 : span.first);
    gate.end.push_back(span.empty() ? 0 : span.last + 1);
  }
  return gate;
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
  const SearchFrame search(camera, options.stripe.direction);
  auto outline = outline_in_image(board, camera, camera_from_board, options.margin);
  for (Eigen::Vector2d& p : outline) p = search.turned(p);
  const std::vector<Span> spans = spans_of(outline, search.rows(), search.cols());

  LaserLineView line;
  line.direction = options.stripe.direction;
  std::vector<Place> places =
      search.places(detect_stripe(frame, background, options.stripe, gate_of(spans)));
  const std::size_t seen = places.size();
  if (seen >= kLeastPlaces) {
    const double tolerance = options.max_jump / search.pixels_per_ray();
    const StraightLine straight = straight_line(places, tolerance);
    const double reach = options.max_jump + 4 * options.stripe.sigma;
    places = search.places(detect_stripe(
        frame, background, options.stripe, search.gate_about(straight, spans, reach)));
    for (const Place& p : places) {
      if (std::abs(straight.off(p.ray)) > tolerance) continue;
      line.pixels.push_back(search.turned({p.position, p.row}));
      line.sigmas.push_back(p.sigma);
    }
  }
  if (line.pixels.size() < kLeastPlaces) {
    line.failure = "no laser line on the board: " + std::to_string(line.pixels.size()) + " of " +
                   std::to_string(seen) + " places lie on a straight line, " +
                   std::to_string(kLeastPlaces) +
                   " are needed; check that it crosses the board, its colour and its direction";
    line.pixels.clear();
    line.sigmas.clear();
  }
  return line;
}

}  // namespace facula
