// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <filesystem>
#include <string>

namespace facula {

/// A picture (1 or 3 channels) as the bytes of a PNG file. Throws Error when it is empty.
std::string encode_png(const Image8& picture);

/// Writes a picture as PNG, whole or not at all.
void write_png(const std::filesystem::path& path, const Image8& picture);

}  // namespace facula
