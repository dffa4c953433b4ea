// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/mesh/triangle_tree.hpp>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr std::size_t kLeaf = 4;  ///< triangles in a leaf [1]
constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
constexpr float kFar = std::numeric_limits<float>::infinity();

/// Every third bit of a 21-bit number.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32U) & 0x1f00000000ffffU;
  x = (x | x << 16U) & 0x1f0000ff0000ffU;
  x = (x | x << 8U) & 0x100f00f00f00f00fU;
  x = (x | x << 4U) & 0x10c30c30c30c30c3U;
  x = (x | x << 2U) & 0x1249249249249249U;
  return x;
}

std::uint64_t morton_code(const Eigen::Vector3d& share) {
  std::uint64_t code = 0;
  for (int k = 0; k < 3; ++k) {
    const auto cell = static_cast<std::uint64_t>(std::clamp(share[k], 0.0, 1.0) * 0x1fffff);
    code |= spread_bits(cell) << static_cast<unsigned>(k);
  }
  return code;
}

/// The height above a plane through `a`; the plane is left out where the triangle has no area.
double squared_height(const Eigen::Vector3d& ab,
                      const Eigen::Vector3d& ac,
                      const Eigen::Vector3d& ap,
                      double otherwise) {
  const Eigen::Vector3d normal = ab.cross(ac);
  const double area = normal.squaredNorm();
  const double height = normal.dot(ap);
  return area > 0 ? height * height / area : otherwise;
}

double to_segment(const Eigen::Vector3d& along, const Eigen::Vector3d& from_start) {
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp(from_start.dot(along) / length, 0.0, 1.0) : 0;
  return (share * along - from_start).squaredNorm();
}

}  // namespace

double squared_distance_to_triangle(const Eigen::Vector3d& point,
                                    const std::array<Eigen::Vector3f, 3>& corners) {
  const Eigen::Vector3d a = corners[0].cast<double>();
  const Eigen::Vector3d ab = corners[1].cast<double>() - a;
  const Eigen::Vector3d ac = corners[2].cast<double>() - a;
  const Eigen::Vector3d ap = point - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Eigen::Vector3d bp = ap - ab;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return to_segment(ab, ap);
  const Eigen::Vector3d cp = ap - ac;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return to_segment(ac, ap);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return to_segment(ac - ab, bp);
  return squared_height(ab, ac, ap, std::min(to_segment(ab, ap), to_segment(ac, ap)));
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  mesh.check();
  Eigen::AlignedBox3d bounds;
  corners_.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> finite;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<Eigen::Vector3f, 3> corners{
        mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    if (corners[0].allFinite() && corners[1].allFinite() && corners[2].allFinite()) {
      finite.push_back(static_cast<std::uint32_t>(corners_.size()));
      for (const Eigen::Vector3f& corner : corners) bounds.extend(corner.cast<double>());
    }
    corners_.push_back(corners);
  }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> coded;
  coded.reserve(finite.size());
  for (const std::uint32_t t : finite) {
    const auto& [a, b, c] = corners_[t];
    const Eigen::Vector3d centre = (a.cast<double>() + b.cast<double>() + c.cast<double>()) / 3;
    const double side = std::max(bounds.sizes().maxCoeff(), 1e-300);
    coded.emplace_back(morton_code((centre - bounds.min()) / side), t);
  }
  std::sort(coded.begin(), coded.end());
  for (const auto& [code, t] : coded) order_.push_back(t);
  leaves_ = 1;
  while (leaves_ * kLeaf < order_.size()) leaves_ *= 2;
  boxes_.assign(2 * leaves_, Box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}});
  const auto extend = [](Box& box, const Box& by) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], by.low[k]);
      box.high[k] = std::max(box.high[k], by.high[k]);
    }
  };
  for (std::size_t i = 0; i < order_.size(); ++i) {
    extend(boxes_[leaves_ + i / kLeaf], box_of(order_[i]));
  }
  for (std::size_t node = leaves_; node-- > 1;) {
    extend(boxes_[node], boxes_[2 * node]);
    extend(boxes_[node], boxes_[2 * node + 1]);
  }
}

TriangleTree::Box TriangleTree::box_of(std::uint32_t triangle) const {
  const auto& [a, b, c] = corners_[triangle];
  Box box{};
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    box.low[axis] = std::min({a[k], b[k], c[k]});
    box.high[axis] = std::max({a[k], b[k], c[k]});
  }
  return box;
}

double TriangleTree::squared_distance(const Box& box, const Eigen::Vector3d& point) const {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double outside = std::max({box.low[axis] - point[k], point[k] - box.high[axis], 0.0});
    sum += outside * outside;
  }
  return sum;
}

void TriangleTree::search_leaf(std::size_t leaf,
                               const Eigen::Vector3d& point,
                               Nearest& best) const {
  const std::size_t end = std::min((leaf + 1) * kLeaf, order_.size());
  for (std::size_t i = leaf * kLeaf; i < end; ++i) {
    const double squared = squared_distance_to_triangle(point, corners_[order_[i]]);
    if (squared < best.squared_distance) best = {squared, order_[i]};
  }
}

TriangleTree::Nearest TriangleTree::nearest(const Eigen::Vector3d& point, double within) const {
  Nearest best{within, kNone};
  descend(point, best);
  return best.triangle == kNone ? Nearest{} : best;
}

TriangleTree::Nearest TriangleTree::nearest_from(const Eigen::Vector3d& point,
                                                 std::uint32_t guess) const {
  Nearest best;
  if (guess < corners_.size()) {
    const double squared = squared_distance_to_triangle(point, corners_[guess]);
    if (squared < best.squared_distance) best = {squared, guess};  // not where it is not finite
  }
  descend(point, best);
  return best;
}

void TriangleTree::descend(const Eigen::Vector3d& point, Nearest& best) const {
  if (order_.empty()) return;
  std::array<std::pair<double, std::size_t>, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {squared_distance(boxes_[1], point), 1};
  while (depth > 0) {
    const auto [squared, node] = stack[--depth];
    if (!(squared < best.squared_distance)) continue;
    if (node >= leaves_) {
      search_leaf(node - leaves_, point, best);
      continue;
    }
    const double left = squared_distance(boxes_[2 * node], point);
    const double right = squared_distance(boxes_[2 * node + 1], point);
    const std::size_t nearer = left <= right ? 2 * node : 2 * node + 1;
    stack[depth++] = {std::max(left, right), nearer ^ 1U};
    stack[depth++] = {std::min(left, right), nearer};
  }
}

void TriangleTree::add_meeting(std::uint32_t triangle, std::vector<std::uint32_t>& found) const {
  if (order_.empty()) return;
  const Box own = box_of(triangle);
  const auto meets = [&](const Box& box) {
    return own.low[0] <= box.high[0] && box.low[0] <= own.high[0] && own.low[1] <= box.high[1] &&
           box.low[1] <= own.high[1] && own.low[2] <= box.high[2] && box.low[2] <= own.high[2];
  };
  std::array<std::size_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 1;
  while (depth > 0) {
    const std::size_t node = stack[--depth];
    if (!meets(boxes_[node])) continue;
    if (node < leaves_) {
      stack[depth++] = 2 * node;
      stack[depth++] = 2 * node + 1;
      continue;
    }
    const std::size_t end = std::min((node - leaves_ + 1) * kLeaf, order_.size());
    for (std::size_t i = (node - leaves_) * kLeaf; i < end; ++i) {
      if (order_[i] > triangle && meets(box_of(order_[i]))) found.push_back(order_[i]);
    }
  }
}

}  // namespace facula
