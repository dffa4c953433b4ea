// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>

namespace facula {
namespace {

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1.1F, 0, 0}, {0, 1.3F, 0}, {0, 0, 1.7F}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

TEST(MeshFile, ReadsBackTheSameMesh) {
  const TemporaryFolder folder;
  TriangleMesh mesh = tetrahedron();
  mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0.6F, 0.8F, 0}};
  mesh.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 255}, {0, 128, 64}};
  for (const char* name : {"a.ply", "a.obj"}) {
    write_mesh(folder / name, mesh);
    const TriangleMesh read = read_mesh(folder / name);
    EXPECT_EQ(read.vertices, mesh.vertices) << name;
    EXPECT_EQ(read.triangles, mesh.triangles) << name;
    EXPECT_EQ(read.normals, mesh.normals) << name;
    EXPECT_EQ(read.colors, mesh.colors) << name;
  }
}

TEST(MeshFile, JoinsTheCornersOfAnStl) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.stl", tetrahedron());
  EXPECT_EQ(std::filesystem::file_size(folder / "a.stl"), 84U + 4 * 50);
  const MeshStatistics read = mesh_statistics(read_mesh(folder / "a.stl"));
  EXPECT_EQ(read.vertices, 4U);
  EXPECT_TRUE(read.watertight);
  EXPECT_DOUBLE_EQ(read.volume, mesh_statistics(tetrahedron()).volume);
}

TEST(MeshFile, ReadsAnAsciiStl) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("a.stl",
                   "solid a vertex of parts\r\n facet normal 0 0 1\r\n  outer loop\r\n"
                   "   vertex 0 0 0\r\n   vertex 1 0 0\r\n   vertex 0 1e0 0\r\n"
                   "  endloop\r\n endfacet\r\nendsolid a vertex\r\n");
  const TriangleMesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.vertices.size(), 3U);
  EXPECT_DOUBLE_EQ(mesh_statistics(mesh).area, 0.5);
}

TEST(MeshFile, SplitsPolygonsIntoFans) {
  const TemporaryFolder folder;
  const auto obj = folder.write("a.obj",
                                "# square and triangle\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n"
                                "vt 0 0\nusemtl x\nf 1/1 2/1 3/1 4/1\nf -4 -3 -2\n");
  EXPECT_EQ(read_mesh(obj).triangles,
            (std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  const auto ply = folder.write("a.ply",
                                "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\n"
                                "property float y\nproperty float z\nelement face 1\n"
                                "property list uchar int vertex_index\nend_header\n"
                                "0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n");
  EXPECT_DOUBLE_EQ(mesh_statistics(read_mesh(ply)).area, 2.5);  // by the shoelace formula
}

TEST(MeshFile, ScalesByItsUnit) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.obj", "a.stl"}) {
    write_mesh(folder / name, tetrahedron(), 0.001);
    const double in_file = mesh_statistics(read_mesh(folder / name)).volume;
    EXPECT_NEAR(in_file / 1e9, 1.1 * 1.3 * 1.7 / 6, 1e-6) << name;
    EXPECT_NEAR(mesh_statistics(read_mesh(folder / name, 0.001)).volume, in_file / 1e9, 1e-6);
  }
  EXPECT_THROW(read_mesh(folder / "a.ply", 0), Error);
  EXPECT_THROW(read_mesh(folder / "a.ply", std::nan("")), Error);
}

TEST(MeshFile, SaysWhatIsWrongWithABadFile) {
  const TemporaryFolder folder;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::vector<std::array<std::string, 3>> cases{
      {"far.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "names vertex 3"},
      {"minus.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "names vertex -1"},
      {"two.ply", ply + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "2 corners"},
      {"nan.ply", ply + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n", "not a finite point"},
      {"noface.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
       "property float z\nend_header\n1 2 3\n",
       "no element 'face'"},
      {"far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "names '4'"},
      {"zero.obj", "v 0 0 0\nf 0 0 0\n", "names '0'"},
      {"minus.obj", "v 0 0 0\nf 1 1 -9223372036854775808\n", "-9223372036854775808"},
      {"word.obj", "v 0 zero 0\n", "line 1 of"},
      {"inf.obj", "v 0 0 0\nv 1e99 0 0\nv 0 1 0\nf 1 2 3\n", "not a finite point"},
      {"none.obj", "v 0 0 0\n", "holds no triangles"},
      {"short.stl", "soli", "is no STL file"},
      {"torn.stl", std::string(84, '\1'), "torn one"},
      {"open.stl", "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop", "endsolid"},
      {"two.stl", "solid\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendsolid", "exactly three"},
      {"word.stl", "solid\nvertex 0 0 x\nendsolid", "'x' where a vertex"},
      {"none.stl", "solid\nendsolid\n", "holds no triangles"},
      {"a.fbx", "", "ends in .ply, .obj, .stl or .off"}};
  for (const auto& [name, text, expected] : cases) {
    const auto path = folder.write(name, text);
    const std::string sentence = error_of([&] { read_mesh(path); });
    EXPECT_NE(sentence.find(path.string()), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(expected), std::string::npos) << sentence;
  }
}

TEST(MeshFile, RefusesToWriteWhatNobodyCouldRead) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_mesh(folder / "a.ply", TriangleMesh()), Error);
  EXPECT_THROW(write_mesh(folder / "a.fbx", tetrahedron()), Error);
  TriangleMesh bad = tetrahedron();
  bad.vertices[2].x() = std::nanf("");
  EXPECT_THROW(write_mesh(folder / "a.stl", bad), Error);
  bad = tetrahedron();
  bad.triangles[0][0] = 4;
  EXPECT_THROW(write_mesh(folder / "a.obj", bad), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(MeshFile, SurvivesEveryTruncation) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.stl"}) {
    write_mesh(folder / name, tetrahedron());
    const std::string whole = read_whole_file(folder / name);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const auto path = folder.write(std::string("torn_") + name, whole.substr(0, length));
      EXPECT_THROW(read_mesh(path), Error) << length << " of " << whole.size() << " bytes";
    }
  }
}

TEST(MeshFile, ReadsTheStanfordBunny) {
  FACULA_REQUIRE_REAL_DATA(path, "range/stanford-bunny/reconstruction/bun_zipper.ply");
  EXPECT_EQ(read_mesh(path).triangles.size(), 69451U);  // as Stanford's page says
}

}  // namespace
}  // namespace facula
