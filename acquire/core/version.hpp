// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// Version of this build, "major.minor.patch", from project() in the root CMakeLists.txt.
const char* version();

}  // namespace facula
