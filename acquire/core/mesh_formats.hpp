// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <filesystem>
#include <vector>

namespace facula {

// The formats behind read_mesh() and write_mesh(), each in a file of its own. Lengths are those of
// the file; all throw Error naming the file.

TriangleMesh read_ply_mesh(const std::filesystem::path& path);
TriangleMesh read_obj_mesh(const std::filesystem::path& path);
TriangleMesh read_stl_mesh(const std::filesystem::path& path);
TriangleMesh read_off_mesh(const std::filesystem::path& path);

void write_ply_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);
void write_obj_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);
void write_stl_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);
void write_off_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);
/// Binary glTF: metres, turned to y up, colours in linear light, as the format asks.
void write_glb_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// Adds a polygon as a fan of triangles around its first corner. Throws Error naming the file when
/// it has fewer than three corners.
void add_fan(TriangleMesh& mesh,
             const std::vector<std::uint32_t>& corners,
             const std::filesystem::path& path);

}  // namespace facula
