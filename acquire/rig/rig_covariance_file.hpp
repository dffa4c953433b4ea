// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/rig/toml_table.hpp>

#include <iosfwd>

namespace facula {

/// Reads the table [covariance] of rig.toml: `parameters`, a list of names, and `rows`, the matrix
/// as a list of lists. Throws Error on a wrong shape, naming file and key; whether it fits the rig
/// is for check_covariance().
RigCovariance read_covariance(TomlTable table);

/// Writes that table with full precision.
void write_covariance(std::ostream& out, const RigCovariance& covariance);

}  // namespace facula
