// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/rig/toml_table.hpp>

#include <ostream>

namespace facula {

/// The sections of rig.toml that hold the calibrations without a board: [range], [compensation],
/// [profile.polynomial], [profile.projection], [two_line]. Each may be absent.
void read_simple_calibrations(TomlTable& table, Rig& rig);
void write_simple_calibrations(std::ostream& out, const Rig& rig);

}  // namespace facula
