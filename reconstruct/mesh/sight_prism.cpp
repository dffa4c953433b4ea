// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/mesh/sight_prism.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr float kLeastCosine = 1.0F / 3;  // the band grows no longer along grazing lines of sight
constexpr float kLeastAlong = 0.3F;       // share of a line of sight along the slicing axis
constexpr float kEdge = 1e-3F;            // voxels on an edge may count twice, but never be missed

int brick_of(int voxel) {
  return voxel >> 3;
}

int brick_of(float voxel) {
  return brick_of(static_cast<int>(std::floor(voxel)));
}

}  // namespace

SightPrism::SightPrism(const RangeSurface& surface,
                       const TriangleMesh::Triangle& triangle,
                       double voxel,
                       float truncation)
    : truncation_(truncation) {
  Eigen::Vector3f toward = Eigen::Vector3f::Zero();
  float cosine = 0;
  for (const std::uint32_t v : triangle) {
    toward += surface.vertices[v].toward;
    cosine += surface.vertices[v].cosine / 3;
  }
  toward.cwiseAbs().maxCoeff(&axis_);
  u_ = (axis_ + 1) % 3;
  v_ = (axis_ + 2) % 3;
  reach_ = truncation / std::max(cosine, kLeastCosine);
  float low = INFINITY;
  float high = -INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    const SightVertex& vertex = surface.vertices[triangle[i]];
    const float along = vertex.toward[axis_];
    if (along * toward[axis_] <= 0 || std::abs(along) < kLeastAlong) return;
    const Eigen::Vector3f p = (vertex.point.cast<double>() / voxel).cast<float>();
    corners_[i] = {.place = {p[u_], p[v_]},
                   .drift = Eigen::Vector2f(vertex.toward[u_], vertex.toward[v_]) / along,
                   .along = p[axis_],
                   .per_slice = 1 / along,
                   .cosine = vertex.cosine,
                   .weight = vertex.weight};
    low = std::min(low, p[axis_] - reach_ * std::abs(along));
    high = std::max(high, p[axis_] + reach_ * std::abs(along));
  }
  constexpr float kMost = 8388600;  // 2^20 bricks
  const auto inside = [](const Corner& c) {
    return c.place.cwiseAbs().maxCoeff() < kMost && std::abs(c.along) < kMost;
  };
  if (!std::all_of(corners_.begin(), corners_.end(), inside) || !(high - low < kMost)) return;
  first_slice_ = static_cast<int>(std::ceil(low));
  last_slice_ = static_cast<int>(std::floor(high));
  usable_ = true;
}

double SightPrism::bricks_at_most() const {
  double count = 2.0 + static_cast<double>(last_slice_ - first_slice_) / kBrickSide;
  for (int d = 0; d < 2; ++d) {
    float width = 0;  // largest at the first or the last slice: corners drift along straight lines
    float drift = 0;
    for (const int slice : {first_slice_, last_slice_}) {
      float low = INFINITY;
      float high = -INFINITY;
      for (const Corner& c : corners_) {
        const float at = c.at(static_cast<float>(slice))[d];
        low = std::min(low, at);
        high = std::max(high, at);
        drift = std::max(drift, std::abs(c.drift[d]));
      }
      width = std::max(width, high - low);
    }
    count *= 2.0 + static_cast<double>(width / kBrickSide + drift);
  }
  return count;
}

void SightPrism::visit_bricks(const std::function<void(const BrickPlace&)>& visit) const {
  for (int layer = brick_of(first_slice_); layer <= brick_of(last_slice_); ++layer) {
    const auto from = static_cast<float>(std::max(first_slice_, layer * kBrickSide));
    const auto to = static_cast<float>(std::min(last_slice_, layer * kBrickSide + 7));
    Eigen::Vector2f low = corners_[0].at(from);
    Eigen::Vector2f high = low;
    for (const Corner& corner : corners_) {
      for (const float slice : {from, to}) {
        low = low.cwiseMin(corner.at(slice));
        high = high.cwiseMax(corner.at(slice));
      }
    }
    // A voxel's own corner: bricks hold samples at whole numbers.
    BrickPlace place;
    place[axis_] = layer;
    for (int bu = brick_of(std::ceil(low.x() - kEdge)); bu <= brick_of(high.x() + kEdge); ++bu) {
      for (int bv = brick_of(std::ceil(low.y() - kEdge)); bv <= brick_of(high.y() + kEdge); ++bv) {
        place[u_] = bu;
        place[v_] = bv;
        visit(place);
      }
    }
  }
}

