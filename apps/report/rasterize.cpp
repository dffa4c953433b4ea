// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/apps/report/rasterize.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr int kBand = 16;  // rows of the picture that one piece of work fills [px]

/// Vertex in the picture: x right, y down [px], z towards the viewer [m].
using Projected = Eigen::Vector3d;

struct Span {
  int begin = 0;
  int end = 0;
};

std::vector<Projected> project(const TriangleMesh& mesh,
                               const RasterView& view,
                               const ParallelOptions& parallel) {
  std::vector<Projected> projected(mesh.vertices.size());
  const auto project_some = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d x = mesh.vertices[i].cast<double>() - view.center;
      projected[i] = {(view.cols - 1) / 2.0 + view.pixels_per_metre * x.dot(view.direction.right),
                      (view.rows - 1) / 2.0 - view.pixels_per_metre * x.dot(view.direction.up),
                      x.dot(view.direction.towards_viewer)};
    }
  };
  parallel_for(mesh.vertices.size(), project_some, parallel);
  return projected;
}

/// Pixels whose centres lie within [low, high], cut to [0, count).
Span pixels_within(double low, double high, int count) {
  if (!(high >= 0) || !(low <= count - 1)) return {};
  return {static_cast<int>(std::ceil(std::max(low, 0.0))),
          static_cast<int>(std::floor(std::min(high, count - 1.0))) + 1};
}

/// Normals of the triangles around each vertex, weighted by their angles there (Thürmer and
/// Wüthrich 1998): how a flat face is cut into triangles does not tilt them.
std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& corner = mesh.vertices[triangle[k]];
      const Eigen::Vector3f to_next =
          (mesh.vertices[triangle[(k + 1) % 3]] - corner).stableNormalized();
      const Eigen::Vector3f to_last =
          (mesh.vertices[triangle[(k + 2) % 3]] - corner).stableNormalized();
      const Eigen::Vector3f normal = to_next.cross(to_last);
      const float sine = normal.norm();
      if (!(sine > 0) || !std::isfinite(sine)) continue;
      normals[triangle[k]] += normal / sine * std::atan2(sine, to_next.dot(to_last));
    }
  }
  for (Eigen::Vector3f& normal : normals) normal.normalize();
  return normals;
}

/// Triangles whose bounding box meets each band of rows, in the mesh's order.
std::vector<std::vector<std::uint32_t>> triangles_per_band(const TriangleMesh& mesh,
                                                           const std::vector<Projected>& projected,
                                                           const RasterView& view) {
  std::vector<std::vector<std::uint32_t>> bands(
      static_cast<std::size_t>((view.rows + kBand - 1) / kBand));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriangleMesh::Triangle& triangle = mesh.triangles[t];
    const Projected& a = projected[triangle[0]];
    const Projected& b = projected[triangle[1]];
    const Projected& c = projected[triangle[2]];
    if (!(a + b + c).allFinite()) continue;
    const Span rows =
        pixels_within(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}), view.rows);
    for (int band = rows.begin / kBand; band * kBand < rows.end; ++band) {
      bands[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(t));
    }
  }
  return bands;
}

/// Twice the signed area of the triangle (a, b, p) in the picture.
double edge(const Projected& a, const Projected& b, double x, double y) {
  return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
}

/// Fills the bands of a raster; every band is one thread's alone.
class Painter {
 public:
  Painter(const TriangleMesh& mesh,
          const RasterView& view,
          const RasterOptions& options,
          Raster& raster)
      : mesh_(mesh),
        options_(options),
        raster_(raster),
        smallest_cosine_(static_cast<float>(std::cos(options.crease_angle))) {
    const ParallelOptions parallel{.num_threads = options.num_threads, .chunk = 8192};
    projected_ = project(mesh, view, parallel);
    if (options.smooth) {
      normals_ = mesh.normals.empty() ? vertex_normals(mesh) : mesh.normals;
    }
    bands_ = triangles_per_band(mesh, projected_, view);
  }

  std::size_t band_count() const { return bands_.size(); }

  void paint_band(std::size_t band) {
    const int first = static_cast<int>(band) * kBand;
    const Span rows{first, std::min(first + kBand, raster_.rows)};
    for (const std::uint32_t triangle : bands_[band]) paint_triangle(triangle, rows);
  }

