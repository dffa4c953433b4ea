// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>

#include <filesystem>
#include <optional>

namespace facula {

/// Reads capture.toml (or the capture.toml of a folder) and the rig it names. Relative paths count
/// from the file's folder; `frames_folder`, when given, is where all frames lie instead. Throws
/// Error on a missing file, an unknown key (with the nearest known one), a value out of range,
/// frames that are missing, a number of frames that differs from the number of positions, or
/// several lasers in the rig and none named.
Capture read_capture(const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& frames_folder = std::nullopt);

/// The capture with a newer calibration in place of its own. The lit laser is the one of the same
/// name, or the only one. Throws Error where the rig has neither, its camera is of another size, or
/// its stripe runs the other way.
Capture with_rig(Capture capture, const std::filesystem::path& rig_file);

}  // namespace facula
