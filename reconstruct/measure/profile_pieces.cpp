// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/reconstruct/measure/profile_pieces.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

using Profile = std::vector<Eigen::Vector2d>;

constexpr double kSameDirection = 0.0873;  // 5 degrees

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Noise of the heights from their second differences, which straight parts do not raise.
double noise_of(const Profile& profile) {
  std::vector<double> bends;
  for (std::size_t i = 2; i < profile.size(); ++i) {
    const double bend = profile[i - 2].y() - 2 * profile[i - 1].y() + profile[i].y();
    if (std::isfinite(bend)) bends.push_back(std::abs(bend));
  }
  return 1.4826 * median(bends) / std::sqrt(6.0);
}

ProfilePiece fitted(const Profile& profile, const ProfileSpan& span) {
  ProfilePiece piece;
  piece.span = span;
  const double n = static_cast<double>(span.last - span.first);
  for (std::size_t i = span.first; i < span.last; ++i) piece.middle += profile[i] / n;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (std::size_t i = span.first; i < span.last; ++i) {
    const Eigen::Vector2d d = profile[i] - piece.middle;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
  piece.direction = solver.eigenvectors().col(1);
  if (piece.direction.x() < 0) piece.direction = -piece.direction;
  piece.scatter = std::sqrt(std::max(0.0, solver.eigenvalues()(0)) / std::max(1.0, n - 2));
  piece.offset_sigma = piece.scatter / std::sqrt(n);
  piece.angle_sigma =
      solver.eigenvalues()(1) > 0 ? piece.scatter / std::sqrt(solver.eigenvalues()(1)) : 0;
  return piece;
}

bool serves(const Profile& profile, const ProfilePiece& piece, double tolerance) {
  for (std::size_t i = piece.span.first; i < piece.span.last; ++i) {
    if (std::abs(piece.normal().dot(profile[i] - piece.middle)) > tolerance) return false;
  }
  return true;
}

/// Where to cut a stretch that leaves its chord by more than the tolerance; nothing where it does
/// not.
std::optional<std::size_t> cut_of(const Profile& profile,
                                  const ProfileSpan& span,
                                  double tolerance) {
  const Eigen::Vector2d& from = profile[span.first];
  const Eigen::Vector2d chord = profile[span.last - 1] - from;
  const double length = chord.norm();
  double farthest = 0;
  std::size_t at = span.first;
  for (std::size_t i = span.first; i < span.last; ++i) {
    const Eigen::Vector2d d = profile[i] - from;
    const double away = length > 0 ? std::abs(cross(chord, d)) / length : d.norm();
    if (away <= farthest) continue;
    farthest = away;
    at = i;
  }
  if (farthest <= tolerance || span.last - span.first < 4) return std::nullopt;
  // The farthest point goes with its nearer neighbour: on a step, to its own level.
  const bool with_next =
      at + 1 < span.last && at > span.first &&
      (profile[at + 1] - profile[at]).norm() < (profile[at] - profile[at - 1]).norm();
  return std::clamp(with_next ? at : at + 1, span.first + 1, span.last - 1);
}

std::vector<ProfileSpan> split(const Profile& profile, double tolerance) {
  std::vector<ProfileSpan> waiting{{0, profile.size()}};
  std::vector<ProfileSpan> found;
  while (!waiting.empty()) {
    const ProfileSpan span = waiting.back();
    waiting.pop_back();
    if (const auto cut = cut_of(profile, span, tolerance)) {
      waiting.push_back({*cut, span.last});
      waiting.push_back({span.first, *cut});
    } else {
      found.push_back(span);
    }
  }
  return found;
}

/// Joins neighbours while one line serves both.
std::vector<ProfilePiece> joined(const Profile& profile,
                                 const std::vector<ProfileSpan>& spans,
                                 double tolerance) {
  std::vector<ProfilePiece> pieces;
  for (const ProfileSpan& span : spans) {
    ProfilePiece piece = fitted(profile, span);
    while (!pieces.empty()) {
      const ProfilePiece both = fitted(profile, {pieces.back().span.first, span.last});
      if (!serves(profile, both, tolerance)) break;
      piece = both;
      pieces.pop_back();
    }
    pieces.push_back(piece);
  }
  return pieces;
}

/// Where two lines meet, and how unsure the place is along the first line.
struct Corner {
  double along = 0;  // from the first line's middle [m]
  double sigma = 0;  // of that [m]
};

std::optional<Corner> corner_of(const ProfilePiece& line, const ProfilePiece& other) {
  const double sine = cross(line.direction, other.direction);
  if (std::abs(sine) < std::sin(kSameDirection)) return std::nullopt;
  const Eigen::Vector2d apart = other.middle - line.middle;
  Corner corner;
  corner.along = cross(apart, other.direction) / sine;
  const double other_along = cross(apart, line.direction) / sine;
  // Moving either line square to itself by 1 at the corner moves the corner along the first by
  // 1 / sin and by 1 / tan of the angle between them.
  const double own = std::hypot(line.offset_sigma, line.angle_sigma * corner.along);
  const double others = std::hypot(other.offset_sigma, other.angle_sigma * other_along);
  const double cosine = line.direction.dot(other.direction);
  corner.sigma = std::hypot(others / sine, own * cosine / sine);
  return corner;
}

}  // namespace

