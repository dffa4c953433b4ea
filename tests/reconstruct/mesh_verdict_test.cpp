// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/mesh/mesh_topology.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>
#include <facula/tests/reconstruct/mesh_shapes.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(MeshVerdict, CallsASphereWatertightAndKnowsItsVolume) {
  const MeshVerdict verdict = judge_mesh(sphere_mesh(0.5, 5));
  EXPECT_TRUE(verdict.watertight());
  EXPECT_EQ(verdict.genus, 0);
  EXPECT_NEAR(*verdict.volume, 4 * M_PI / 3 * 0.125, 0.003 * 0.125 * 4);
  EXPECT_TRUE(verdict.loops.empty());
  EXPECT_FALSE(verdict.deviation.has_value());
}

TEST(MeshVerdict, CountsTheHandlesOfToriOverAllPieces) {
  TriangleMesh mesh = torus(1, 0.3, 60, 30);
  MeshVerdict verdict = judge_mesh(mesh);
  EXPECT_EQ(verdict.genus, 1);
  // Pappus: 2 pi^2 R r^2.
  EXPECT_NEAR(std::abs(*verdict.volume), 2 * M_PI * M_PI * 0.09, 0.02);
  add_mesh(mesh, torus(1, 0.3, 40, 20), {5, 0, 0});
  add_mesh(mesh, box_mesh(1, 1, 1), {0, 5, 0});
  verdict = judge_mesh(mesh);
  EXPECT_EQ(verdict.genus, 2);
  EXPECT_EQ(verdict.statistics.components, 3U);
}

TEST(MeshVerdict, MeasuresTheLoopsOfABoxWithItsLidsOff) {
  TriangleMesh box = box_mesh(1, 2, 3);
  box.triangles.erase(box.triangles.begin(), box.triangles.begin() + 2);  // bottom, 1 x 2
  const MeshVerdict one = judge_mesh(box);
  ASSERT_EQ(one.loops.size(), 1U);
  EXPECT_EQ(one.loops[0].edges, 4U);
  EXPECT_NEAR(one.loops[0].length, 6, 1e-12);
  EXPECT_NEAR(one.loops[0].diameter, std::sqrt(5.0), 1e-12);
  EXPECT_FALSE(one.closed);
  EXPECT_TRUE(one.manifold);
  EXPECT_FALSE(one.volume.has_value());
  box.triangles.erase(box.triangles.end() -
                      1);  // half of the right side: edges of 2 and 3 and its diagonal
  const MeshVerdict two = judge_mesh(box);
  ASSERT_EQ(two.loops.size(), 1U) << "the openings touch at a corner of one sheet";
  EXPECT_NEAR(two.loops[0].length, 6 + 2 + 3 + std::sqrt(13.0), 1e-12);
}

TEST(MeshVerdict, KeepsRimsApartThatTouchAtAVertex) {
  const auto flat = [](double u, double v) { return Eigen::Vector3d(v, u, 0); };
  const TriangleMesh sheet = grid_surface(5, 5, flat);
  // Two square holes of side 1/4 that share a corner.
  const TriangleMesh holed = without(sheet, [](const Eigen::Vector3f& c) {
    return (c.x() > 0.25F && c.x() < 0.5F && c.y() > 0.25F && c.y() < 0.5F) ||
           (c.x() > 0.5F && c.x() < 0.75F && c.y() > 0.5F && c.y() < 0.75F);
  });
  const MeshVerdict verdict = judge_mesh(holed);
  EXPECT_EQ(verdict.non_manifold_vertices, 1U);
  double length = 0;
  for (const BoundaryLoop& loop : verdict.loops) length += loop.length;
  EXPECT_NEAR(length, 4 + 1 + 1, 1e-6);
  EXPECT_NEAR(verdict.loops[0].length, 4, 1e-6);
}

