// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/map/octomap_judge.hpp>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <sstream>
#include <vector>

namespace facula {
namespace {

/// The nodes of a file, behind its header.
std::string nodes_of(const std::string& file) {
  const std::string mark = "\ndata\n";
  return file.substr(file.find(mark) + mark.size());
}

std::string ot_nodes(const octomap::OcTree& tree) {
  std::ostringstream bytes;
  tree.write(bytes);
  return nodes_of(bytes.str());
}

std::string bt_nodes(const octomap::OcTree& tree) {
  std::ostringstream bytes;
  octomap::OcTree likeliest(tree);  // OcTree::writeBinary() does the same, and prints
  if (likeliest.getRoot() == nullptr) return {};
  likeliest.toMaxLikelihood();
  likeliest.prune();
  likeliest.writeBinaryNode(bytes, likeliest.getRoot());
  return bytes.str();
}

bool precedes(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// liboctomap prints a line per ray that leaves its tree, and keeps none of them; a ray that is cut
/// at the range need not end in it.
bool can_be_mapped(const PointCloud& cloud, std::size_t i, const OccupancyOptions& options) {
  const bool may_be_cut = options.max_range > 0 && !options.discretize;
  return cloud.points[i].allFinite() &&
         cell_of(cloud.sensor_origin[i].cast<double>(), options.resolution).has_value() &&
         (may_be_cut || cell_of(cloud.points[i].cast<double>(), options.resolution).has_value());
}

}  // namespace

struct OctomapJudge::Impl {
  OccupancyOptions options;
  octomap::OcTree tree;
  double seconds = 0;

  explicit Impl(const OccupancyOptions& o) : options(o), tree(o.resolution) {
    tree.setProbHit(o.hit);
    tree.setProbMiss(o.miss);
    tree.setClampingThresMin(o.clamp_min);
    tree.setClampingThresMax(o.clamp_max);
    if (!o.box) return;
    octomap::point3d low = to_octomap(o.box->min);
    octomap::point3d high = to_octomap(o.box->max);
    tree.setBBXMin(low);
    tree.setBBXMax(high);
    tree.useBBXLimit(true);
  }

  double max_range() const { return options.max_range > 0 ? options.max_range : -1; }

  /// Points of one origin after the other.
  std::vector<std::size_t> by_origin(const PointCloud& cloud) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (can_be_mapped(cloud, i, options)) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return precedes(cloud.sensor_origin[a], cloud.sensor_origin[b]);
    });
    return order;
  }

  void insert(const PointCloud& cloud) {
    const std::vector<std::size_t> order = by_origin(cloud);
    if (order.empty()) return;
    octomap::KeySet passed;
    octomap::KeySet ended;
    for (auto begin = order.begin(); begin != order.end();) {
      const Eigen::Vector3f& origin = cloud.sensor_origin[*begin];
      octomap::Pointcloud points;
      auto end = begin;
      for (; end != order.end() && cloud.sensor_origin[*end] == origin; ++end) {
        points.push_back(to_octomap(cloud.points[*end]));
      }
      if (begin == order.begin() && end == order.end()) {
        return tree.insertPointCloud(
            points, to_octomap(origin), max_range(), false, options.discretize);
      }
      add_sets(points, to_octomap(origin), passed, ended);
      begin = end;
    }
    for (const octomap::OcTreeKey& key : passed) {
      if (ended.find(key) == ended.end()) tree.updateNode(key, false);
    }
    for (const octomap::OcTreeKey& key : ended) tree.updateNode(key, true);
  }

  void add_sets(const octomap::Pointcloud& points,
                const octomap::point3d& origin,
                octomap::KeySet& passed,
                octomap::KeySet& ended) {
    octomap::KeySet free;
    octomap::KeySet occupied;
    if (options.discretize) {
      tree.computeDiscreteUpdate(points, origin, free, occupied, max_range());
    } else {
      tree.computeUpdate(points, origin, free, occupied, max_range());
    }
    passed.insert(free.begin(), free.end());
    ended.insert(occupied.begin(), occupied.end());
  }
};

OctomapJudge::OctomapJudge(const OccupancyOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
OctomapJudge::~OctomapJudge() = default;
OctomapJudge::OctomapJudge(OctomapJudge&&) noexcept = default;
OctomapJudge& OctomapJudge::operator=(OctomapJudge&&) noexcept = default;

void OctomapJudge::insert(const PointCloud& cloud) {
  require(cloud.sensor_origin.size() == cloud.size(), "a map needs every point's sensor origin");
  const auto begin = std::chrono::steady_clock::now();
  impl_->insert(cloud);
  impl_->seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

OctomapVerdict OctomapJudge::verdict(const OccupancyMap& map) const {
  std::ostringstream ot;
  std::ostringstream bt;
  write_ot(ot, map.bricks(), map.resolution());
  write_bt(bt, map.bricks(), map.resolution());
  return {.same_ot = nodes_of(ot.str()) == ot_nodes(impl_->tree),
          .same_bt = nodes_of(bt.str()) == bt_nodes(impl_->tree),
          .nodes = impl_->tree.size(),
          .memory = impl_->tree.memoryUsage(),
          .seconds = impl_->seconds};
}

}  // namespace facula
