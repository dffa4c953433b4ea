// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/map_settings.hpp>

#include <cmath>
#include <limits>

namespace facula {
namespace {

void put_cast(Bytes& bytes, const CastOptions& options) {
  put(bytes, options.resolution);
  put(bytes, options.max_range);
  put(bytes, static_cast<std::uint8_t>(options.discretize ? 1 : 0));
  put(bytes, static_cast<std::uint8_t>(options.weigh_sigma ? 1 : 0));
  put(bytes, static_cast<std::uint8_t>(options.box ? 1 : 0));
  const MapBox box = options.box.value_or(MapBox());
  for (const Eigen::Vector3f& corner : {box.min, box.max}) {
    for (const float x : corner) put(bytes, x);
  }
}

bool take_flag(ByteReader& reader) {
  const auto flag = reader.take<std::uint8_t>();
  require(flag <= 1, "expected 0 or 1 for yes or no, got ", static_cast<int>(flag));
  return flag == 1;
}

CastOptions take_cast(ByteReader& reader) {
  CastOptions options;
  options.resolution = reader.take<double>();
  options.max_range = reader.take<double>();
  options.discretize = take_flag(reader);
  options.weigh_sigma = take_flag(reader);
  const bool has_box = take_flag(reader);
  MapBox box;
  for (Eigen::Vector3f* corner : {&box.min, &box.max}) {
    for (float& x : *corner) x = reader.take<float>();
  }
  require(box.min.allFinite() && box.max.allFinite(), "a box has a corner that is not a number");
  if (has_box) options.box = box;
  return options;
}

RigidTransform take_pose(ByteReader& reader) {
  RigidTransform pose;
  for (double& x : pose.translation) x = reader.take<double>();
  for (double& x : pose.rotation.coeffs()) x = reader.take<double>();
  require(pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 1e-6,
          "a scan's pose is none");
  return pose;
}

void require_used_up(const ByteReader& reader, const char* what) {
  require(!reader.failed() && reader.left() == 0, "a block ", what, " is of another length");
}

}  // namespace

Bytes map_options_bytes(const OccupancyOptions& options) {
  Bytes bytes;
  put_cast(bytes, options.cast());
  for (const double p : {options.hit, options.miss, options.clamp_min, options.clamp_max}) {
    put(bytes, p);
  }
  return bytes;
}

OccupancyOptions parse_map_options(ByteView bytes) {
  ByteReader reader(bytes);
  const CastOptions cast = take_cast(reader);
  OccupancyOptions options{.resolution = cast.resolution,
                           .max_range = cast.max_range,
                           .discretize = cast.discretize,
                           .weigh_sigma = cast.weigh_sigma,
                           .box = cast.box};
  for (double* p : {&options.hit, &options.miss, &options.clamp_min, &options.clamp_max}) {
    *p = reader.take<double>();
  }
  require_used_up(reader, "OPTS");
  options.check();
  return options;
}

Bytes scan_record_bytes(const KeptScan& scan) {
  const ScanRecord& record = scan.record;
  Bytes bytes;
  put(bytes, static_cast<std::uint32_t>(record.name.size()));
  put_bytes(bytes, record.name.data(), record.name.size());
  for (const double x : record.world_from_scan.translation) put(bytes, x);
  for (const double x : record.world_from_scan.rotation.coeffs()) put(bytes, x);
  put(bytes, std::uint64_t{record.points});
  put(bytes, std::uint64_t{scan.cells.skipped});
  put_cast(bytes, record.cast);
  put(bytes, std::uint64_t{scan.cells.blocks.size()});
  put(bytes, std::uint64_t{scan.colors.size()});
  return bytes;
}

ParsedRecord parse_scan_record(ByteView bytes) {
  ByteReader reader(bytes);
  ParsedRecord parsed;
  const ByteView name = reader.take_view(reader.take<std::uint32_t>());
  parsed.record.name.assign(name.begin(), name.end());
  parsed.record.world_from_scan = take_pose(reader);
  parsed.record.points = reader.take<std::uint64_t>();
  parsed.skipped = reader.take<std::uint64_t>();
  parsed.record.cast = take_cast(reader);
  parsed.blocks = reader.take<std::uint64_t>();
  parsed.color_blocks = reader.take<std::uint64_t>();
  require_used_up(reader, "SCAN");
  return parsed;
}

Bytes map_counts_bytes(const MapCounts& counts) {
  Bytes bytes;
  put(bytes, counts.bricks);
  put(bytes, counts.scans);
  return bytes;
}

MapCounts parse_map_counts(ByteView bytes) {
  ByteReader reader(bytes);
  const MapCounts counts{reader.take<std::uint64_t>(), reader.take<std::uint64_t>()};
  require_used_up(reader, "END");
  return counts;
}

}  // namespace facula