 private:
  void paint_triangle(std::uint32_t index, const Span& rows) {
    const TriangleMesh::Triangle& triangle = mesh_.triangles[index];
    const std::array<Projected, 3> p{
        projected_[triangle[0]], projected_[triangle[1]], projected_[triangle[2]]};
    const double area = edge(p[0], p[1], p[2].x(), p[2].y());
    // y runs down in the picture: a triangle seen from outside has negative area.
    const bool back = area > 0;
    if (!(std::abs(area) > 0) || (back && options_.hide_backs)) return;
    const Span band = pixels_within(std::min({p[0].y(), p[1].y(), p[2].y()}),
                                    std::max({p[0].y(), p[1].y(), p[2].y()}),
                                    raster_.rows);
    const Span cols = pixels_within(std::min({p[0].x(), p[1].x(), p[2].x()}),
                                    std::max({p[0].x(), p[1].x(), p[2].x()}),
                                    raster_.cols);
    for (int y = std::max(band.begin, rows.begin); y < std::min(band.end, rows.end); ++y) {
      for (int x = cols.begin; x < cols.end; ++x) {
        const Eigen::Vector3d weight(edge(p[1], p[2], x, y) / area,
                                     edge(p[2], p[0], x, y) / area,
                                     edge(p[0], p[1], x, y) / area);
        if (weight.minCoeff() >= 0) paint_pixel(index, {x, y}, weight, back);
      }
    }
  }

  void paint_pixel(std::uint32_t index,
                   const std::array<int, 2>& xy,
                   const Eigen::Vector3d& weight,
                   bool back) {
    const TriangleMesh::Triangle& triangle = mesh_.triangles[index];
    const auto height = static_cast<float>(weight[0] * projected_[triangle[0]].z() +
                                           weight[1] * projected_[triangle[1]].z() +
                                           weight[2] * projected_[triangle[2]].z());
    const std::size_t pixel = static_cast<std::size_t>(xy[1]) * raster_.cols + xy[0];
    const bool taken = raster_.triangle[pixel] != Raster::kNothing;
    if (taken && height <= raster_.height[pixel]) return;
    raster_.height[pixel] = height;
    raster_.triangle[pixel] = index;
    raster_.back[pixel] = back ? 1 : 0;
    raster_.normal[pixel] = shading_normal(triangle, weight.cast<float>());
  }

  /// The corners' normals blended, but the triangle's own at corners of sharp edges.
  Eigen::Vector3f shading_normal(const TriangleMesh::Triangle& triangle,
                                 const Eigen::Vector3f& weight) const {
    const Eigen::Vector3f& a = mesh_.vertices[triangle[0]];
    Eigen::Vector3f own =
        (mesh_.vertices[triangle[1]] - a).cross(mesh_.vertices[triangle[2]] - a).stableNormalized();
    if (normals_.empty()) return own;
    Eigen::Vector3f blended = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f& corner = normals_[triangle[static_cast<std::size_t>(k)]];
      const bool blunt = corner.dot(own) >= smallest_cosine_;
      blended += weight[k] * (blunt ? corner : own);
    }
    return blended.normalized();
  }

  const TriangleMesh& mesh_;
  const RasterOptions& options_;
  Raster& raster_;
  float smallest_cosine_;
  std::vector<Projected> projected_;
  std::vector<Eigen::Vector3f> normals_;
  std::vector<std::vector<std::uint32_t>> bands_;
};

Raster empty_raster(const RasterView& view) {
  Raster raster;
  raster.rows = view.rows;
  raster.cols = view.cols;
  const std::size_t pixels =
      static_cast<std::size_t>(view.rows) * static_cast<std::size_t>(view.cols);
  raster.height.assign(pixels, std::numeric_limits<float>::quiet_NaN());
  raster.normal.assign(pixels, Eigen::Vector3f::Zero());
  raster.triangle.assign(pixels, Raster::kNothing);
  raster.back.assign(pixels, 0);
  return raster;
}

}  // namespace

std::size_t Raster::covered() const {
  return triangle.size() -
         static_cast<std::size_t>(std::count(triangle.begin(), triangle.end(), kNothing));
}

Raster rasterize(const TriangleMesh& mesh, const RasterView& view, const RasterOptions& options) {
  mesh.check();
  require(view.rows >= 1 && view.cols >= 1 && view.rows <= 20000 && view.cols <= 20000,
          "a raster needs 1 to 20000 px along both sides, not ",
          view.cols,
          " x ",
          view.rows);
  require(std::isfinite(view.pixels_per_metre) && view.pixels_per_metre > 0,
          "pixels_per_metre must be above 0 px/m, not ",
          view.pixels_per_metre);
  Raster raster = empty_raster(view);
  Painter painter(mesh, view, options, raster);
  const auto paint = [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) painter.paint_band(band);
  };
  parallel_for(painter.band_count(), paint, {.num_threads = options.num_threads, .chunk = 1});
  return raster;
}

}  // namespace facula
