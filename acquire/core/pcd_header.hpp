// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/pcd_table.hpp>

#include <string>
#include <string_view>

namespace facula {

/// What a PCD header declares: a table without values.
struct PcdHeader {
  PcdTable table;
  std::size_t points = 0;  ///< width * height [1]
  std::string encoding;    ///< ascii, binary or binary_compressed
};

/// Takes the header off the front of `text`. Throws Error naming `file` when it is not one or its
/// numbers contradict each other.
PcdHeader take_pcd_header(std::string_view& text, const std::string& file);

/// The header of a binary file of this table.
std::string pcd_header_text(const PcdTable& table);

}  // namespace facula
