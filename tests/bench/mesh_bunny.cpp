// SPDX-License-Identifier: GPL-3.0-or-later
// The ten bunny scans with their published poses as meshes, measured against the published mesh.
//   mesh_bunny SET ROUNDS POINTS.ply        our methods; writes the oriented points for peers
//   mesh_bunny SET --judge NAME SECONDS MESH.ply     one row for a mesh that a peer made
// Both print rows of one Markdown table; mesh_peers.sh puts them together.
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>
#include <facula/reconstruct/mesh/mesh_method.hpp>
#include <facula/reconstruct/mesh/watertight.hpp>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace facula {
namespace {

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void print_row(const std::string& name,
               double seconds,
               const TriangleMesh& mesh,
               const TriangleMesh& published) {
  const MeshDeviation there = deviation_from_mesh(mesh.vertices, published);
  const MeshDeviation back = deviation_from_mesh(published.vertices, mesh);
  const MeshVerdict verdict = judge_mesh(mesh);
  std::printf("| %s | %.2f s | %zu | %.3f | %.3f | %.3f | %.3f | %s |\n",
              name.c_str(),
              seconds,
              mesh.triangles.size(),
              1000 * there.median,
              1000 * there.p95,
              1000 * back.median,
              1000 * back.p95,
              verdict.sentence().c_str());
}

void measure_ours(const std::filesystem::path& set, int rounds, const std::string& points) {
  const ScanProject project = read_scan_project(set / "data" / "bun.conf");
  const TriangleMesh published = read_mesh(set / "reconstruction" / "bun_zipper.ply");
  write_cloud(points, project.fused());
  std::vector<double> made;
  std::vector<double> closed;
  TriangleMesh mesh;
  WatertightResult tight;
  std::string method;
  for (int round = 0; round < rounds; ++round) {
    made.push_back(seconds_of([&] {
      const MethodChoice choice = choose_method(project);
      method = to_string(choice.method);
      MeshedScans meshed = mesh_scans(project, choice.method);
      mesh = without_islands(repaired(meshed.mesh), {.min_diameter = 10 * meshed.voxel});
    }));
    closed.push_back(made.back() + seconds_of([&] { tight = make_watertight(mesh); }));
  }
  print_row("auto (" + method + ")", median(made), mesh, published);
  print_row("auto, watertight and verified", median(closed), tight.mesh, published);
}

}  // namespace
}  // namespace facula

int main(int count, char** words) {
  using namespace facula;
  try {
    const std::vector<std::string> w(words + 1, words + count);
    require(w.size() >= 3, "usage: mesh_bunny SET ROUNDS POINTS.ply");
    const std::filesystem::path set = w[0];
    if (w[1] == "--judge") {
      require(w.size() == 5, "usage: mesh_bunny SET --judge NAME SECONDS MESH.ply");
      print_row(w[2],
                parse_number<double>(w[3]).value_or(0),
                read_mesh(w[4]),
                read_mesh(set / "reconstruction" / "bun_zipper.ply"));
    } else {
      measure_ours(set, parse_number<int>(w[1]).value_or(1), w[2]);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
