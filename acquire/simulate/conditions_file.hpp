// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/simulate.hpp>

#include <filesystem>

namespace facula {

/// Reads conditions.toml: what differs from `options` about light, lens, sensor, and axis. Tables
/// [laser], [beam], [speckle], [ambient], [lens], [sensor], [timing], [motion], each optional, as
/// is every key; data/conditions/ shows them all. Axis errors are in _deg for a rig that turns, in
/// _mm for one that does not. Throws Error on a missing file, an unknown key (with the nearest
/// known one) or a value out of range.
SimulateOptions read_conditions(const std::filesystem::path& path,
                                const Rig& rig,
                                SimulateOptions options);

}  // namespace facula
