// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/simulate/sheet_tracer.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <algorithm>
#include <optional>

namespace facula {

PolarScan true_scan(const Scene& scene,
                    const Rig& rig,
                    const RigidTransform& world_from_scan,
                    const std::vector<double>& positions,
                    const SimulateOptions& options) {
  const LaserFan fan = laser_fan(rig, options);
  const SheetTracer blank(scene, rig, fan, options.laser_colour);
  PolarScan scan =
      PolarScan::empty(static_cast<int>(blank.rows()), static_cast<int>(positions.size()));
  scan.world_from_scan = world_from_scan;
  scan.axis_position = positions;
  const auto trace_columns = [&](std::size_t begin, std::size_t end) {
    SheetTracer tracer = blank;
    for (std::size_t col = begin; col < end; ++col) {
      const RigidTransform scan_from_camera = rig.axis.scan_from_camera_at(positions[col]);
      scan.sensor_origin[col] = scan_from_camera.translation;
      tracer.place(world_from_scan * scan_from_camera);
      const std::vector<std::optional<FanHit>> hits = tracer.trace();
      for (std::size_t row = 0; row < hits.size(); ++row) {
        if (!hits[row]) continue;
        const double signal = std::min(tracer.brightness(*hits[row]) / 255, 1.0);
        scan.set(scan.index(static_cast<int>(row), static_cast<int>(col)),
                 scan_from_camera * hits[row]->x,
                 static_cast<float>(signal),
                 0.0F);
      }
    }
  };
  parallel_for(positions.size(), trace_columns, {.num_threads = options.num_threads, .chunk = 1});
  return scan;
}

}  // namespace facula
