// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/number_column.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace facula {

/// One property of a PLY element. A scalar has one value per row; a list has all entries of all
/// rows in `values` and where the entries of each row end in `ends`.
struct PlyProperty : NumberColumn {
  std::optional<NumberType> count_type;  ///< type of the entry count; none for a scalar
  std::vector<std::size_t> ends;         ///< lists only, one per row
};

/// One element of a PLY file ("vertex", "face", ...) with its properties in file order.
struct PlyElement {
  std::string name;
  std::size_t rows = 0;
  std::vector<PlyProperty> properties;

  /// The property of that name, or null.
  const PlyProperty* find(const std::string& property) const;
};

/// Reads every element of a PLY file (Turk 1994: ascii, binary of either byte order, lists; lines
/// may end in \r\n). Throws Error when the file is no PLY file or holds fewer or more values than
/// its header says. `infos`, when given, receives what follows `obj_info` in the header, line by
/// line.
std::vector<PlyElement> read_ply(const std::filesystem::path& path,
                                 std::vector<std::string>* infos = nullptr);

/// The element of that name; throws Error naming the file when it is missing.
const PlyElement& ply_element(const std::vector<PlyElement>& elements,
                              const std::string& name,
                              const std::filesystem::path& path);

/// Writes elements as binary little-endian PLY, whole or not at all.
void write_ply(const std::filesystem::path& path, const std::vector<PlyElement>& elements);

}  // namespace facula
