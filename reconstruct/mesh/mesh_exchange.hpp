// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <filesystem>

namespace facula {

/// Reads the triangles of a binary glTF 2.0 file (.glb) through assimp: all meshes of the scene by
/// their nodes' transforms, in metres and turned from y up to z up. Throws Error when the file is
/// missing, torn or holds no triangles. write_mesh() writes such files.
TriangleMesh read_glb_mesh(const std::filesystem::path& path);

/// read_mesh() for every format that write_mesh() knows: .ply, .obj, .stl, .off and .glb.
TriangleMesh read_any_mesh(const std::filesystem::path& path);

}  // namespace facula
