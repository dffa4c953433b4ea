// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/ply_table.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace facula {

enum class PlyEncoding : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

/// What a PLY header declares: elements without values.
struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> infos;  ///< what follows `obj_info`, a line each
};

/// Takes the header off the front of `text`. Throws Error naming `file` when it is not one.
PlyHeader take_ply_header(std::string_view& text, const std::string& file);

/// The header of a binary little-endian file of these elements.
std::string ply_header_text(const std::vector<PlyElement>& elements);

}  // namespace facula
