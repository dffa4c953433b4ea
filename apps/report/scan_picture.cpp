// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/apps/report/color_bar.hpp>
#include <facula/apps/report/color_map.hpp>
#include <facula/apps/report/depth_shading.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/scan_picture.hpp>
#include <facula/apps/report/view_panels.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace facula {
namespace {

constexpr Color kBackground{247, 248, 250};
constexpr int kFiner = 2;               // splatted pixels per pixel of the picture, along each side
constexpr double kLeastFacing = 0.05;   // of the points, for the others to be left out
constexpr double kOutlierShare = 5e-4;  // of the points may lie outside the panels, per side

/// A view of the cloud while it is splatted: the nearest point of every pixel.
struct Splat {
  int rows = 0;
  int cols = 0;
  std::vector<float> height;  // towards the viewer [px], NaN where empty
  std::vector<std::size_t> point;
};

/// The box of nearly all points: a few strays must not shrink the rest.
Eigen::AlignedBox3d box_of(const PointCloud& cloud) {
  std::vector<float> values[3];
  for (const Eigen::Vector3f& point : cloud.points) {
    if (!point.allFinite()) continue;
    for (int k = 0; k < 3; ++k) values[k].push_back(point[k]);
  }
  Eigen::AlignedBox3d box;
  if (values[0].empty()) return box;
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  for (int k = 0; k < 3; ++k) {
    const ValueRange range = robust_range(values[k], kOutlierShare);
    low[k] = range.low;
    high[k] = range.high;
  }
  box.extend(low);
  box.extend(high);
  return box;
}

void splat_point(Splat& splat, std::size_t index, const Eigen::Vector3d& seen, double radius) {
  const double reach = std::floor(radius);
  if (!(seen.x() > -reach && seen.x() < splat.cols + reach)) return;
  if (!(seen.y() > -reach && seen.y() < splat.rows + reach)) return;
  const int x0 = static_cast<int>(std::lround(seen.x()));
  const int y0 = static_cast<int>(std::lround(seen.y()));
  const int half = static_cast<int>(reach);
  for (int y = std::max(0, y0 - half); y <= std::min(splat.rows - 1, y0 + half); ++y) {
    for (int x = std::max(0, x0 - half); x <= std::min(splat.cols - 1, x0 + half); ++x) {
      const int dx = x - x0;
      const int dy = y - y0;
      if (dx * dx + dy * dy > radius * radius) continue;
      const std::size_t pixel = static_cast<std::size_t>(y) * splat.cols + x;
      const auto height = static_cast<float>(seen.z());
      if (splat.height[pixel] >= height) continue;  // false where empty (NaN)
      splat.height[pixel] = height;
      splat.point[pixel] = index;
    }
  }
}

/// Whether enough of the cloud faces the viewer to show it without what faces away; a wall seen
/// from behind would leave an empty panel.
bool faces(const PointCloud& cloud, const ViewDirection& view) {
  std::size_t facing = 0;
  for (const Eigen::Vector3f& normal : cloud.normals) {
    facing += normal.cast<double>().dot(view.towards_viewer) >= 0 ? 1 : 0;
  }
  return static_cast<double>(facing) >= kLeastFacing * static_cast<double>(cloud.size());
}

Splat splat_cloud(const PointCloud& cloud,
                  const ViewPanels& panels,
                  std::size_t index,
                  const ScanPictureOptions& options) {
  const ViewDirection& view = panels.views[index];
  Splat splat{panels.rows * kFiner, panels.cols * kFiner, {}, {}};
  const std::size_t pixels = static_cast<std::size_t>(splat.rows) * splat.cols;
  splat.height.assign(pixels, std::numeric_limits<float>::quiet_NaN());
  splat.point.assign(pixels, 0);
  const double scale = panels.pixels_per_metre * kFiner;
  const bool culled = options.hide_backs && !cloud.normals.empty() && faces(cloud, view);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    if (culled && cloud.normals[i].cast<double>().dot(view.towards_viewer) < 0) continue;
    const Eigen::Vector3d x = (cloud.points[i].cast<double>() - panels.centers[index]) * scale;
    const Eigen::Vector3d seen((splat.cols - 1) / 2.0 + x.dot(view.right),
                               (splat.rows - 1) / 2.0 - x.dot(view.up),
                               x.dot(view.towards_viewer));
    splat_point(splat, i, seen, options.point_size * kFiner / 2);
  }
  return splat;
}

