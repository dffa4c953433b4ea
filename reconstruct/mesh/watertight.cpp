// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>
#include <facula/reconstruct/mesh/watertight.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace facula {
namespace {

/// Takes away the triangles of the pairs and those within `rings` vertices of them.
std::size_t cut_out(TriangleMesh& mesh,
                    const std::vector<std::array<std::uint32_t, 2>>& pairs,
                    int rings) {
  std::vector<std::uint8_t> gone(mesh.triangles.size(), 0);
  for (const auto& [a, b] : pairs) gone[a] = gone[b] = 1;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::uint8_t> near(mesh.vertices.size(), 0);
    for (std::size_t t = 0; t < gone.size(); ++t) {
      if (gone[t] == 0) continue;
      for (const std::uint32_t v : mesh.triangles[t]) near[v] = 1;
    }
    for (std::size_t t = 0; t < gone.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) gone[t] |= near[v];
    }
  }
  return remove_triangles(mesh, gone);
}

/// Repaired, without small pieces.
TriangleMesh sound_part(const TriangleMesh& mesh,
                        const WatertightOptions& o,
                        WatertightResult& result) {
  std::size_t pieces = 0;
  TriangleMesh sound =
      repaired(without_islands(repaired(mesh), {.min_area = o.least_piece}, &pieces));
  result.pieces_removed += pieces;
  return sound;
}

TriangleMesh filled(const TriangleMesh& sound, WatertightResult& result) {
  std::size_t holes = 0;
  TriangleMesh closed = fill_holes(sound, std::numeric_limits<double>::infinity(), &holes);
  result.holes_filled += holes;
  return closed;
}

/// Fills every hole; where triangles cut each other, cuts wider and fills again.
void close_by_filling(const TriangleMesh& sound,
                      const WatertightOptions& o,
                      WatertightResult& result) {
  result.mesh = filled(sound, result);
  for (int round = 0; round < o.rounds; ++round) {
    const auto pairs = self_intersections(result.mesh, o.num_threads);
    const auto flat = triangles_without_area(result.mesh);
    const bool sound = std::find(flat.begin(), flat.end(), 1) == flat.end();
    if (pairs.empty() && sound) return;
    TriangleMesh open = result.mesh;
    result.triangles_cut += cut_out(open, pairs, 1 + round);
    if (open.empty()) return;
    result.mesh = filled(sound_part(open, o, result), result);
  }
}

/// Whether nearly all of the surface is left: wider and wider cuts eat up sheets that are thin.
bool is_left(const TriangleMesh& surface,
             double reach,
             const WatertightResult& result,
             const WatertightOptions& o) {
  if (result.triangles_cut == 0) return true;
  if (result.verdict.statistics.area <= 0) return false;
  return deviation_from_mesh(surface.vertices, result.mesh, o.num_threads).p95 <= reach;
}

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      sum += (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).norm();
    }
  }
  return sum / static_cast<double>(3 * mesh.triangles.size());
}

std::string filling_sentence(const WatertightResult& result) {
  std::ostringstream how;
  how << result.holes_filled << " holes filled";
  if (result.pieces_removed > 0) how << ", " << result.pieces_removed << " small pieces removed";
  if (result.triangles_cut > 0) {
    how << ", " << result.triangles_cut << " triangles replaced where some cut each other";
  }
  return how.str();
}

/// Closed and oriented so that it encloses a positive volume.
MeshVerdict judged(TriangleMesh& mesh,
                   const std::vector<Eigen::Vector3f>& points,
                   const WatertightOptions& o) {
  MeshVerdict verdict = judge_mesh(mesh, points, o.num_threads);
  if (verdict.volume.value_or(0) >= 0) return verdict;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  verdict.statistics.volume = -verdict.statistics.volume;
  verdict.volume = verdict.statistics.volume;
  return verdict;
}

}  // namespace

void WatertightOptions::check() const {
  require(least_piece >= 0 && least_piece <= 1, "least_piece is ", least_piece, "; give 0 to 1");
  require(rounds >= 0, "rounds is ", rounds, "; give 0 or more");
  require(wrap_alpha >= 0 && std::isfinite(wrap_alpha),
          "wrap_alpha is ",
          wrap_alpha,
          " m; give 0 or more");
}

WatertightResult make_watertight(const TriangleMesh& mesh,
                                 const std::vector<Eigen::Vector3f>& points,
                                 const WatertightOptions& options) {
  options.check();
  mesh.check();
  require(!mesh.empty(), "the mesh has no triangles; there is nothing to close");
  WatertightResult result;
  const TriangleMesh sound = sound_part(mesh, options, result);
  require(!sound.empty(), "the mesh has no triangle with an area; there is nothing to close");
  close_by_filling(sound, options, result);
  require(!result.mesh.empty(), "nothing is left of the mesh but triangles that cut each other");
  result.verdict = judged(result.mesh, points, options);
  result.how = filling_sentence(result);
  const double alpha = options.wrap_alpha > 0 ? options.wrap_alpha : 3 * mean_edge(mesh);
  const bool left = is_left(sound, alpha, result, options);
  if (left && result.verdict.watertight()) return result;
  const std::string wrong = left ? result.verdict.sentence() : "too little of the surface";
  require(options.allow_wrap,
          "the mesh could not be made watertight: after ",
          result.how,
          " there remain: ",
          wrong,
          "; allow an alpha wrap, or smooth or remesh first");
  result.mesh = wrap_mesh(left ? result.mesh : sound, {.alpha = alpha, .offset = 0});
  result.wrapped = true;
  result.verdict = judged(result.mesh, points, options);
  result.how = "wrapped at " + number_text(std::round(1e6 * alpha) / 1e3) +
               " mm, since filling left " + wrong;
  require(result.verdict.watertight(),
          "the mesh could not be made watertight: filling its holes left ",
          wrong,
          ", and wrapping it left ",
          result.verdict.sentence());
  return result;
}

}  // namespace facula
