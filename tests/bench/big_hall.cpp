// SPDX-License-Identifier: GPL-3.0-or-later
// big_hall [--small] [--memory-gb G] [--voxel-mm V]: meshes a simulated hall of 20 million points
// in blocks and prints time, peak memory and the deviation of the mesh from the hall, in Markdown.
#include <facula/reconstruct/filter/point_spacing.hpp>
#include <facula/reconstruct/mesh/streamed_ply.hpp>
#include <facula/reconstruct/mesh/volumetric_blocks.hpp>
#include <facula/tests/bench/hall.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

namespace facula {
namespace {

double peak_gigabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024e-9 * static_cast<double>(usage.ru_maxrss);
}

int run(const HallOptions& hall, const VolumetricOptions& options) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("hall-" + std::to_string(getpid()) + ".ply");
  std::size_t points = 0;
  const ScanSource source{static_cast<std::size_t>(hall.stations), [&](std::size_t i) {
                            PosedCloud scan = hall_scan(i, hall);
                            points = scan.cloud.size() * static_cast<std::size_t>(hall.stations);
                            return scan;
                          }};
  StreamedPly file(path);
  std::vector<float> away;
  const auto start = std::chrono::steady_clock::now();
  const BlockMergeResult merged = merge_volumetric_in_blocks(
      source,
      [&](const auto& vertices, const auto& triangles) {
        file.add(vertices, triangles);
        for (std::size_t v = 0; v < vertices.size(); v += 16) {
          away.push_back(static_cast<float>(distance_to_hall(vertices[v].template cast<double>())));
        }
      },
      options);
  file.commit();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(path));
  std::filesystem::remove(path);
  std::printf(
      "| points | voxel | blocks | triangles | file | time | peak memory | deviation, median "
      "| p95 |\n|---|---|---|---|---|---|---|---|---|\n"
      "| %.1f million | %.0f mm | %zu | %.1f million | %.0f MB | %.0f s | %.2f GB | %.2f mm "
      "| %.2f mm |\n",
      1e-6 * static_cast<double>(points),
      1e3 * merged.voxel,
      merged.blocks,
      1e-6 * static_cast<double>(merged.triangles),
      megabytes,
      seconds,
      peak_gigabytes(),
      1e3 * quantile(away, 0.5),
      1e3 * quantile(away, 0.95));
  return 0;
}

}  // namespace
}  // namespace facula

int main(int argc, char** argv) {
  facula::HallOptions hall;
  facula::VolumetricOptions options{.voxel = 0.025};
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--small") == 0) {
      hall.stations = 2;
      hall.rows = 100;
      hall.cols = 250;
      options.voxel = 0.25;
      options.max_memory = 2e7;
    } else if (std::strcmp(argv[i], "--memory-gb") == 0 && i + 1 < argc) {
      options.max_memory = 1e9 * std::atof(argv[++i]);
    } else if (std::strcmp(argv[i], "--voxel-mm") == 0 && i + 1 < argc) {
      options.voxel = 1e-3 * std::atof(argv[++i]);
    } else {
      std::fprintf(stderr, "usage: big_hall [--small] [--memory-gb G] [--voxel-mm V]\n");
      return 2;
    }
  }
  try {
    return facula::run(hall, options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
