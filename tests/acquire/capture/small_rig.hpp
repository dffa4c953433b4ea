// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/tests/support/temporary_folder.hpp>

namespace facula {

/// Writes the rig.toml of captures with frames of 48 rows and 64 columns.
inline void write_small_rig(const TemporaryFolder& folder) {
  folder.write("rig.toml", R"([camera]
width_px = 64
height_px = 48
fx_px = 60
fy_px = 60
cx_px = 31.5
cy_px = 23.5
[[laser]]
normal = [1, 0, 0]
distance_mm = 50
[axis]
kind = "pan"
)");
}

}  // namespace facula
