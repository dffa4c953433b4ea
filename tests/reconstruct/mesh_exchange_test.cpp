// SPDX-License-Identifier: GPL-3.0-or-later
// What write_mesh() writes as glTF, read back by another library.
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/mesh/mesh_exchange.hpp>
#include <facula/tests/reconstruct/mesh_shapes.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

TriangleMesh colored_torus() {
  TriangleMesh mesh = torus(0.05, 0.02, 24, 12);
  Random random(7);
  for (const Eigen::Vector3f& v : mesh.vertices) {
    mesh.normals.push_back(v.normalized());
    mesh.colors.push_back({std::uint8_t(random.below(256)),
                           std::uint8_t(random.below(256)),
                           std::uint8_t(random.below(256))});
  }
  return mesh;
}

TEST(MeshExchange, GltfReadsBackBitForBitInMetres) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = colored_torus();
  write_mesh(folder / "a.glb", mesh);
  const TriangleMesh read = read_any_mesh(folder / "a.glb");
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.triangles, mesh.triangles);
  EXPECT_EQ(read.normals, mesh.normals);
  EXPECT_EQ(read.colors, mesh.colors);
}

TEST(MeshExchange, GltfStandsUprightWithBounds) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.glb", box_mesh(1, 2, 3));
  const std::string bytes = read_whole_file(folder / "a.glb");
  EXPECT_EQ(bytes.size() % 4, 0U);
  // z up (3) becomes y up; y (2) becomes -z.
  EXPECT_NE(bytes.find("\"min\":[0,0,-2],\"max\":[1,3,-0]"), std::string::npos)
      << bytes.substr(20, 900);
}

TEST(MeshExchange, RefusesTornGltfFiles) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.glb", box_mesh(1, 2, 3));
  const std::string whole = read_whole_file(folder / "a.glb");
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    const auto path = folder.write("torn.glb", whole.substr(0, length));
    EXPECT_NE(error_of([&] { read_any_mesh(path); }).find("torn.glb"), std::string::npos);
  }
  EXPECT_NE(error_of([&] { read_any_mesh(folder / "none.glb"); }), "");
  EXPECT_NE(error_of([&] { write_mesh(folder / "b.glb", box_mesh(1, 1, 1), 0.001); }), "");
}

TEST(MeshExchange, OffReadsBackAndRefusesWhatIsTorn) {
  const TemporaryFolder folder;
  TriangleMesh mesh = colored_torus();
  mesh.normals.clear();
  write_mesh(folder / "a.off", mesh);
  const TriangleMesh read = read_any_mesh(folder / "a.off");
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.triangles, mesh.triangles);
  EXPECT_EQ(read.colors, mesh.colors);
  const auto square = folder.write(
      "s.off", "OFF # a square\n\n4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n");
  EXPECT_DOUBLE_EQ(mesh_statistics(read_any_mesh(square)).area, 1);
  const std::vector<std::array<std::string, 3>> cases{
      {"word.off", "PLY\n", "begins with 'PLY'"},
      {"huge.off", "OFF\n99999999999 1 0\n", "torn"},
      {"short.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "ends where"},
      {"far.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "names vertex 3"},
      {"two.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "2 corners"},
      {"nan.off", "OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n", "not a finite point"},
      {"none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "holds no triangles"},
      {"long.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", "index of a vertex"},
      {"x.off", "OFF\n3 1 0\n0 zero 0\n1 0 0\n0 1 0\n3 0 1 2\n", "'zero'"}};
  for (const auto& [name, text, expected] : cases) {
    const auto path = folder.write(name, text);
    const std::string sentence = error_of([&] { read_any_mesh(path); });
    EXPECT_NE(sentence.find(expected), std::string::npos) << name << ": " << sentence;
  }
}

}  // namespace
}  // namespace facula