/// Lambert's law with a lamp beside the viewer, where the cloud has normals.
double brightness(const PointCloud& cloud, std::size_t point, const ViewDirection& view) {
  if (cloud.normals.empty() || !cloud.normals[point].allFinite()) return 1.0;
  const Eigen::Vector3d normal = cloud.normals[point].cast<double>();
  const Eigen::Vector3d lamp =
      (-0.4 * view.right + 0.5 * view.up + 0.77 * view.towards_viewer).normalized();
  return 0.45 + 0.6 * std::abs(normal.dot(lamp));
}

Image8 picture_of(const PointCloud& cloud,
                  const Splat& splat,
                  const ViewDirection& view,
                  const std::vector<Color>& colors) {
  const std::vector<float> open = depth_shading(splat.height, splat.rows, splat.cols, 0.12);
  Image8 picture = make_canvas(splat.rows, splat.cols, kBackground);
  for (int y = 0; y < splat.rows; ++y) {
    for (int x = 0; x < splat.cols; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * splat.cols + x;
      if (std::isnan(splat.height[pixel])) continue;
      const std::size_t point = splat.point[pixel];
      set_pixel(picture, x, y, lit(colors[point], open[pixel] * brightness(cloud, point, view)));
    }
  }
  return halved(picture);
}

std::vector<Color> height_colors(const PointCloud& cloud, const ColorScale& scale, double per_m) {
  std::vector<Color> colors;
  colors.reserve(cloud.size());
  for (const Eigen::Vector3f& point : cloud.points) colors.push_back(scale.at(point.z() * per_m));
  return colors;
}

ViewPanels panels_for(const Eigen::AlignedBox3d& box, int size) {
  const std::vector<ViewDirection> views{front_view(), side_view(), top_view()};
  std::vector<Eigen::AlignedBox3d> seen;
  for (const ViewDirection& view : views) {
    const Eigen::Matrix3d view_from_cloud = view.rotation();
    const Eigen::Vector3d a = view_from_cloud * box.min();
    const Eigen::Vector3d b = view_from_cloud * box.max();
    seen.emplace_back(a.cwiseMin(b), a.cwiseMax(b));
  }
  return fit_panels(views, seen, size);
}

}  // namespace

void ScanPictureOptions::check() const {
  require(panel >= 120 && panel <= 2000, "panel must be 120 to 2000 px, not ", panel);
  require(point_size >= 1 && point_size <= 20, "point_size must be 1 to 20 px, not ", point_size);
}

Image8 scan_picture(const PointCloud& cloud, const ScanPictureOptions& options) {
  options.check();
  cloud.check();
  const Eigen::AlignedBox3d box = box_of(cloud);
  if (box.isEmpty()) return empty_picture("The cloud has no points.");

  const LengthUnit unit = length_unit_for(box.sizes().maxCoeff());
  const ColorScale scale{ColorMap::kViridis,
                         box.min().z() * unit.per_metre,
                         box.max().z() * unit.per_metre,
                         std::string("height z [") + unit.name + "]"};
  const bool own_colors = options.use_colors && !cloud.colors.empty();
  const std::vector<Color> colors =
      own_colors ? cloud.colors : height_colors(cloud, scale, unit.per_metre);
  const ViewPanels panels = panels_for(box, options.panel);
  std::vector<Image8> pictures(panels.views.size());
  const auto draw = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Splat splat = splat_cloud(cloud, panels, i, options);
      pictures[i] = picture_of(cloud, splat, panels.views[i], colors);
    }
  };
  parallel_for(pictures.size(), draw, {.chunk = 1});
  const std::string remark =
      format_count(cloud.size()) + " points, nearly all within " + box_dimensions(box);
  const Image8 joined = join_panels(panels, pictures, remark);
  return own_colors ? joined : beside({joined, color_bar(scale, joined.rows - 40)});
}

}  // namespace facula
