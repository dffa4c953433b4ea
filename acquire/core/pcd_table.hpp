// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/number_column.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// One field of a PCD file. Point i holds values[i * count] ... values[i * count + count - 1].
struct PcdField : NumberColumn {
  std::size_t count = 1;  ///< values per point [1]
};

/// A PCD file: named fields over width x height points, stored row by row.
struct PcdTable {
  std::vector<std::string> comments;  ///< header comments, without their '#' and blanks around
  std::size_t width = 0;              ///< [1]
  std::size_t height = 1;             ///< 1 for a cloud that is not organised [1]
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};  ///< tx ty tz [m], qw qx qy qz [1]
  std::vector<PcdField> fields;

  /// The field of that name with one value per point, or null.
  const PcdField* find(const std::string& field) const;

  /// As find(), but throws Error naming the file when the field is missing.
  const PcdField& field(const std::string& name, const std::filesystem::path& path) const;
};

/// Reads a PCD file (Point Cloud Library, version 0.7 and those before; ascii, binary,
/// binary_compressed). A colour packed in a field `rgb` or `rgba` is read as a 32-bit integer.
/// Throws Error when the file is no PCD file or holds fewer or more values than its header says.
PcdTable read_pcd(const std::filesystem::path& path);

/// Writes a table as little-endian binary PCD, whole or not at all.
void write_pcd(const std::filesystem::path& path, const PcdTable& table);

}  // namespace facula
