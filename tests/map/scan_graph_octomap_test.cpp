// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/map/scan_graph.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <limits>

#include <octomap/ScanGraph.h>

namespace facula {
namespace {

/// A log of three scans and two edges, made by OctoMap.
void fill(octomap::ScanGraph& graph) {
  Random random(3);
  for (std::uint64_t i = 0; i < 3; ++i) {
    const auto part = [&] { return static_cast<float>(random.uniform() * 3 - 1.5); };
    const octomap::pose6d pose(part(), part(), part(), part(), part() / 2, part());
    // ScanGraph deletes it.
    graph.addNode(new octomap::Pointcloud(to_octomap(random_scan(i, 800))), pose);
  }
  graph.connectPrevious();
  graph.addEdge(0U, 1U);
}

GraphPose pose_from(const octomap::pose6d& pose) {
  const octomath::Quaternion& q = pose.rot();
  return {from_octomap(pose.trans()), {q.u(), q.x(), q.y(), q.z()}};
}

std::string bytes_by_octomap(const TemporaryFolder& folder) {
  octomap::ScanGraph graph;
  fill(graph);
  graph.writeBinary((folder / "theirs.graph").string());
  return read_whole_file(folder / "theirs.graph");
}

TEST(ScanGraph, ReadsWhatOctoMapWrote) {
  const TemporaryFolder folder;
  bytes_by_octomap(folder);
  octomap::ScanGraph theirs;
  fill(theirs);
  const ScanGraph ours = read_scan_graph(folder / "theirs.graph");
  ASSERT_EQ(ours.scans.size(), theirs.size());
  std::size_t place = 0;
  for (const octomap::ScanNode* node : theirs) {
    const GraphScan& scan = ours.scans[place++];
    EXPECT_EQ(scan.id, node->id);
    ASSERT_EQ(scan.points.size(), node->scan->size());
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      ASSERT_EQ(scan.points[i], from_octomap(node->scan->getPoint(static_cast<unsigned>(i))));
    }
    EXPECT_EQ(scan.world_from_scan.translation, from_octomap(node->pose.trans()));
    EXPECT_EQ(scan.world_from_scan.rotation.coeffs(), pose_from(node->pose).rotation.coeffs());
  }
  ASSERT_EQ(ours.edges.size(), 2U);
  EXPECT_EQ(ours.edges[1].first, (*++theirs.edges_begin())->first->id);
  EXPECT_EQ(ours.edges[1].second, (*++theirs.edges_begin())->second->id);
}

TEST(ScanGraph, WritesTheBytesThatOctoMapWrites) {
  const TemporaryFolder folder;
  const std::string theirs = bytes_by_octomap(folder);
  write_scan_graph(folder / "ours.graph", read_scan_graph(folder / "theirs.graph"));
  EXPECT_TRUE(read_whole_file(folder / "ours.graph") == theirs);
  octomap::ScanGraph back;
  ASSERT_TRUE(back.readBinary((folder / "ours.graph").string()));
  EXPECT_EQ(back.getNumPoints(), 2400U);
  write_scan_graph(folder / "empty.graph", {});
  EXPECT_TRUE(read_scan_graph(folder / "empty.graph").scans.empty());
}

TEST(ScanGraph, PlacesPointsToTheLastBitAsOctoMapDoes) {
  Random random(11);
  for (int i = 0; i < 20000; ++i) {
    const auto part = [&] { return static_cast<float>(random.normal() * 10); };
    const octomap::pose6d pose(part(), part(), part(), part(), part(), part());
    const octomap::point3d x(part(), part(), part());
    const GraphPose ours = pose_from(pose);
    ASSERT_EQ(ours * from_octomap(x), from_octomap(pose.transform(x)));
    const GraphPose back = graph_pose(rigid_transform(ours));
    ASSERT_EQ(back * from_octomap(x), from_octomap(pose.transform(x)));
  }
}

TEST(ScanGraph, MakesTheMapThatOctoMapMakesOfItByteForByte) {
  const TemporaryFolder folder;
  bytes_by_octomap(folder);
  for (const double resolution : {0.2, 0.05}) {
    OccupancyMap map({.resolution = resolution});
    for (const GraphScan& scan : read_scan_graph(folder / "theirs.graph").scans) {
      map.insert(world_cloud(scan));
    }
    octomap::ScanGraph graph;
    fill(graph);
    octomap::OcTree tree(resolution);
    for (const octomap::ScanNode* node : graph) tree.insertPointCloud(*node);
    std::ostringstream theirs;
    tree.write(theirs);
    EXPECT_TRUE(ot_bytes(map) == theirs.str());
  }
}

TEST(ScanGraph, FindsEveryTruncationAndSurvivesFlippedBits) {
  const TemporaryFolder folder;
  const std::string whole = bytes_by_octomap(folder).substr(0);
  for (std::size_t kept = 0; kept < whole.size(); kept += 1 + kept / 100) {
    const std::string sentence = error_of(
        [&] { parse_scan_graph(bytes_of_text(std::string_view(whole).substr(0, kept)), "g"); });
    EXPECT_FALSE(sentence.empty()) << kept;
  }
  EXPECT_NE(
      error_of([&] { parse_scan_graph(bytes_of_text(whole + "x"), "g"); }).find("1 bytes follow"),
      std::string::npos);
  Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    std::string damaged = whole;
    damaged[random.below(damaged.size())] = static_cast<char>(random.below(256));
    try {
      for (const GraphScan& scan : parse_scan_graph(bytes_of_text(damaged), "g").scans) {
        world_cloud(scan);
      }
    } catch (const Error&) {
      // A sentence is as good as a log: a flipped coordinate is not visible.
    }
  }
}

