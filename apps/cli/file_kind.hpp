// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace facula {

/// What a file or folder is, as far as a look at its extension and beginning tells.
enum class FileKind {
  kRig,      ///< rig.toml
  kScene,    ///< scene.toml
  kCapture,  ///< capture.toml, or a folder with one
  kLog,      ///< stripe log, .flog
  kProject,  ///< poses.toml, *.conf, an OctoMap log (.graph), or a folder of 3DTK scans
  kScan,     ///< organised .pcd
  kCloud,    ///< points without a grid
  kMesh,     ///< .ply with faces, .obj, .stl, .off, .glb
  kMap,      ///< .bt, .ot, .fmap, .blocks
  kGrid      ///< .yaml beside a .pgm
};

/// Throws Error when the file is missing or of no kind that facula reads.
FileKind file_kind(const std::filesystem::path& path);

std::string to_string(FileKind kind);

}  // namespace facula
