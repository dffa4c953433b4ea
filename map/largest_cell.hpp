// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// Largest edge of a cell [m]. The squared length of a ray across all of space still fits a float,
/// without which no walk along it would end.
constexpr double kLargestCell = 1e9;

}  // namespace facula
