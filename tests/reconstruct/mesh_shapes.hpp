// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/tests/support/meshes.hpp>

#include <cmath>
#include <cstdint>
#include <functional>

#include <Eigen/Core>

namespace facula {

/// A grid of rows x cols vertices joined by two triangles per square, seen from the side where rows
/// x cols is right-handed. A wrapped direction joins its last line to its first.
inline TriangleMesh grid_surface(std::uint32_t rows,
                                 std::uint32_t cols,
                                 const std::function<Eigen::Vector3d(double, double)>& at,
                                 bool wrap_rows = false,
                                 bool wrap_cols = false) {
  TriangleMesh mesh;
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < cols; ++c) {
      mesh.vertices.push_back(
          at(double(r) / (wrap_rows ? rows : rows - 1), double(c) / (wrap_cols ? cols : cols - 1))
              .cast<float>());
    }
  }
  const auto index = [&](std::uint32_t r, std::uint32_t c) { return r % rows * cols + c % cols; };
  for (std::uint32_t r = 0; r < (wrap_rows ? rows : rows - 1); ++r) {
    for (std::uint32_t c = 0; c < (wrap_cols ? cols : cols - 1); ++c) {
      mesh.triangles.push_back({index(r, c), index(r + 1, c), index(r + 1, c + 1)});
      mesh.triangles.push_back({index(r, c), index(r + 1, c + 1), index(r, c + 1)});
    }
  }
  return mesh;
}

/// A torus about the z axis: radius of its spine and of its tube [m].
inline TriangleMesh torus(double spine, double tube, std::uint32_t around, std::uint32_t across) {
  const auto at = [&](double u, double v) {
    const double a = 2 * M_PI * u;
    const double b = 2 * M_PI * v;
    return Eigen::Vector3d((spine + tube * std::cos(b)) * std::cos(a),
                           (spine + tube * std::cos(b)) * std::sin(a),
                           tube * std::sin(b));
  };
  return grid_surface(around, across, at, true, true);
}

/// An octahedron split `depth` times with its vertices on the sphere: 8 * 4^depth triangles.
inline TriangleMesh sphere_mesh(double radius, int depth) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {
      {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < depth; ++level) {
    TriangleMesh finer;
    finer.vertices = mesh.vertices;
    std::vector<std::array<std::uint32_t, 3>> halves;  // low, high, middle
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      if (a > b) std::swap(a, b);
      finer.vertices.push_back((mesh.vertices[a].cast<double>() + mesh.vertices[b].cast<double>())
                                   .normalized()
                                   .cast<float>());
      return std::uint32_t(finer.vertices.size() - 1);
    };
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> known(mesh.vertices.size());
    const auto shared_middle = [&](std::uint32_t a, std::uint32_t b) {
      for (const auto& [other, m] : known[std::min(a, b)]) {
        if (other == std::max(a, b)) return m;
      }
      const std::uint32_t m = middle(a, b);
      known[std::min(a, b)].emplace_back(std::max(a, b), m);
      return m;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = shared_middle(a, b);
      const std::uint32_t bc = shared_middle(b, c);
      const std::uint32_t ca = shared_middle(c, a);
      finer.triangles.insert(finer.triangles.end(),
                             {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh = finer;
  }
  for (Eigen::Vector3f& v : mesh.vertices) v *= float(radius);
  return mesh;
}

/// Adds a mesh, moved.
inline void add_mesh(TriangleMesh& mesh, const TriangleMesh& more, const Eigen::Vector3f& by) {
  const auto first = std::uint32_t(mesh.vertices.size());
  for (const Eigen::Vector3f& v : more.vertices) mesh.vertices.emplace_back(v + by);
  for (const auto& [a, b, c] : more.triangles) {
    mesh.triangles.push_back({a + first, b + first, c + first});
  }
}

/// The mesh without the triangles whose centre is in `gone`.
inline TriangleMesh without(const TriangleMesh& mesh,
                            const std::function<bool(const Eigen::Vector3f&)>& gone) {
  TriangleMesh rest = mesh;
  std::erase_if(rest.triangles, [&](const TriangleMesh::Triangle& t) {
    return gone((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  });
  return rest;
}

}  // namespace facula
