// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/map/frontiers.hpp>
#include <facula/map/map_yaml.hpp>

#include <array>

namespace facula {

void write_frontiers_csv(const std::filesystem::path& path, const Frontiers& frontiers) {
  AtomicFile file(path);
  file.stream() << "rank,x_m,y_m,z_m,volume_m3,volume_alone_m3,region_x_m,region_y_m,region_z_m,"
                   "region_cells,region_area_m2,region_volume_m3\n";
  std::size_t rank = 0;
  for (const ScanSuggestion& s : frontiers.suggestions) {
    file.stream() << std::to_string(++rank);
    const std::array<double, 11> values = {s.position.x(),
                                           s.position.y(),
                                           s.position.z(),
                                           s.volume,
                                           s.volume_alone,
                                           s.region.centre.x(),
                                           s.region.centre.y(),
                                           s.region.centre.z(),
                                           static_cast<double>(s.region.cells),
                                           s.region.area,
                                           s.region_volume};
    for (const double value : values) file.stream() << ',' << exact_text(value);
    file.stream() << '\n';
  }
  file.commit();
}

}  // namespace facula
