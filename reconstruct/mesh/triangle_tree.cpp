// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/mesh/triangle_tree.hpp>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr std::size_t kLeaf = 4;  ///< triangles in a leaf [1]
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

double squared_distance_to_segment(const Eigen::Vector3d& p,
                                   const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0;
  return (a + share * along - p).squaredNorm();
}

}  // namespace

double squared_distance_to_triangle(const Eigen::Vector3d& point,
                                    const std::array<Eigen::Vector3f, 3>& corners) {
  const Eigen::Vector3d a = corners[0].cast<double>();
  const Eigen::Vector3d b = corners[1].cast<double>();
  const Eigen::Vector3d c = corners[2].cast<double>();
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  const auto left_of = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return normal.dot((to - from).cross(point - from)) >= 0;
  };
  if (area > 0 && left_of(a, b) && left_of(b, c) && left_of(c, a)) {
    const double height = normal.dot(point - a);
    return height * height / area;
  }
  return std::min({squared_distance_to_segment(point, a, b),
                   squared_distance_to_segment(point, b, c),
                   squared_distance_to_segment(point, c, a)});
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
  Nearest best;
  if (order_.empty()) return best;
  best.squared_distance = within;
  bool found = false;
  std::array<std::pair<double, std::size_t>, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {squared_distance(boxes_[1], point), 1};
  while (depth > 0) {
    const auto [squared, node] = stack[--depth];
    if (!(squared < best.squared_distance)) continue;
    if (node >= leaves_) {
      const double before = best.squared_distance;
      search_leaf(node - leaves_, point, best);
      found = found || best.squared_distance < before;
      continue;
    }
    const double left = squared_distance(boxes_[2 * node], point);
    const double right = squared_distance(boxes_[2 * node + 1], point);
    const std::size_t nearer = left <= right ? 2 * node : 2 * node + 1;
    stack[depth++] = {std::max(left, right), nearer ^ 1U};
    stack[depth++] = {std::min(left, right), nearer};
  }
  return found ? best : Nearest{};
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
