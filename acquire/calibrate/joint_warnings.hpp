// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>

#include <string>
#include <vector>

namespace facula {

/// One sentence per parameter of the rig that its covariance leaves too uncertain for a scanner,
/// with what to add to the pictures.
std::vector<std::string> weak_parameters(const Rig& rig);

/// What to do when a parameter cannot be decided at all.
std::string advice_for(const std::string& parameter);

}  // namespace facula
