// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace facula {
namespace {

constexpr int kBits = 21;  // per axis: three axes fill 63 bits of the key

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

/// Finite points with their voxel key (z, y, x from high to low bits), ordered by key then index.
std::vector<Keyed> keyed_points(const PointCloud& cloud, double voxel) {
  Eigen::Array3d lowest = Eigen::Array3d::Constant(INFINITY);
  for (const Eigen::Vector3f& p : cloud.points) {
    if (p.allFinite()) lowest = lowest.min((p.cast<double>().array() / voxel).floor());
  }
  std::vector<Keyed> keyed;
  keyed.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    const Eigen::Array3d cell = (cloud.points[i].cast<double>().array() / voxel).floor() - lowest;
    require(cell.maxCoeff() < double(1 << kBits),
            "the cloud is ",
            (cell.maxCoeff() + 1) * voxel,
            " m wide, more than 2^21 voxels of ",
            voxel,
            " m; choose a larger voxel or remove stray points");
    const auto [x, y, z] =
        std::array{std::uint64_t(cell.x()), std::uint64_t(cell.y()), std::uint64_t(cell.z())};
    keyed.push_back({(z << (2 * kBits)) | (y << kBits) | x, static_cast<std::uint32_t>(i)});
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return a.key != b.key ? a.key < b.key : a.index < b.index;
  });
  return keyed;
}

/// Weighted sums over the points of one voxel.
struct VoxelSum {
  bool by_sigma = false;
  double weight = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double intensity = 0;

  void add(const PointCloud& cloud, std::size_t i, double w) {
    weight += w;
    point += w * cloud.points[i].cast<double>();
    if (!cloud.normals.empty()) normal += w * cloud.normals[i].cast<double>();
    if (!cloud.sensor_origin.empty()) origin += w * cloud.sensor_origin[i].cast<double>();
    if (!cloud.colors.empty()) {
      const Color& c = cloud.colors[i];
      color += w * Eigen::Vector3d(c[0], c[1], c[2]);
    }
    if (!cloud.intensity.empty()) intensity += w * cloud.intensity[i];
  }

  void store(PointCloud& out, const PointCloud& like) const {
    out.points.push_back((point / weight).cast<float>());
    if (!like.normals.empty()) {
      const double length = normal.norm();
      out.normals.push_back(length > 0 ? Eigen::Vector3f((normal / length).cast<float>())
                                       : Eigen::Vector3f(Eigen::Vector3f::Zero()));
    }
    if (!like.sensor_origin.empty()) out.sensor_origin.push_back((origin / weight).cast<float>());
    if (!like.colors.empty()) {
      const Eigen::Vector3d c = color / weight;
      const auto level = [](double v) { return static_cast<std::uint8_t>(std::lround(v)); };
      out.colors.push_back({level(c.x()), level(c.y()), level(c.z())});
    }
    if (!like.intensity.empty()) out.intensity.push_back(static_cast<float>(intensity / weight));
    // The standard deviation of a mean weighted by 1/sigma^2; 0, unknown, of any other.
    const double sigma = by_sigma ? 1 / std::sqrt(weight) : 0;
    if (!like.sigma.empty()) out.sigma.push_back(static_cast<float>(sigma));
  }
};

/// Points that know their sigma outdo those of their voxel that do not; where none does, all count
/// alike.
VoxelSum sum_of(const PointCloud& cloud, std::span<const Keyed> voxel) {
  const auto known = [&cloud](const Keyed& p) {
    return !cloud.sigma.empty() && is_known_sigma(cloud.sigma[p.index]);
  };
  VoxelSum sum;
  sum.by_sigma = std::any_of(voxel.begin(), voxel.end(), known);
  for (const Keyed& p : voxel) {
    if (!sum.by_sigma) {
      sum.add(cloud, p.index, 1);
    } else if (known(p)) {
      sum.add(cloud, p.index, 1 / std::pow(double(cloud.sigma[p.index]), 2));
    }
  }
  return sum;
}

}  // namespace

PointCloud thin_by_voxel(const PointCloud& cloud,
                         double voxel,
                         std::vector<std::uint32_t>* voxel_of) {
  cloud.check();
  require(voxel > 0 && std::isfinite(voxel), "voxel is ", voxel, " m; give a length above 0");
  const std::vector<Keyed> keyed = keyed_points(cloud, voxel);
  if (voxel_of != nullptr) voxel_of->assign(cloud.size(), kNoVoxel);
  PointCloud thinned;
  for (std::size_t begin = 0; begin < keyed.size();) {
    std::size_t end = begin;
    for (; end < keyed.size() && keyed[end].key == keyed[begin].key; ++end) {
      if (voxel_of == nullptr) continue;
      (*voxel_of)[keyed[end].index] = static_cast<std::uint32_t>(thinned.size());
    }
    sum_of(cloud, std::span(keyed).subspan(begin, end - begin)).store(thinned, cloud);
    begin = end;
  }
  return thinned;
}

}  // namespace facula
