// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/measure/deviation_mesh_sign.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

Corners corners_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a].cast<double>(),
          mesh.vertices[b].cast<double>(),
          mesh.vertices[c].cast<double>()};
}

Eigen::Vector3d face_normal(const Corners& x) {
  const Eigen::Vector3d n = (x[1] - x[0]).cross(x[2] - x[0]);
  const double length = n.norm();
  return length > 0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::Zero();
}

double angle_at(const Corners& x, std::size_t i) {
  const Eigen::Vector3d u = x[(i + 1) % 3] - x[i];
  const Eigen::Vector3d v = x[(i + 2) % 3] - x[i];
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

/// The part of a triangle that a place on it belongs to: edge i runs from corner i to i + 1.
struct Feature {
  enum Kind { kFace, kEdge, kCorner } kind = kFace;
  std::size_t number = 0;
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
};

/// The place of the segment from a to b nearest to p, as a share of the way.
double share_along(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double squared = (b - a).squaredNorm();
  return squared > 0 ? std::clamp((p - a).dot(b - a) / squared, 0.0, 1.0) : 0.0;
}

Feature nearest_feature(const Corners& x, const Eigen::Vector3d& normal, const Eigen::Vector3d& p) {
  bool over_face = normal.squaredNorm() > 0;
  for (std::size_t i = 0; i < 3 && over_face; ++i) {
    over_face = normal.dot((x[(i + 1) % 3] - x[i]).cross(p - x[i])) > 0;
  }
  if (over_face) return {Feature::kFace, 0, p - normal * normal.dot(p - x[0])};
  Feature best;
  double least = INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double share = share_along(p, x[i], x[j]);
    const Eigen::Vector3d at = x[i] + share * (x[j] - x[i]);
    const double squared = (p - at).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    best = {Feature::kEdge, i, at};
    if (share == 0) best.kind = Feature::kCorner;
    if (share == 1) best = {Feature::kCorner, j, at};
  }
  return best;
}

}  // namespace

MeshSides::MeshSides(const TriangleMesh& mesh) : mesh_(mesh) {
  faces_.reserve(mesh.triangles.size());
  corners_.assign(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners x = corners_of(mesh, t);
    faces_.push_back(face_normal(x));
    for (std::size_t i = 0; i < 3; ++i) {
      corners_[mesh.triangles[t][i]] += angle_at(x, i) * faces_.back();
    }
  }
  collect_edges();
}

void MeshSides::collect_edges() {
  struct Half {
    std::uint32_t low, high, triangle, edge;
  };
  std::vector<Half> halves;
  halves.reserve(3 * mesh_.triangles.size());
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(mesh_.triangles[t][i], mesh_.triangles[t][(i + 1) % 3]);
      halves.push_back({low, high, t, i});
    }
  }
  std::sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  edges_.resize(mesh_.triangles.size());
  rim_edge_.resize(mesh_.triangles.size());
  rim_corner_.assign(mesh_.vertices.size(), false);
  for (std::size_t begin = 0; begin < halves.size();) {
    std::size_t end = begin;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    while (end < halves.size() && halves[end].low == halves[begin].low &&
           halves[end].high == halves[begin].high) {
      sum += faces_[halves[end++].triangle];
    }
    const bool rim = end == begin + 1;
    if (rim) rim_corner_[halves[begin].low] = rim_corner_[halves[begin].high] = true;
    for (; begin < end; ++begin) {
      edges_[halves[begin].triangle][halves[begin].edge] = sum;
      rim_edge_[halves[begin].triangle][halves[begin].edge] = rim;
    }
  }
}

MeshSides::Place MeshSides::place(const Eigen::Vector3d& point, std::uint32_t triangle) const {
  const Feature feature = nearest_feature(corners_of(mesh_, triangle), faces_[triangle], point);
  Place place{feature.nearest};
  Eigen::Vector3d normal = faces_[triangle];
  if (feature.kind == Feature::kEdge) {
    normal = edges_[triangle][feature.number];
    place.on_rim = rim_edge_[triangle][feature.number];
  } else if (feature.kind == Feature::kCorner) {
    const std::uint32_t vertex = mesh_.triangles[triangle][feature.number];
    normal = corners_[vertex];
    place.on_rim = rim_corner_[vertex];
  }
  place.in_front = normal.dot(point - feature.nearest) >= 0;
  return place;
}

}  // namespace facula
