// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <filesystem>

namespace facula {

/// Reads a mesh by its extension: .ply, .obj, .off, .stl (ascii or binary; equal corners are
/// joined). For .glb see read_any_mesh() in reconstruct.
/// Polygons are split into fans. Throws Error when the file is missing, torn, or names vertices
/// that are not there. Lengths are taken as metres times `unit` (0.001 for a file in millimetres).
TriangleMesh read_mesh(const std::filesystem::path& path, double unit = 1.0);

/// Writes a mesh as .ply (binary), .obj, .off, .stl (binary) or .glb (binary glTF; always metres, y
/// up), whole or not at all; `unit` as above.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, double unit = 1.0);

}  // namespace facula