void SightPrism::add_to(const BrickPlace& place, Brick& brick) const {
  const int first = std::max(first_slice_, place[axis_] * kBrickSide);
  const int last = std::min(last_slice_, place[axis_] * kBrickSide + kBrickSide - 1);
  for (int slice = first; slice <= last; ++slice) add_slice(slice, place, brick);
}

void SightPrism::add_slice(int slice, const BrickPlace& place, Brick& brick) const {
  const auto height = static_cast<float>(slice);
  const Eigen::Vector2f a = corners_[0].at(height);
  const Eigen::Vector2f ab = corners_[1].at(height) - a;
  const Eigen::Vector2f ac = corners_[2].at(height) - a;
  const float area = ab.x() * ac.y() - ab.y() * ac.x();
  if (std::abs(area) < 1e-9F) return;
  const Eigen::Vector2f low = a + ab.cwiseMin(ac).cwiseMin(0.0F);
  const Eigen::Vector2f high = a + ab.cwiseMax(ac).cwiseMax(0.0F);
  const int brick_u = place[u_] * kBrickSide;
  const int brick_v = place[v_] * kBrickSide;
  const int first_u = std::max(brick_u, static_cast<int>(std::ceil(low.x() - kEdge)));
  const int last_u = std::min(brick_u + 7, static_cast<int>(std::floor(high.x() + kEdge)));
  const int first_v = std::max(brick_v, static_cast<int>(std::ceil(low.y() - kEdge)));
  const int last_v = std::min(brick_v + 7, static_cast<int>(std::floor(high.y() + kEdge)));
  Eigen::Vector3i voxel;
  voxel[axis_] = slice & 7;
  for (int u = first_u; u <= last_u; ++u) {
    for (int v = first_v; v <= last_v; ++v) {
      const float du = static_cast<float>(u) - a.x();
      const float dv = static_cast<float>(v) - a.y();
      const float b = (du * ac.y() - dv * ac.x()) / area;
      const float c = (ab.x() * dv - ab.y() * du) / area;
      if (b < -kEdge || c < -kEdge || b + c > 1 + kEdge) continue;
      voxel[u_] = u & 7;
      voxel[v_] = v & 7;
      add_voxel(brick[voxel_index(voxel.x(), voxel.y(), voxel.z())], height, {1 - b - c, b, c});
    }
  }
}

void SightPrism::add_voxel(VoxelSum& voxel, float slice, const Eigen::Vector3f& share) const {
  float sight = 0;  // way along the line of sight from the surface to the voxel
  float cosine = 0;
  float weight = 0;
  for (int i = 0; i < 3; ++i) {
    const Corner& corner = corners_[static_cast<std::size_t>(i)];
    sight += share[i] * (slice - corner.along) * corner.per_slice;
    cosine += share[i] * corner.cosine;
    weight += share[i] * corner.weight;
  }
  if (std::abs(sight) > reach_) return;
  const float distance = sight * cosine;
  // Full weight in the inner half of the band, none at its ends (Curless and Levoy, section 4.1):
  // what a scan says well before or behind its surface yields to what others see there.
  const float fade = std::min(1.0F, 2 - 2 * std::abs(sight) / reach_);
  weight = std::max(weight * fade, 1e-9F);
  voxel.distance += weight * std::clamp(distance, -truncation_, truncation_);
  voxel.weight += weight;
}

}  // namespace facula
