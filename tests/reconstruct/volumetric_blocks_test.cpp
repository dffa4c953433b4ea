// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/reconstruct/mesh/brick_blocks.hpp>
#include <facula/reconstruct/mesh/streamed_ply.hpp>
#include <facula/reconstruct/mesh/volumetric_blocks.hpp>
#include <facula/tests/reconstruct/simulated_grids.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>
#include <facula/tests/support/triangles_by_place.hpp>

#include <algorithm>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

ScanProject sphere_scans() {
  return six_views(sphere_range(0.1), 1, {.eye = {}, .target = {}, .half_angle = 0.12});
}

ScanSource source_of(const ScanProject& project) {
  return {project.scans.size(), [&project](std::size_t i) { return project.scans[i]; }};
}

TEST(VolumetricBlocks, GiveTheMeshOfTheWholeTriangleByTriangle) {
  const ScanProject scans = sphere_scans();
  const TriangleMesh whole = merge_volumetric(scans).mesh;
  for (const double memory : {2e6, 4e5}) {
    TriangleMesh pieces;
    const auto join = [&](const auto& vertices, const auto& triangles) {
      pieces.vertices.insert(pieces.vertices.end(), vertices.begin(), vertices.end());
      pieces.triangles.insert(pieces.triangles.end(), triangles.begin(), triangles.end());
      pieces.check();  // triangles name only vertices that have come
    };
    const BlockMergeResult merged =
        merge_volumetric_in_blocks(source_of(scans), join, {.max_memory = memory});
    EXPECT_GE(merged.blocks, 8U);
    EXPECT_LE(static_cast<double>(merged.largest_block) * sizeof(Brick), memory / 4);
    EXPECT_EQ(merged.vertices, whole.vertices.size());
    EXPECT_EQ(merged.triangles, whole.triangles.size());
    EXPECT_TRUE(triangles_by_place(pieces) == triangles_by_place(whole));
    EXPECT_TRUE(mesh_statistics(pieces).watertight);
  }
}

TEST(VolumetricBlocks, ReadNoScanForABlockThatItDoesNotReach) {
  ScanProject scans;
  for (const float x : {0.0F, 10.0F}) {
    const Viewpoint view{.eye = {0, 0, 1}, .target = {0, 0, 0}, .half_angle = 0.12};
    scans.scans.push_back(simulated_grid(view, sphere_range(0.1)));
    scans.scans.back().world_from_scan.translation.x() += static_cast<double>(x);
  }
  const auto forget = [](const auto&, const auto&) {};
  const BlockMergeResult merged =
      merge_volumetric_in_blocks(source_of(scans), forget, {.voxel = 2e-3, .max_memory = 6e6});
  EXPECT_GE(merged.blocks, 2U);
  EXPECT_EQ(merged.loads, 2 + merged.blocks);  // each once to look, and one scan for every block
}

TEST(VolumetricBlocks, SplitsBricksIntoBoxesThatHoldEachOnce) {
  std::vector<BrickPlace> bricks;
  bricks.reserve(2000);
  for (int i = 0; i < 2000; ++i) bricks.emplace_back(i % 40, (i / 40) % 10, i * i % 7);
  std::sort(bricks.begin(), bricks.end(), [](const BrickPlace& a, const BrickPlace& b) {
    return brick_key(a) < brick_key(b);
  });
  bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
  const std::vector<BrickBlock> blocks = split_into_blocks(bricks, 100);
  for (const BrickPlace& brick : bricks) {
    EXPECT_EQ(
        std::count_if(
            blocks.begin(), blocks.end(), [&](const BrickBlock& b) { return b.own.holds(brick); }),
        1);
  }
  for (const BrickBlock& block : blocks) EXPECT_LE(block.bricks, 100U);
  EXPECT_TRUE(split_into_blocks({}, 10).empty());
  EXPECT_EQ(split_into_blocks(bricks, 1).size(), bricks.size());
}

TEST(VolumetricBlocks, SayWhereNotEvenThePlacesOfTheVoxelsFit) {
  const ScanProject scans = sphere_scans();
  const auto forget = [](const auto&, const auto&) {};
  const std::string refusal = error_of([&] {
    merge_volumetric_in_blocks(source_of(scans), forget, {.voxel = 2e-4, .max_memory = 4e5});
  });
  EXPECT_NE(refusal.find("GB"), std::string::npos) << refusal;
}

TEST(VolumetricBlocks, RefuseASourceWithoutASurface) {
  const auto forget = [](const auto&, const auto&) {};
  const ScanSource nothing{3, [](std::size_t) { return PosedCloud{}; }};
  EXPECT_NE(error_of([&] { merge_volumetric_in_blocks(nothing, forget); }).find("none of the 3"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              merge_volumetric_in_blocks(nothing, forget, {.voxel = 1e-3});
            }).find("none of the 3"),
            std::string::npos);
}

TEST(StreamedPly, ReadsBackAsWritten) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "mesh.ply";
  StreamedPly file(path);
  file.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  file.add({{1, 1, 0.5}}, {{1, 3, 2}});
  EXPECT_FALSE(std::filesystem::exists(path));
  file.commit();
  const TriangleMesh mesh = read_mesh(path);
  ASSERT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.vertices[3], Eigen::Vector3f(1, 1, 0.5));
  const std::vector<TriangleMesh::Triangle> triangles{{0, 1, 2}, {1, 3, 2}};
  EXPECT_EQ(mesh.triangles, triangles);
}

TEST(StreamedPly, LeavesNothingBehindWithoutCommit) {
  const TemporaryFolder folder;
  {
    StreamedPly file(folder.path() / "mesh.ply");
    file.add({{0, 0, 0}}, {{0, 0, 7}});
    EXPECT_NE(error_of([&] { file.commit(); }).find("names vertex 7 of 1"), std::string::npos);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace facula