void ProfilePieceOptions::check() const {
  require(tolerance >= 0 && std::isfinite(tolerance),
          "expected a tolerance of 0 mm or more, got ",
          1000 * tolerance);
  require(min_points >= 5, "expected pieces of 5 points or more, got ", min_points);
}

std::vector<ProfilePiece> straight_pieces(const Profile& profile,
                                          const ProfilePieceOptions& options) {
  options.check();
  for (std::size_t i = 0; i < profile.size(); ++i) {
    require(profile[i].allFinite(), "expected a profile of finite points, number ", i, " is not");
  }
  if (profile.size() < options.min_points) return {};
  const double tolerance =
      options.tolerance > 0 ? options.tolerance : std::max(5 * noise_of(profile), 1e-9);
  std::vector<ProfilePiece> pieces = joined(profile, split(profile, tolerance), tolerance);
  std::erase_if(pieces, [&](const ProfilePiece& piece) {
    return piece.span.last - piece.span.first < options.min_points;
  });
  return pieces;
}

std::optional<ProfileLength> side_length(const Profile& profile,
                                         const std::vector<ProfilePiece>& pieces,
                                         std::size_t piece,
                                         double gap) {
  if (piece == 0 || piece + 1 >= pieces.size()) return std::nullopt;
  const ProfilePiece& side = pieces[piece];
  const std::optional<Corner> left = corner_of(side, pieces[piece - 1]);
  const std::optional<Corner> right = corner_of(side, pieces[piece + 1]);
  if (!left || !right) return std::nullopt;
  const auto along = [&](std::size_t i) { return side.direction.dot(profile[i] - side.middle); };
  if (std::abs(left->along - along(side.span.first)) > gap ||
      std::abs(right->along - along(side.span.last - 1)) > gap) {
    return std::nullopt;
  }
  return ProfileLength{right->along - left->along, std::hypot(left->sigma, right->sigma)};
}

StepMeasure step_between(const Profile& profile,
                         const ProfilePiece& base,
                         const ProfilePiece& top) {
  return measure_step(profile, base.span, top.span);
}

std::optional<std::size_t> base_piece(const std::vector<ProfilePiece>& pieces) {
  std::optional<std::size_t> lowest;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (std::abs(std::atan2(pieces[i].direction.y(), pieces[i].direction.x())) > kSameDirection) {
      continue;
    }
    if (!lowest || pieces[i].middle.y() < pieces[*lowest].middle.y()) lowest = i;
  }
  return lowest;
}

}  // namespace facula