TEST(MeshVerdict, KnowsAMoebiusBandByItsTurnedEdges) {
  const auto at = [](double u, double v) {
    const double a = 2 * M_PI * u;
    const double w = 0.3 * (v - 0.5);
    return Eigen::Vector3d((1 + w * std::cos(a / 2)) * std::cos(a),
                           (1 + w * std::cos(a / 2)) * std::sin(a),
                           w * std::sin(a / 2));
  };
  constexpr std::uint32_t kAround = 60;
  constexpr std::uint32_t kAcross = 5;
  TriangleMesh band = grid_surface(kAround + 1, kAcross, at);
  for (auto& t : band.triangles) {  // the last row is the first one the other way round
    for (auto& v : t) {
      if (v >= kAround * kAcross) v = kAcross - 1 - (v - kAround * kAcross);
    }
  }
  band.vertices.resize(std::size_t{kAround} * kAcross);
  const MeshVerdict verdict = judge_mesh(band);
  EXPECT_FALSE(verdict.manifold);
  EXPECT_EQ(verdict.turned_edges, kAcross - 1);
  ASSERT_EQ(verdict.loops.size(), 1U) << "a Moebius band has one rim";
  EXPECT_EQ(verdict.loops[0].edges, 2 * kAround);
  EXPECT_EQ(verdict.self_intersections, 0U);
}

TEST(MeshVerdict, FindsFinsAndTouchingPieces) {
  TriangleMesh fin = box_mesh(1, 1, 1);
  fin.vertices.emplace_back(2, 2, 2);
  fin.triangles.push_back({6, 7, 8});
  const MeshVerdict with_fin = judge_mesh(fin);
  EXPECT_EQ(with_fin.statistics.non_manifold_edges, 1U);
  EXPECT_FALSE(with_fin.manifold);
  EXPECT_FALSE(with_fin.closed);

  TriangleMesh corner = box_mesh(1, 1, 1);
  add_mesh(corner, box_mesh(1, 1, 1), {1, 1, 1});
  for (auto& t : corner.triangles) {
    for (auto& v : t) v = v == 8 ? 7 : v;  // one vertex for both boxes
  }
  const MeshVerdict touching = judge_mesh(corner);
  EXPECT_EQ(touching.non_manifold_vertices, 1U);
  EXPECT_TRUE(touching.closed);
  EXPECT_FALSE(touching.manifold);
  EXPECT_EQ(touching.self_intersections, 0U) << "they share a vertex, so they may touch there";
}

TEST(MeshVerdict, FindsATurnedTriangleAndAMeshInsideOut) {
  TriangleMesh turned = box_mesh(1, 1, 1);
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_EQ(judge_mesh(turned).turned_edges, 3U);
  TriangleMesh inside_out = box_mesh(1, 1, 1);
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  const MeshVerdict verdict = judge_mesh(inside_out);
  EXPECT_TRUE(verdict.manifold);
  EXPECT_FALSE(verdict.watertight());
  EXPECT_EQ(verdict.sentence(), "turned inside out");
}

TEST(MeshVerdict, BearsBadMeshes) {
  EXPECT_FALSE(judge_mesh({}).watertight());
  EXPECT_EQ(judge_mesh({}, {{0, 0, 0}}).sentence(), "no triangles");
  TriangleMesh bad = box_mesh(1, 1, 1);
  bad.vertices[0].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(judge_mesh(bad, {{0, 0, 0}}).triangles_without_area, 3U);
  bad.triangles.push_back({0, 1, 99});
  EXPECT_NE(error_of([&] { judge_mesh(bad); }).find("99"), std::string::npos);
}

TEST(MeshVerdict, TellsTheDeviationOfPoints) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i <= 100; ++i) points.emplace_back(0.4F, 0.3F, -0.001F * float(i));
  points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0, 0);
  const MeshVerdict verdict = judge_mesh(box_mesh(1, 1, 1), points);
  ASSERT_TRUE(verdict.deviation.has_value());
  EXPECT_EQ(verdict.deviation->points, 101U);
  EXPECT_NEAR(verdict.deviation->median, 0.050, 1e-7);
  EXPECT_NEAR(verdict.deviation->p95, 0.095, 1e-7);
  EXPECT_NEAR(verdict.deviation->max, 0.100, 1e-7);
}

TEST(SelfIntersections, AreThePairsWhereTwoBoxesCut) {
  TriangleMesh boxes = box_mesh(1, 1, 1);
  add_mesh(boxes, box_mesh(1, 1, 1), {0.5F, 0.25F, 2});
  EXPECT_TRUE(self_intersections(boxes).empty());
  boxes = box_mesh(1, 1, 1);
  // A thin post through the middle of bottom and top, clear of their diagonals.
  add_mesh(boxes, box_mesh(0.1F, 0.1F, 3), {0.1F, 0.2F, -1});
  const auto pairs = self_intersections(boxes);
  // Each of the post's eight side triangles spans its whole length or half of it: count by hand is
  // the brute-force test's business; here the pairs must name one triangle of each box.
  EXPECT_FALSE(pairs.empty());
  for (const auto& [a, b] : pairs) {
    EXPECT_LT(a, 12U);
    EXPECT_GE(b, 12U);
  }
}

