// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/register/plane_triples.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

namespace facula {
namespace {

constexpr int kMostPlanes = 9;
constexpr double kPlaneShare = 0.02;   // of the scan's points, for a plane to count [1]
constexpr double kRoomShare = 0.4;     // of the scan's points on planes, to be a room [1]
constexpr double kInlierVoxels = 0.5;  // distance from the plane [voxels]
constexpr std::size_t kPoints = 4000;  // among which planes are looked for, at least [1]
constexpr double kMinVolume = 0.3;     // of the box that three unit normals span [1]
constexpr std::size_t kSamples = 256;  // points by which a pose is judged

using Triple = std::array<std::size_t, 3>;

Eigen::Matrix3d normals_of(const std::vector<Plane>& planes, const Triple& triple) {
  Eigen::Matrix3d normals;
  for (int k = 0; k < 3; ++k) normals.row(k) = planes[triple[static_cast<std::size_t>(k)]].normal;
  return normals;
}

/// Triples of planes in three directions; each set of three once, or in all six orders.
std::vector<Triple> triples_of(const std::vector<Plane>& planes, bool all_orders) {
  std::vector<Triple> triples;
  for (std::size_t a = 0; a < planes.size(); ++a) {
    for (std::size_t b = 0; b < planes.size(); ++b) {
      for (std::size_t c = 0; c < planes.size(); ++c) {
        if (a == b || b == c || a == c || (!all_orders && (a > b || b > c))) continue;
        const Triple triple{a, b, c};
        if (std::abs(normals_of(planes, triple).determinant()) > kMinVolume) {
          triples.push_back(triple);
        }
      }
    }
  }
  return triples;
}

bool angles_agree(const Eigen::Matrix3d& s, const Eigen::Matrix3d& t, double max_angle) {
  if (s.determinant() * t.determinant() < 0) return false;  // mirrored
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double between_s = std::acos(std::clamp(s.row(i).dot(s.row(j)), -1.0, 1.0));
    const double between_t = std::acos(std::clamp(t.row(i).dot(t.row(j)), -1.0, 1.0));
    if (std::abs(between_s - between_t) > max_angle) return false;
  }
  return true;
}

/// The rotation that turns the source's normals best onto the target's (Kabsch 1976), and the shift
/// that brings plane onto plane: n . t = d_target - d_source.
RigidTransform pose_of(const Eigen::Matrix3d& s,
                       const Eigen::Matrix3d& t,
                       const Eigen::Vector3d& farther) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(t.transpose() * s,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d rotation =
      svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
  return {Eigen::Quaterniond(rotation).normalized(), t.inverse() * farther};
}

}  // namespace

std::vector<Plane> room_planes(const ScanPyramid& scan, int num_threads) {
  const PyramidLevel& level = coarsest_level(scan, kPoints);
  const PointCloud& cloud = level.cloud;
  const auto least = static_cast<std::size_t>(kPlaneShare * static_cast<double>(cloud.size()));
  if (least < 12 || cloud.normals.empty()) return {};
  const auto found = extract_planes(cloud,
                                    {.inlier_distance = kInlierVoxels * level.voxel,
                                     .min_points = least,
                                     .max_planes = kMostPlanes,
                                     .iterations = 500,
                                     .max_gap = 4 * level.voxel,
                                     .num_threads = num_threads});
  std::vector<Plane> planes;
  std::size_t on_planes = 0;
  for (const ExtractedPlane& extracted : found) {
    Plane plane = extracted.fit.plane;
    Eigen::Vector3d side = Eigen::Vector3d::Zero();
    for (const std::size_t i : extracted.indices) side += cloud.normals[i].cast<double>();
    if (side.dot(plane.normal) < 0) plane = {-plane.normal, -plane.distance};
    planes.push_back(plane);
    on_planes += extracted.indices.size();
  }
  const bool room =
      static_cast<double>(on_planes) >= kRoomShare * static_cast<double>(cloud.size());
  return room && planes.size() >= 3 ? planes : std::vector<Plane>{};
}

std::vector<PoseCandidate> plane_triple_candidates(const GlobalFeatures& source,
                                                   const GlobalFeatures& target,
                                                   const PlaneTripleOptions& options) {
  const std::vector<Triple> from = triples_of(source.planes, false);
  const std::vector<Triple> to = triples_of(target.planes, true);
  const PoseSampler sampler(source, target, kSamples, options.seed);
  const auto kept = static_cast<std::size_t>(options.kept);
  std::vector<std::vector<PoseCandidate>> found(from.size());
  const auto match = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Matrix3d s = normals_of(source.planes, from[i]);
      for (const Triple& triple : to) {
        const Eigen::Matrix3d t = normals_of(target.planes, triple);
        if (!angles_agree(s, t, options.max_angle)) continue;
        Eigen::Vector3d farther;
        for (std::size_t k = 0; k < 3; ++k) {
          farther[static_cast<Eigen::Index>(k)] =
              target.planes[triple[k]].distance - source.planes[from[i][k]].distance;
        }
        const RigidTransform pose = pose_of(s, t, farther);
        const double score = sampler.score(pose, 0.1);
        if (score > 0) found[i].push_back({pose, score});
      }
    }
  };
  parallel_for(from.size(), match, {.num_threads = options.num_threads, .chunk = 1});
  std::vector<PoseCandidate> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return distinct_best(std::move(all), source, kept);
}

}  // namespace facula
