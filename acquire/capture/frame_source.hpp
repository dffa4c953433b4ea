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

/// What is taken of one position with one exposure.
struct CapturedFrame {
  Image8 lit;
  Image8 dark;    ///< matched to the lit frame as the capture says; empty without a background
  Image8 moving;  ///< grey, 255 where frames of one light differ; empty where there is one of each
};

/// The frames of a capture by axis position: lit(i), and dark(i) which is empty where the capture
/// has no background. All throw Error where a frame cannot be read. Calls may run from several
/// threads.
class CaptureFrames {
 public:
  /// Throws Error when there are no frames, or backgrounds but neither one nor one each (with
  /// exposures: one per exposure instead of one).
  explicit CaptureFrames(const Capture& capture);

  std::size_t size() const;  ///< positions; the frames taken of one count once
  std::size_t exposures() const { return exposures_; }  ///< per position [1]

  CapturedFrame read(std::size_t i, std::size_t exposure = 0) const;
  Image8 lit(std::size_t i) const;  ///< of the first exposure
  Image8 dark(std::size_t i) const;

 private:
  Image8 frame(std::size_t i, std::size_t exposure, std::size_t number) const;
  Image8 background(std::size_t i, std::size_t exposure) const;

  std::unique_ptr<FrameSource> frames_;
  std::unique_ptr<FrameSource> background_;
  std::vector<Image8> common_background_;  ///< one per exposure; empty where there is none
  Alternation alternation_;
  Flicker flicker_;
  std::size_t exposures_;
};

/// One image, grey or blue-green-red, 8 bit: of 16 bits the upper 8 are kept, an alpha channel is
/// dropped. Throws Error when the file is missing, torn or no image.
Image8 read_image(const std::filesystem::path& path);

/// Writes an image (.png or .jpg), whole or not at all.
void write_image(const std::filesystem::path& path, ImageView8 image);

}  // namespace facula