/// Whether a segment passes through the inside of a triangle, by volumes in long double.
bool pierces(const std::array<Eigen::Vector3f, 2>& s, const std::array<Eigen::Vector3f, 3>& t) {
  using V = Eigen::Matrix<long double, 3, 1>;
  const auto volume = [](const V& a, const V& b, const V& c, const V& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  const V p = s[0].cast<long double>();
  const V q = s[1].cast<long double>();
  const V a = t[0].cast<long double>();
  const V b = t[1].cast<long double>();
  const V c = t[2].cast<long double>();
  if (volume(a, b, c, p) * volume(a, b, c, q) >= 0) return false;
  const long double u = volume(p, q, a, b);
  const long double v = volume(p, q, b, c);
  const long double w = volume(p, q, c, a);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

TEST(SelfIntersections, AreThoseOfBruteForceOnTwoSpheresThatCut) {
  TriangleMesh mesh = sphere_mesh(1, 3);
  add_mesh(mesh, sphere_mesh(1, 3), {0.713F, 0.131F, 0.057F});
  std::vector<std::array<std::uint32_t, 2>> expected;
  const auto corners = [&](std::uint32_t t) {
    return std::array<Eigen::Vector3f, 3>{mesh.vertices[mesh.triangles[t][0]],
                                          mesh.vertices[mesh.triangles[t][1]],
                                          mesh.vertices[mesh.triangles[t][2]]};
  };
  for (std::uint32_t a = 0; a < 512; ++a) {
    for (std::uint32_t b = 512; b < 1024; ++b) {
      const auto p = corners(a);
      const auto q = corners(b);
      bool cut = false;
      for (std::size_t i = 0; i < 3; ++i) {
        cut = cut || pierces({p[i], p[(i + 1) % 3]}, q) || pierces({q[i], q[(i + 1) % 3]}, p);
      }
      if (cut) expected.push_back({a, b});
    }
  }
  EXPECT_GT(expected.size(), 50U);
  EXPECT_EQ(self_intersections(mesh, 1), expected);
  EXPECT_EQ(self_intersections(mesh, 2), expected);
}

TEST(SelfIntersections, CountFoldsDoublesAndTouches) {
  TriangleMesh fold;  // the second triangle folded back over the first
  fold.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1F, 0.5F, 0}};
  fold.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(self_intersections(fold).size(), 1U);
  fold.vertices[3] = {0.1F, -0.5F, 0};
  EXPECT_TRUE(self_intersections(fold).empty());
  TriangleMesh doubled = box_mesh(1, 1, 1);
  doubled.triangles.push_back({2, 1, 0});
  EXPECT_EQ(self_intersections(doubled).size(), 1U);
  TriangleMesh touching;  // a corner in the middle of another triangle
  touching.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}};
  touching.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(self_intersections(touching).size(), 1U);
}

TEST(SelfIntersections, LeaveOutTrianglesWithoutArea) {
  TriangleMesh mesh = box_mesh(1, 1, 1);
  mesh.triangles.push_back({0, 0, 7});
  mesh.vertices.emplace_back(0.5F, 0.5F, 0.5F);
  mesh.triangles.push_back({0, 8, 7});  // exactly on the diagonal of the box
  EXPECT_TRUE(self_intersections(mesh).empty());
  EXPECT_EQ(judge_mesh(mesh).triangles_without_area, 2U);
}

TEST(MeshVerdict, OfThePublishedBunnyFindsItsFiveHoles) {
  FACULA_REQUIRE_REAL_DATA(path, "range/stanford-bunny/reconstruction/bun_zipper.ply");
  const MeshVerdict verdict = judge_mesh(read_mesh(path));
  EXPECT_EQ(verdict.loops.size(), 5U);  // as its page says
  EXPECT_TRUE(verdict.manifold);
  EXPECT_EQ(verdict.statistics.components, 1U);
}

}  // namespace
}  // namespace facula
