// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>
#include <facula/tests/support/triangles_by_place.hpp>

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

using Json = nlohmann::json;

class MeshInBlocks : public testing::Test {
 protected:
  void SetUp() override {
    const ProgramRun made = run(
        "facula simulate data/scenes/turntable_object.toml --rig data/rigs/ciclop_turntable.toml "
        "--step-deg 10 --out object && facula extract object --out object.pcd");
    ASSERT_EQ(made.code, 0) << made.err;
  }

  ProgramRun run(const std::string& line) const { return run_line(line, folder_.path()); }

  Json figures_of(const std::string& line) const {
    const ProgramRun meshed = run("facula mesh object.pcd --json - " + line);
    EXPECT_EQ(meshed.code, 0) << line << '\n' << meshed.err;
    const Json figures = Json::parse(meshed.out, nullptr, false);
    EXPECT_FALSE(figures.is_discarded()) << meshed.out;
    return figures;
  }

  TemporaryFolder folder_;
};

TEST_F(MeshInBlocks, GivesTheMeshThatMoreMemoryGives) {
  // At this voxel no pieces touch at a vertex, where cleaning would move it.
  const Json whole = figures_of("--voxel-mm 1.5 --min-island-mm 0 --out whole.ply");
  const Json pieces = figures_of("--voxel-mm 1.5 --memory-gb 0.004 --out pieces.ply");
  EXPECT_FALSE(whole.contains("blocks"));
  EXPECT_FALSE(whole.contains("vertices_split"));
  EXPECT_GE(pieces.at("blocks"), 2);
  EXPECT_EQ(pieces.at("voxel_mm"), whole.at("voxel_mm"));
  EXPECT_EQ(pieces.at("vertices"), whole.at("vertices"));
  EXPECT_EQ(pieces.at("triangles"), whole.at("triangles"));
  EXPECT_TRUE(triangles_by_place(read_mesh(folder_ / "pieces.ply")) ==
              triangles_by_place(read_mesh(folder_ / "whole.ply")));
  // The points of pieces that are removed still count in the distances, which is said.
  const Json largest = figures_of("--voxel-mm 1.5 --keep-largest --out largest.ply");
  EXPECT_GT(largest.at("islands_removed"), 0);
  EXPECT_EQ(largest.at("deviation").at("count"), whole.at("deviation").at("count"));
  EXPECT_GT(largest.at("deviation").at("max_mm"), whole.at("deviation").at("max_mm"));
  EXPECT_NE(largest.dump().find("also those of the pieces that were removed"), std::string::npos);
  EXPECT_EQ(whole.dump().find("pieces that were removed"), std::string::npos);
}

TEST_F(MeshInBlocks, RefusesWhatNeedsTheWholeMesh) {
  for (const std::string asked : {"--watertight --out result.ply",
                                  "--smooth 2 --out result.ply",
                                  "--out result.stl",
                                  "--out result.ply --out result.obj"}) {
    const ProgramRun refused = run("facula mesh object.pcd --memory-gb 0.004 " + asked);
    EXPECT_EQ(refused.code, 1) << asked;
    EXPECT_NE(refused.err.find("--memory-gb"), std::string::npos) << asked << refused.err;
    EXPECT_FALSE(has_file_like(folder_.path(), "result")) << asked;
  }
  EXPECT_EQ(run("facula mesh object.pcd --memory-gb -1 --out result.ply").code, 1);
}

}  // namespace
}  // namespace facula
