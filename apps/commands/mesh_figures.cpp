// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/mesh_figures.hpp>

#include <algorithm>

namespace facula {
namespace {

constexpr std::size_t kMostLoops = 12;  ///< listed one by one [1]

void report_loops(const MeshVerdict& verdict, Figures& figures) {
  figures.count("boundary_loops", "boundary loops", verdict.loops.size());
  if (verdict.loops.empty()) return;
  FigureTable table;
  table.key = "loops";
  table.title = verdict.loops.size() > kMostLoops ? "Longest boundary loops:" : "Boundary loops:";
  table.columns = {{"length_mm", "length", 3}, {"diameter_mm", "across", 3}, {"edges", "edges", 0}};
  for (std::size_t i = 0; i < std::min(kMostLoops, verdict.loops.size()); ++i) {
    const BoundaryLoop& loop = verdict.loops[i];
    table.rows.push_back(
        {1000 * loop.length, 1000 * loop.diameter, static_cast<long long>(loop.edges)});
  }
  figures.table(std::move(table));
}

void report_deviation(const MeshDeviation& deviation, Figures& figures) {
  Figures& part = figures.part("deviation", "Distance of the points to the mesh:");
  part.count("count", "points", deviation.points);
  part.number("median_mm", "median", 1000 * deviation.median, 3);
  part.number("p95_mm", "p95", 1000 * deviation.p95, 3);
  part.number("max_mm", "largest", 1000 * deviation.max, 3);
}

}  // namespace

void report_verdict(const MeshVerdict& verdict, Figures& figures) {
  const MeshStatistics& statistics = verdict.statistics;
  figures.count("vertices", "vertices", statistics.vertices);
  figures.count("triangles", "triangles", statistics.triangles);
  figures.number("area_m2", "area", statistics.area, 6);
  figures.count("components", "pieces", statistics.components);
  figures.text("verdict", "verdict", verdict.sentence());
  figures.flag("watertight", "watertight", verdict.watertight());
  figures.flag("closed", "closed", verdict.closed);
  figures.flag("manifold", "manifold", verdict.manifold);
  figures.count("self_intersections", "pairs of triangles that cut", verdict.self_intersections);
  figures.count("boundary_edges", "boundary edges", statistics.boundary_edges);
  figures.count("non_manifold_edges", "non-manifold edges", statistics.non_manifold_edges);
  if (verdict.genus) figures.count("handles", "handles", static_cast<std::size_t>(*verdict.genus));
  if (verdict.volume) figures.number("volume_m3", "volume", *verdict.volume, 9);
  report_loops(verdict, figures);
  if (verdict.deviation) report_deviation(*verdict.deviation, figures);
}

void report_mesh(const TriangleMesh& mesh, Figures& figures) {
  report_verdict(judge_mesh(mesh), figures);
}

}  // namespace facula
