// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/scan_graph.hpp>
#include <facula/reconstruct/register/scan_list.hpp>

#include <filesystem>
#include <vector>

namespace facula {

/// Whether a file's name says that it is an OctoMap log of scans (.graph).
bool is_octomap_log(const std::filesystem::path& file);

/// The scans of an OctoMap log, each in its scanner's frame with its pose. The log is read at once
/// and held until the last of them goes.
std::vector<ListedScan> list_log(const std::filesystem::path& path);

/// The scans as an OctoMap log, numbered from 0. A scan of a log has one origin, its pose's: where
/// a cloud has many (the laser turns about an axis off the camera), it is their mean. Points that
/// are not finite are left out; so are sigmas, colours and a log's own edges.
ScanGraph log_of(const ScanProject& project);

/// The scan's cloud in the world frame. Scans of an OctoMap log are placed in float as OctoMap does
/// it, so that maps of them are the same byte for byte.
PointCloud in_world(const PosedCloud& scan);

}  // namespace facula
