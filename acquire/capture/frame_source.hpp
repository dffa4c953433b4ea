// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

namespace facula {

/// Gives the frames of a capture by number. read() may be called from several threads.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  virtual std::size_t size() const = 0;

  /// Frame i, grey or blue-green-red, 8 bit. Throws Error when it cannot be read as an image.
  virtual Image8 read(std::size_t i) const = 0;
};

/// Images, or one video file that is then read frame by frame.
std::unique_ptr<FrameSource> open_frames(const std::vector<std::filesystem::path>& files);

/// One image, grey or colour as stored. Throws Error when the file is missing or is not an image.
Image8 read_image(const std::filesystem::path& path);

/// Writes an image (.png or .jpg), whole or not at all.
void write_image(const std::filesystem::path& path, ImageView8 image);

}  // namespace facula