TEST(ScanGraph, SaysWhatIsWrongWithForeignFiles) {
  const auto sentence = [](const Bytes& bytes) {
    return error_of([&] { parse_scan_graph(bytes, "log.graph"); });
  };
  EXPECT_NE(sentence({}).find("torn"), std::string::npos);
  EXPECT_NE(sentence({255, 255, 255, 255, 0, 0}).find("4294967295 scans"), std::string::npos);
  Bytes bad_pose;
  put(bad_pose, std::uint32_t{1});
  put(bad_pose, std::uint32_t{0});
  put(bad_pose, std::uint32_t{3});
  for (int i = 0; i < 3; ++i) put(bad_pose, 0.0);
  put(bad_pose, std::uint32_t{4});
  for (int i = 0; i < 4; ++i) put(bad_pose, std::numeric_limits<double>::quiet_NaN());
  put(bad_pose, std::uint32_t{0});
  put(bad_pose, std::uint32_t{0});
  EXPECT_NE(sentence(bad_pose).find("pose"), std::string::npos);
  EXPECT_FALSE(error_of([] { read_scan_graph("none.graph"); }).empty());
}

TEST(ScanGraph, ReadsTheSphereOfOctoMapsAuthors) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/spherical_scan.graph");
  const ScanGraph graph = read_scan_graph(path);
  ASSERT_EQ(graph.scans.size(), 1U);
  const GraphScan& scan = graph.scans.front();
  EXPECT_EQ(scan.points.size(), 10201U);
  EXPECT_EQ(scan.world_from_scan.translation, Eigen::Vector3f(1, 0, -0.5F));
  OccupancyMap map({.resolution = 0.1});
  map.insert(world_cloud(scan));
  octomap::ScanGraph theirs;
  ASSERT_TRUE(theirs.readBinary(path.string()));
  octomap::OcTree tree(0.1);
  for (const octomap::ScanNode* node : theirs) tree.insertPointCloud(*node);
  std::ostringstream bytes;
  tree.write(bytes);
  EXPECT_TRUE(ot_bytes(map) == bytes.str());
}

}  // namespace
}  // namespace facula
