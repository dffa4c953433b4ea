// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/scan_graph.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr std::size_t kVectorSize = 4 + 3 * 8;
constexpr std::size_t kPoseSize = kVectorSize + 4 + 4 * 8;
constexpr std::size_t kLeastScan = 4 + kPoseSize + 4;
constexpr std::size_t kEdgeSize = 4 + 4 + kPoseSize + 8;

/// How far a quaternion's length may be from 1: files are rounded, not made up.
constexpr float kLengthSlack = 0.1F;

/// Hamilton's product, summed in OctoMap's order.
Eigen::Quaternionf product(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
  return {a.w() * b.w() - a.x() * b.x() - a.y() * b.y() - a.z() * b.z(),
          a.y() * b.z() - b.y() * a.z() + a.w() * b.x() + b.w() * a.x(),
          a.z() * b.x() - b.z() * a.x() + a.w() * b.y() + b.w() * a.y(),
          a.x() * b.y() - b.x() * a.y() + a.w() * b.z() + b.w() * a.z()};
}

float rounded(double x) {
  if (std::abs(x) > static_cast<double>(std::numeric_limits<float>::max())) {
    return x > 0 ? std::numeric_limits<float>::infinity() : -std::numeric_limits<float>::infinity();
  }
  return static_cast<float>(x);
}

class GraphParser {
 public:
  GraphParser(ByteView file, const std::string& name) : reader_(file), name_(name) {}

  ScanGraph parse() {
    ScanGraph graph;
    graph.scans.resize(take_count("scans", kLeastScan));
    for (GraphScan& scan : graph.scans) take_scan(scan);
    graph.edges.resize(take_count("edges", kEdgeSize));
    for (GraphEdge& edge : graph.edges) {
      edge.first = reader_.take<std::uint32_t>();
      edge.second = reader_.take<std::uint32_t>();
      edge.constraint = take_pose();
      edge.weight = reader_.take<double>();
    }
    require(reader_.left() == 0,
            "'",
            name_,
            "' is damaged, or no OctoMap log: ",
            reader_.left(),
            " bytes follow its end");
    return graph;
  }

 private:
  /// A count of things of at least `size` bytes each, which must still fit into the file.
  std::size_t take_count(const char* what, std::size_t size) {
    const bool whole = reader_.left() >= 4;
    const std::size_t count = reader_.take<std::uint32_t>();
    require(whole && count <= reader_.left() / size,
            "'",
            name_,
            "' is torn, or no OctoMap log: it ends before its ",
            count,
            " ",
            what);
    return count;
  }

  template <std::size_t kCount>
  std::array<float, kCount> take_numbers() {
    const auto count = reader_.take<std::uint32_t>();
    require(!reader_.failed(), "'", name_, "' is torn: it ends within a scan");
    require(count == kCount,
            "'",
            name_,
            "' is damaged, or no OctoMap log: expected ",
            kCount,
            " numbers of a point or a pose, got ",
            count);
    std::array<float, kCount> numbers;
    for (float& number : numbers) number = rounded(reader_.take<double>());
    return numbers;
  }

  GraphPose take_pose() {
    const auto [x, y, z] = take_numbers<3>();
    const auto [qw, qx, qy, qz] = take_numbers<4>();
    GraphPose pose{{x, y, z}, {qw, qx, qy, qz}};
    require(pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) <= kLengthSlack,
            "'",
            name_,
            "' is damaged: a pose is not finite, or its quaternion not of length 1");
    return pose;
  }

  void take_scan(GraphScan& scan) {
    scan.points.resize(take_count("points of a scan", kVectorSize));
    for (Eigen::Vector3f& point : scan.points) {
      const auto [x, y, z] = take_numbers<3>();
      point = {x, y, z};
    }
    scan.world_from_scan = take_pose();
    scan.id = reader_.take<std::uint32_t>();
    require(!reader_.failed(), "'", name_, "' is torn: it ends within a scan");
  }

  ByteReader reader_;
  const std::string& name_;
};

void put_vector(Bytes& bytes, const Eigen::Vector3f& x) {
  put(bytes, std::uint32_t{3});
  for (const float value : x) put(bytes, static_cast<double>(value));
}

void put_pose(Bytes& bytes, const GraphPose& pose) {
  put_vector(bytes, pose.translation);
  put(bytes, std::uint32_t{4});
  const Eigen::Quaternionf& q = pose.rotation;
  for (const float value : {q.w(), q.x(), q.y(), q.z()}) put(bytes, static_cast<double>(value));
}

Bytes graph_bytes(const ScanGraph& graph) {
  Bytes bytes;
  bytes.reserve(8 + kVectorSize * graph.points() + kLeastScan * graph.scans.size() +
                kEdgeSize * graph.edges.size());
  put(bytes, static_cast<std::uint32_t>(graph.scans.size()));
  for (const GraphScan& scan : graph.scans) {
    put(bytes, static_cast<std::uint32_t>(scan.points.size()));
    for (const Eigen::Vector3f& point : scan.points) put_vector(bytes, point);
    put_pose(bytes, scan.world_from_scan);
    put(bytes, scan.id);
  }
  put(bytes, static_cast<std::uint32_t>(graph.edges.size()));
  for (const GraphEdge& edge : graph.edges) {
    put(bytes, edge.first);
    put(bytes, edge.second);
    put_pose(bytes, edge.constraint);
    put(bytes, edge.weight);
  }
  return bytes;
}

}  // namespace

Eigen::Vector3f GraphPose::operator*(const Eigen::Vector3f& x) const {
  const Eigen::Quaternionf turned =
      product(product(rotation, Eigen::Quaternionf(0, x.x(), x.y(), x.z())), rotation.conjugate());
  return Eigen::Vector3f(turned.x(), turned.y(), turned.z()) + translation;
}

std::size_t ScanGraph::points() const {
  std::size_t count = 0;
  for (const GraphScan& scan : scans) count += scan.points.size();
  return count;
}

ScanGraph parse_scan_graph(ByteView file, const std::string& name) {
  return GraphParser(file, name).parse();
}

ScanGraph read_scan_graph(const std::filesystem::path& path) {
  return parse_scan_graph(bytes_of_text(read_whole_file(path)), path.string());
}

void write_scan_graph(const std::filesystem::path& path, const ScanGraph& graph) {
  AtomicFile file(path);
  const Bytes bytes = graph_bytes(graph);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

PointCloud world_cloud(const GraphScan& scan) {
  PointCloud cloud;
  cloud.points.reserve(scan.points.size());
  for (const Eigen::Vector3f& x : scan.points) cloud.points.push_back(scan.world_from_scan * x);
  cloud.sensor_origin.assign(cloud.size(), scan.world_from_scan.translation);
  return cloud;
}

RigidTransform rigid_transform(const GraphPose& pose) {
  constexpr double kRounding = 1e-6;
  Eigen::Quaterniond rotation = pose.rotation.cast<double>();
  if (std::abs(rotation.norm() - 1) > kRounding) rotation.normalize();
  return {rotation, pose.translation.cast<double>()};
}

GraphPose graph_pose(const RigidTransform& pose) {
  return {pose.translation.cast<float>(), pose.rotation.cast<float>()};
}

}  // namespace facula
