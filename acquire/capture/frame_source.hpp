// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/core/image_view.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

namespace facula {

/// Gives the frames of a capture by number. read() may be called from several threads.
class FrameSource {
 public:
  FrameSource() = default;
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  virtual std::size_t size() const = 0;

  /// Frame i, grey or blue-green-red, 8 bit. Throws Error when it cannot be read as an image.
  virtual Image8 read(std::size_t i) const = 0;
};

/// Images, or one video file that is then read frame by frame.
std::unique_ptr<FrameSource> open_frames(const std::vector<std::filesystem::path>& files);

/// The frames of a capture: lit(i), and dark(i) which is empty where the capture has no background.
/// Both throw Error where a frame cannot be read. Calls may run from several threads.
class CaptureFrames {
 public:
  /// Throws Error when there are no frames, or backgrounds but neither one nor one each.
  explicit CaptureFrames(const Capture& capture);

  std::size_t size() const;  ///< lit frames; of alternating frames every pair counts once
  Image8 lit(std::size_t i) const;
  Image8 dark(std::size_t i) const;

 private:
  std::unique_ptr<FrameSource> frames_;
  std::unique_ptr<FrameSource> background_;
  Image8 common_background_;
  Alternation alternation_;
};

/// One image, grey or blue-green-red, 8 bit: of 16 bits the upper 8 are kept, an alpha channel is
/// dropped. Throws Error when the file is missing, torn or no image.
Image8 read_image(const std::filesystem::path& path);

/// Writes an image (.png or .jpg), whole or not at all.
void write_image(const std::filesystem::path& path, ImageView8 image);

}  // namespace facula
