// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/measure/bounding_rectangle.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a;
  const Eigen::Vector2d ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

}  // namespace

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  // Andrew's monotone chain (1979).
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
  const auto add_chain = [&hull](auto first, auto last) {
    const std::size_t base = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), *first) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*first);
    }
    hull.pop_back();  // the next chain starts with it
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

double polygon_area(const std::vector<Eigen::Vector2d>& corners) {
  double twice = 0;
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    twice += turn(corners[0], corners[i + 1], corners[i + 2]);
  }
  return twice / 2;
}

double smallest_width(const std::vector<Eigen::Vector2d>& hull) {
  if (hull.size() < 3) return 0;
  double least = INFINITY;
  // One of the lines lies along an edge of the polygon (Houle and Toussaint 1988).
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d& from = hull[i];
    const Eigen::Vector2d& to = hull[(i + 1) % hull.size()];
    double most = 0;
    for (const Eigen::Vector2d& p : hull) most = std::max(most, turn(from, to, p));
    least = std::min(least, most / (to - from).norm());
  }
  return least;
}

RectangleSides smallest_bounding_rectangle(std::vector<Eigen::Vector2d> points) {
  if (points.empty()) return {};
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(points));
  RectangleSides best;
  double best_area = INFINITY;
  // One side of the rectangle of least area lies along an edge of the hull (Freeman, Shapira 1975).
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    if (edge.norm() == 0) continue;
    const Eigen::Vector2d u = edge.normalized();
    const Eigen::Vector2d v(-u.y(), u.x());
    Eigen::Array2d low = Eigen::Array2d::Constant(INFINITY);
    Eigen::Array2d high = Eigen::Array2d::Constant(-INFINITY);
    for (const Eigen::Vector2d& p : hull) {
      const Eigen::Array2d position(p.dot(u), p.dot(v));
      low = low.min(position);
      high = high.max(position);
    }
    const Eigen::Array2d side = high - low;
    if (side.prod() >= best_area) continue;
    best_area = side.prod();
    best = {side.maxCoeff(), side.minCoeff()};
  }
  return best;
}

}  // namespace facula
