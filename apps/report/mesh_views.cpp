// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/color_map.hpp>
#include <facula/apps/report/depth_shading.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/mesh_views.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/rasterize.hpp>
#include <facula/apps/report/view_panels.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace facula {
namespace {

constexpr Color kBackground{247, 248, 250};
constexpr Color kFrontColor{158, 182, 206};
constexpr Color kBackColor{214, 164, 92};
constexpr const char* kBackText = "back of the surface, seen where it is open";
constexpr int kFiner = 2;  // pixels of the raster per pixel of the picture, along each side

/// Outer dimensions of the triangles along a view's right, up and towards_viewer.
Eigen::AlignedBox3d box_seen(const TriangleMesh& mesh, const ViewDirection& view) {
  const Eigen::Matrix3d view_from_mesh = view.rotation();
  Eigen::AlignedBox3d box;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      const Eigen::Vector3f& vertex = mesh.vertices[corner];
      if (vertex.allFinite()) box.extend(view_from_mesh * vertex.cast<double>());
    }
  }
  return box;
}

Color surface_color(const TriangleMesh& mesh, std::uint32_t triangle, bool back) {
  if (back) return kBackColor;
  if (mesh.colors.empty()) return kFrontColor;
  const TriangleMesh::Triangle& corners = mesh.triangles[triangle];
  Color mean{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int sum =
        mesh.colors[corners[0]][k] + mesh.colors[corners[1]][k] + mesh.colors[corners[2]][k];
    mean[k] = static_cast<std::uint8_t>(sum / 3);
  }
  return mean;
}

/// Share of light a surface sends to the viewer: a lamp at the upper left, a weak one at the right.
double brightness(const ViewDirection& view, const Eigen::Vector3f& normal) {
  const Eigen::Vector3d n = normal.cast<double>();
  Eigen::Vector3d seen(n.dot(view.right), n.dot(view.up), n.dot(view.towards_viewer));
  if (seen.z() < 0) seen = -seen;
  const double lamp = std::max(0.0, seen.dot(Eigen::Vector3d(-0.42, 0.58, 0.70)));
  const double fill = std::max(0.0, seen.dot(Eigen::Vector3d(0.80, 0.05, 0.60)));
  return 0.34 + 0.70 * lamp + 0.18 * fill;
}

Image8 shaded(const TriangleMesh& mesh, const RasterView& view, const Raster& raster) {
  std::vector<float> height = raster.height;
  for (float& value : height) value *= static_cast<float>(view.pixels_per_metre);
  const std::vector<float> open = depth_shading(height, raster.rows, raster.cols, 0.05);
  Image8 picture = make_canvas(raster.rows, raster.cols, kBackground);
  for (int y = 0; y < raster.rows; ++y) {
    for (int x = 0; x < raster.cols; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * raster.cols + x;
      if (raster.triangle[pixel] == Raster::kNothing) continue;
      const Color color = surface_color(mesh, raster.triangle[pixel], raster.back[pixel] != 0);
      const double light = brightness(view.direction, raster.normal[pixel]);
      set_pixel(picture, x, y, lit(color, light * open[pixel]));
    }
  }
  return picture;
}

}  // namespace

void MeshViewsOptions::check() const {
  require(panel >= 120 && panel <= 2000, "panel must be 120 to 2000 px, not ", panel);
}

Image8 mesh_views(const TriangleMesh& mesh, const MeshViewsOptions& options) {
  options.check();
  mesh.check();
  const std::vector<ViewDirection> views{front_view(), side_view(), oblique_view()};
  std::vector<Eigen::AlignedBox3d> seen;
  seen.reserve(views.size());
  for (const ViewDirection& view : views) seen.push_back(box_seen(mesh, view));
  if (seen[0].isEmpty()) return empty_picture("The mesh has no triangles.");

  const ViewPanels panels = fit_panels(views, seen, options.panel);
  std::vector<Image8> pictures;
  bool backs = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const RasterView view{views[i],
                          panels.centers[i],
                          panels.pixels_per_metre * kFiner,
                          panels.rows * kFiner,
                          panels.cols * kFiner};
    const Raster raster = rasterize(mesh,
                                    view,
                                    {.smooth = options.smooth,
                                     .hide_backs = options.hide_backs,
                                     .num_threads = options.num_threads});
    pictures.push_back(halved(shaded(mesh, view, raster)));
    backs = backs || std::find(raster.back.begin(), raster.back.end(), 1) != raster.back.end();
  }
  const std::string remark = format_count(mesh.triangles.size()) + " triangles, " +
                             box_dimensions(box_seen(mesh, top_view()));
  Image8 joined = join_panels(panels, pictures, remark);
  if (!backs) return joined;
  return below({joined, legend({{kBackColor, kBackText}}, joined.cols)});
}

}  // namespace facula
